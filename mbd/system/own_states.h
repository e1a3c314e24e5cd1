// `[[state]]`: a number of the model that follows a differential equation of its own, ż = rate(motion, states, parameters, t).
//
// It is an inner state (roles.h) that no body owns: formulas in the equations of motion read it by its name. It is kept in parts of
// its scale, so that all methods control its error as they control places: to the tolerance times a thousandth of the scale,
// or times what it has changed since the start.
#pragma once

#include "mbd/system/motion_formula.h"
#include "mbd/system/state_jacobian.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct OwnState : TableObject {
  std::string unit;            ///< of its value: made of kg, m and s, or any other, which counts as a number in formulas
  double start = 0.0;          ///< in its unit
  std::string rate;            ///< formula of its rate
  std::optional<double> scale; ///< in its unit: what it is usually like; not given: the size of its start, or 1
  std::string meaning, sign;   ///< for documents; may be empty

  /// So many SI units is one of its unit; 1 of one that is not made of kg, m and s.
  [[nodiscard]] double factor() const;
};

/// All of the model, in its order.
[[nodiscard]] std::vector<const OwnState*> own_states(const Model& model);
/// Nullptr if there is none of that name.
[[nodiscard]] const OwnState* find_own_state(const Model& model, const std::string& name);

/// Where a state is kept.
struct StatePlace {
  int inner = 0;     ///< in State::inner
  double unit = 1.0; ///< SI for one of what is kept there
};
/// All states of the model have their places from the first call on.
[[nodiscard]] StatePlace place_of_state(SystemBuilder& builder, const OwnState& state);
/// State::inner as it starts, as far as own states reach in it.
[[nodiscard]] std::vector<double> start_of_states(SystemBuilder& builder);

/// All own states of a model.
class OwnStateGroup final : public ForceGroup, public StateReader {
public:
  struct Entry {
    MotionFormula rate;
    StatePlace place;
    int unit = -1; ///< index of its mode; -1: its rate has no switches
    int watch = 0; ///< index of its first watch value
    std::vector<SwitchScale> switches = {};
  };
  std::vector<Entry> entries;
  int first_inner = -1; ///< of the model's states, one after another; -1: they have no places yet

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] bool trace_forces(TracedEvaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  void add_jacobian(const Evaluation&, std::vector<PairJacobian>&) const override {}
  [[nodiscard]] bool follows_jumps() const override { return true; }
  void add_state_jacobian(const Evaluation& e, StateJacobian& out) const override;
  void enter_formulas(std::vector<FormulaInMotion>& out) const override;
  void mark_bodies(std::vector<char>& is_used) const override;
  void enter_turns(TurnTable& turns) const override;
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] EventKind transition(UnitMode, UnitMode) const override { return EventKind::passes_kink; }

private:
  template <class S, class AtTime> void add_rates(Evaluated<S>& e, const AtTime& at_time) const;
};

/// Nullptr if the system has no own states.
[[nodiscard]] const OwnStateGroup* own_state_group(const System& system);

} // namespace steplap
