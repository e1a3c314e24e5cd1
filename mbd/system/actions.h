// `[[action]]`s of a compiled system: their conditions as watch values, and what they do.
//
// A condition gives no force. A comparison is made of switches (FormulaProgram), each with a watch value, so that the event finder
// locates where it comes true as it does the kinks of a force. A time is a breakpoint. An event of an element is one of those that the
// event handler notes.
//
// What acts is fixed in a system: an element that an action releases acts in one system and not in another, compiled from the same
// model with its `active` or some other field changed. A run goes on from the one to the other (mbd/simulation/changeover.h).
#pragma once

#include "mbd/model/action.h"
#include "mbd/system/motion_formula.h"
#include "mbd/system/turn_table.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// One thing that an action does.
struct ActionStep {
  ActionVerb verb = ActionVerb::stop;
  int target = -1;   ///< index in Model::elements; of arm and disarm in ActionGroup::entries
  std::string field; ///< of set
  FieldValue value;  ///< of set, in SI
};

/// What a formula, a time or an event has to be for an action.
struct ActionTrigger {
  std::optional<MotionFormula> formula;      ///< a comparison
  std::vector<SwitchScale> switches = {};    ///< of it
  std::optional<double> time = std::nullopt; ///< s
  int element = -1;                          ///< of an event: index in System::element_names
  EventKind event = EventKind::none;
};

/// All actions of a model, in the order of the file. Gives no force.
class ActionGroup final : public ForceGroup {
public:
  struct Entry {
    std::string name, text; ///< text: of all its steps, for people
    ActionTrigger trigger;
    std::vector<ActionStep> steps;
    bool is_once = true, is_armed = true;
    int unit = -1, watch = 0; ///< of a comparison
  };
  std::vector<Entry> entries;
  std::shared_ptr<const Model> model;                    ///< completed, as it is at the start of a run
  std::optional<std::vector<std::string>> channels = {}; ///< that were wanted of the system; not given: all
  /// What else was done to the system once it was compiled: it is done to those, too, that actions make of it. May add channels.
  std::vector<std::function<void(System&)>> additions = {};

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] bool trace_forces(TracedEvaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  void add_jacobian(const Evaluation&, std::vector<PairJacobian>&) const override {}
  void mark_bodies(std::vector<char>& is_used) const override;
  void enter_turns(TurnTable& turns) const override;
  [[nodiscard]] bool follows_jumps() const override { return true; }
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;

  /// Of a comparison or a time: is it true at `state`? `is_stepped`: modes of units are not followed from event to event.
  [[nodiscard]] bool holds(std::size_t action, const State& state, const std::vector<Motion<double>>& motion, bool is_stepped) const;

private:
  template <class S, class AtTime> void watch(Evaluated<S>& e, const AtTime& at_time) const;
};

/// Nullptr if the system has no actions.
[[nodiscard]] const ActionGroup* action_group(const System& system);
[[nodiscard]] ActionGroup* action_group(System& system);

} // namespace steplap
