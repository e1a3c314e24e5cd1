// Computes the intervals in which each signal acts on each element in a run. Actions start and end these intervals by releasing, holding
// and setting elements; the times of actions are taken from the events of the run, so the run need not record anything else.
#pragma once

#include "mbd/model/action.h"
#include "mbd/simulation/run_record.h"

#include <string>
#include <vector>

namespace steplap {

/// The end of an interval in which a signal acts.
struct SignalCut {
  const Action* action = nullptr;     ///< action that ends the interval; null: the end of the run
  ActionVerb verb = ActionVerb::stop; ///< what the action does to the signal
};

/// An interval of time in which a signal acts on an element.
struct SignalSpan {
  double from = 0.0, to = 0.0; ///< begin and end, s
  SignalCut cut;               ///< reason for the end of the interval
};

/// Use of a signal by a field of an element.
struct ActingSignal {
  std::size_t element = 0;            ///< index in Model::elements
  std::string field;                  ///< name of the field
  std::string signal;                 ///< name of the signal; "" for loads given by constants only
  bool is_named_at_start = false;     ///< true if the element names the signal itself, false if only an action assigns it
  std::vector<SignalSpan> spans;      ///< ascending in time; empty if the signal never acted; the first interval may have zero length
  std::vector<const Action*> waiting; ///< for a signal that never acted: actions that would have started it, but were not executed
};

/// Returns all uses of signals from t = 0 to result.final_state.t, including signals that only actions without execution would have
/// assigned.
[[nodiscard]] std::vector<ActingSignal> acting_signals(const Model& model, const RunResult& result);
/// Returns all uses of signals from t = 0 to `end`, s, for a run in which no action is executed.
[[nodiscard]] std::vector<ActingSignal> acting_signals_without_actions(const Model& model, double end);

/// Returns the action of that name, or nullptr if there is none.
[[nodiscard]] const Action* find_action(const Model& model, const std::string& name);

} // namespace steplap
