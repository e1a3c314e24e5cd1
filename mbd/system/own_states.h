// `[[state]]` tables: scalar variables with their own differential equation ż = rate(motion, states, parameters, t).
//
// Each is an inner state (roles.h) that formulas read by name. It is stored divided by a scale, so that all integration methods control its
// error like that of positions: tolerance × scale/1000, or tolerance × its change since the start if that is larger.
#pragma once

#include "mbd/system/motion_formula.h"
#include "mbd/system/state_jacobian.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct OwnState : TableObject {
  std::string unit;            ///< unit of the value; a unit that is not a product of kg, m and s counts as dimensionless in formulas
  double start = 0.0;          ///< initial value, in `unit`
  std::string rate;            ///< formula of ż
  std::optional<double> scale; ///< typical magnitude, in `unit`; not given: |start|, or 1 if that is 0
  std::string meaning, sign;   ///< description and sign convention; may be empty

  /// Returns the SI value of one unit; 1 for a unit that is not a product of kg, m and s.
  [[nodiscard]] double factor() const;
};

/// Returns all states of the model, in order.
[[nodiscard]] std::vector<const OwnState*> own_states(const Model& model);
/// Returns the state with this name, or nullptr.
[[nodiscard]] const OwnState* find_own_state(const Model& model, const std::string& name);

/// Index and unit of a stored state.
struct StatePlace {
  int inner = 0;     ///< index in State::inner
  double unit = 1.0; ///< SI value of one unit in State::inner
};
/// Returns index and unit of a state. The first call assigns indices to all states of the model.
[[nodiscard]] StatePlace place_of_state(SystemBuilder& builder, const OwnState& state);
/// Returns the initial values of State::inner, up to the last [[state]] variable.
[[nodiscard]] std::vector<double> start_of_states(SystemBuilder& builder);

/// All [[state]] variables of a model, as a force group that applies no forces.
class OwnStateGroup final : public ForceGroup {
public:
  struct ElementData {
    MotionFormula rate;
    StatePlace place;
    int element = 0;     ///< index in System::element_names
    int unit = -1;       ///< index of its mode; −1: the formula has no switches
    int first_event = 0; ///< index of its first event function
    std::vector<SwitchScale> switches = {};
  };
  std::vector<ElementData> entries;
  int first_inner = -1; ///< first index in State::inner, the others follow; −1: not yet assigned

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  void add_jacobian(const Evaluation&, std::vector<PairJacobian>&) const override {}
  [[nodiscard]] bool has_discontinuous_events() const override { return true; }
  [[nodiscard]] bool are_inner_states_stepped() const override { return true; }
  void add_state_jacobian(const Evaluation& e, StateJacobian& out) const override;
  void register_formulas(std::vector<FormulaInMotion>& out) const override;
  void mark_bodies(std::vector<char>& is_used) const override;
  void register_turns(TurnTable& turns) const override;
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] EventKind event_kind(UnitMode, UnitMode) const override { return EventKind::passes_kink; }

private:
  template <class S, class AtTime> void add_rates(EvaluationData<S>& e, const AtTime& at_time) const;
};

/// Returns the group of [[state]] variables of the system; nullptr if it has none.
[[nodiscard]] const OwnStateGroup* own_state_group(const System& system);

} // namespace steplap
