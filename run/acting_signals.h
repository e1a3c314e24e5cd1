// Finds which signals acted in a run, and when: each use of a signal by an element, over the legs of the run.
//
// The events of a run tell which actions happened, and these what they released, held and set. So nothing has to be kept by the run.
#pragma once

#include "mbd/model/action.h"
#include "mbd/simulation/run_record.h"

#include <string>
#include <vector>

namespace steplap {

/// The end of a stretch of time in which a signal acted.
struct SignalCut {
  const Action* action = nullptr;     ///< null: the end of the run
  ActionVerb verb = ActionVerb::stop; ///< what the action did to the signal
};

/// A stretch of time in which it acted.
struct SignalSpan {
  double from = 0.0, to = 0.0; ///< s
  SignalCut cut;               ///< what ended it
};

/// A field of an element that names a signal.
struct ActingSignal {
  std::size_t element = 0;            ///< in Model::elements
  std::string field;                  ///< its name
  std::string signal;                 ///< its name; "": the element gives constants alone (a load)
  bool is_named_at_start = false;     ///< by the element itself, and not by an action alone
  std::vector<SignalSpan> spans;      ///< ascending in time; none: it never acted
  std::vector<const Action*> waiting; ///< where it never acted: actions that would have begun it, and did not happen
};

/// All uses of a run from t = 0 to result.final_state.t. Signals that only an action names are among them, whether or not it happened.
[[nodiscard]] std::vector<ActingSignal> acting_signals(const Model& model, const RunResult& result);
/// Returns the signals that act in a run to `end`, s, if no action happens.
[[nodiscard]] std::vector<ActingSignal> acting_signals_without_actions(const Model& model, double end);

/// The action of that name; nullptr if there is none.
[[nodiscard]] const Action* find_action(const Model& model, const std::string& name);

} // namespace steplap
