// The `[[action]]` tables of a compiled system: conditions as event functions, and steps.
//
// A comparison consists of switches (FormulaProgram), each with an event function, so that the event finder locates the time at which the
// condition becomes true. A condition on time is a breakpoint. A condition on an event of an element is met when the event handler reports
// that event.
//
// A system is constant, so an action does not change it. The model is compiled again with changed fields, and the run continues with the
// new system (mbd/simulation/changeover.h).
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

/// One compiled step of an action.
struct ActionStep {
  ActionVerb verb = ActionVerb::stop;
  int target = -1;   ///< index in Model::elements; for arm and disarm in ActionGroup::entries
  std::string field; ///< for set only
  FieldValue value;  ///< for set only, in SI
};

/// Compiled condition of an action: a comparison, a time or an event.
struct ActionTrigger {
  std::optional<MotionFormula> formula;      ///< a comparison
  std::vector<SwitchScale> switches = {};    ///< scales of its switches
  std::optional<double> time = std::nullopt; ///< s
  int element = -1;                          ///< element of the event: index in System::element_names
  EventKind event = EventKind::none;
};

/// All actions of a model, in the order of the file, as a force group that applies no forces.
class ActionGroup final : public ForceGroup {
public:
  struct ElementData {
    std::string name, text; ///< text: all steps, for messages
    ActionTrigger trigger;
    std::vector<ActionStep> steps;
    bool is_once = true, is_armed = true;
    int unit = -1, first_event = 0; ///< index of the mode and of the first event function of a comparison
  };
  std::vector<ElementData> entries;
  std::shared_ptr<const Model> model;                    ///< completed model with the values at the start of a run
  std::optional<std::vector<std::string>> channels = {}; ///< channels that were requested; not given: all
  /// Functions that change the system after compilation, for example by adding channels. They are called for each system that an action
  /// creates, too.
  std::vector<std::function<void(System&)>> additions = {};

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  void add_jacobian(const Evaluation&, std::vector<PairJacobian>&) const override {}
  void mark_bodies(std::vector<char>& is_used) const override;
  void register_turns(TurnTable& turns) const override;
  [[nodiscard]] bool has_discontinuous_events() const override { return true; }
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;

  /// Returns true if the condition is met at `state`; for comparisons and times only. `is_stepped`: the run uses time stepping, in which
  /// the modes of comparisons are not kept up to date, so the formula is evaluated again.
  [[nodiscard]] bool holds(std::size_t action, const State& state, const std::vector<Motion<double>>& motion, bool is_stepped) const;

private:
  template <class S, class AtTime> void event_value(EvaluationData<S>& e, const AtTime& at_time) const;
};

/// Returns the actions of the system; nullptr if it has none.
[[nodiscard]] const ActionGroup* action_group(const System& system);
[[nodiscard]] ActionGroup* action_group(System& system);
/// Returns the name of the first armed action whose condition, a comparison or a time, is met at `state`; "" if there is none.
[[nodiscard]] std::string action_met_at(const System& system, const State& state);

} // namespace steplap
