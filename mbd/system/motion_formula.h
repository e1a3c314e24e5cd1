// Formulas in the equations of motion: functions of positions, angles, velocities, states, signals, parameters and time.
//
// Names are looked up in this order:
//
//   value, rate            own coordinate of the element, if it has one
//   name of a state        `[[state]]`
//   name of a parameter    `[parameters]`
//   name of a signal       its value at time t; dimensionless, so a force is written as drive * '1 N'
//   B.x .y .theta .vx .vy .omega   of body B;  M.x .y .vx .vy  of marker M: as the channels of these names
//   a channel that is a measure of two bodies or its rate (measured_channel.h): "spring.elongation", "pin.angle"
//   a `[[channel]]` defined by these
//
// Forces, reactions and accelerations are not allowed: they depend on the forces that the formula determines.
#pragma once

#include "mbd/formula/formula_program.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/turn_table.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace steplap {

/// One operand of a formula: a name that was resolved.
struct MotionOperand {
  enum class Kind : unsigned char { own_value, own_rate, coordinate, measure, state, signal };
  Kind kind = Kind::own_value;
  int body = k_ground, coordinate = 0; ///< coordinate: 0 … 5 for x, y, θ and their rates
  RowSpec row;                         ///< for kind measure
  double zero = 0.0;                   ///< subtracted from the value of the measure
  bool is_rate = false;                ///< for kind measure: its rate
  int inner = 0;                       ///< for kind state: index in State::inner
  double unit = 1.0;                   ///< for kind state: SI value of one unit in State::inner
  const Signal* signal = nullptr;
};

/// A formula to be compiled, with the units of its names.
struct MotionFormulaText {
  std::string text;
  std::string field;                    ///< name of the field, for messages
  std::string unit;                     ///< required unit of the result; values are in SI and not converted
  std::string own_value, own_rate = {}; ///< units of `value` and `rate`; "-": the name is not available
};

/// Value and rate of the element's own coordinate, if it has one.
template <class S> struct OwnCoordinate {
  S value{0}, rate{0};
};

/// A compiled formula of motions, signals, own states and time.
class MotionFormula {
public:
  /// Compiles the formula. Errors are reported to the builder, and is_valid() is then false. Precondition: all elements of stage 0 are
  /// compiled, since names may refer to their channels.
  MotionFormula(SystemBuilder& builder, const MotionFormulaText& text);

  [[nodiscard]] bool is_valid() const { return !programs_.empty(); }
  [[nodiscard]] const FormulaProgram& program() const { return programs_.front(); }
  /// Returns the merged tree of the formula and all formulas in it.
  [[nodiscard]] const FormulaTree& tree() const { return tree_; }
  [[nodiscard]] const std::vector<MotionOperand>& operands() const { return operands_; }
  /// Returns the bodies whose motion the formula reads, without those of the element's own coordinate.
  [[nodiscard]] const std::vector<int>& bodies() const { return bodies_; }

  /// Adds the angles on which the formula depends nonlinearly to `turns`, except the element's own coordinate.
  void register_turns(TurnTable& turns) const;

  /// Returns the value of the formula for given switch bits. at_time(signal) returns the value of a signal; `quantity` receives the switch
  /// quantities as in FormulaProgram::evaluate().
  template <class S, class AtTime>
  S value(const EvaluationData<S>& e, const OwnCoordinate<S>& own, const AtTime& at_time, SwitchBits bits, S* quantity) const;
  /// Determines the bits of the formula's switches from the current motion, except those marked as given.
  void find_bits(const Evaluation& e, const OwnCoordinate<double>& own, FormulaProgram::Bits& bits) const;
  /// Returns the value, and writes its derivatives with respect to all operands, in the order of operands(), to `derivatives`.
  double differentiate(const Evaluation& e, const OwnCoordinate<double>& own, SwitchBits bits, double* derivatives) const;
  /// Returns for each switch how fast its quantity changes with the motion: the sum of its absolute derivatives by positions and
  /// velocities, at least a small positive number.
  [[nodiscard]] std::vector<double> gains(const Evaluation& e, const OwnCoordinate<double>& own, SwitchBits bits) const;

private:
  class Resolver;
  template <class S, class AtTime> void read(const EvaluationData<S>& e, const OwnCoordinate<S>& own, const AtTime& at_time, S* x) const;

  std::vector<FormulaProgram> programs_; ///< empty if the formula is not valid
  std::vector<MotionOperand> operands_;
  std::vector<int> bodies_;
  FormulaTree tree_;
};

/// A formula in the equations of motion. `own` computes the values of its names `value` and `rate`; null if its element has no coordinate
/// of its own.
struct FormulaInMotion {
  const MotionFormula* formula = nullptr; ///< owned by its group
  std::function<OwnCoordinate<double>(const Evaluation& e)> own = nullptr;
  int unit = -1;   ///< index of its mode, the bits of its switches; -1 if it has none
  int element = 0; ///< index in System::element_names
};

/// Derivatives of an operand with respect to pose and velocity of one body.
struct MotionShare {
  int body = k_ground;
  Vec3 pose = Vec3::Zero(), velocity = Vec3::Zero();
};
/// Returns the derivatives of an operand with respect to poses and velocities of at most two bodies; not for states and signals. `own` is
/// the element's own coordinate as dual numbers of the motions of `own_a` and `own_b`.
[[nodiscard]] std::array<MotionShare, 2> shares_of(const MotionOperand& operand, const Evaluation& e, const OwnCoordinate<Dual<12>>& own,
                                                   int own_a, int own_b);

/// Factors that convert a switch quantity to an event function: weight · quantity + slack.
struct SwitchScale {
  double weight = 1.0; ///< of |a|, min and max: scales the quantity to a change of positions and velocities
  double slack = 0.0;  ///< allowed violation, since constrained quantities are zero only up to rounding
};
/// Sets the quantities before an evaluation to 1 or −1, in accordance with `bits`, so that switches that are not evaluated do not trigger.
template <class S> void preset_quantities(int count, SwitchBits bits, S* quantity) {
  for (int s = 0; s < count; ++s) quantity[s] = S(((bits >> static_cast<unsigned>(s)) & 1U) != 0 ? 1.0 : -1.0);
}
/// Computes the event functions from the quantities. They are ≥ 0 while `bits` are valid.
template <class S>
void switch_events(SwitchBits bits, const S* quantity, const std::vector<SwitchScale>& scales, S* event_value, S* event_derivative) {
  for (std::size_t s = 0; s < scales.size(); ++s) {
    const bool is_set = ((bits >> static_cast<unsigned>(s)) & 1U) != 0;
    event_value[s] = S(scales[s].weight) * (is_set ? quantity[s] : -quantity[s]) + S(scales[s].slack);
    event_derivative[s] = S(std::numeric_limits<double>::quiet_NaN());
  }
}
/// Returns the bits after the event function of switch `slot` became negative: that bit is inverted, and bits of switches that are
/// evaluated only now are determined from the motion.
[[nodiscard]] SwitchBits next_bits(const MotionFormula& formula, SwitchBits bits, int slot, const Evaluation& e,
                                   const OwnCoordinate<double>& own);
/// Returns the scale of each switch for the present motion.
[[nodiscard]] std::vector<SwitchScale> scales_of(const MotionFormula& formula, const Evaluation& e, const OwnCoordinate<double>& own);

/// Returns a signal that represents the time t itself.
[[nodiscard]] const Signal& clock_signal();

/// Evaluates signals at time t: as doubles (this struct), or as inputs of a tape (the next one).
struct NumericSignalEvaluator {
  double t;
  double operator()(const Signal& signal) const { return &signal == &clock_signal() ? t : signal.value(t); }
};
struct TracedSignalEvaluator {
  TracedEvaluation& e;
  TapeNumber operator()(const Signal& signal) const { return e.record_signal_input({&signal}); }
};

// ---------------------------------------------------------------------------------------------

namespace motion_formula {

template <class S> [[nodiscard]] const S& coordinate_of(const Motion<S>& m, int k) {
  const S* const all[] = {&m.x, &m.y, &m.theta, &m.vx, &m.vy, &m.omega};
  return *all[k];
}

/// Scratch memory of one evaluation, kept per thread.
template <class S> struct Room {
  std::vector<S> operands, values;
  void grow(std::size_t operand_count, std::size_t value_count) {
    if (operands.size() < operand_count) operands.resize(operand_count);
    if (values.size() < value_count) values.resize(value_count);
  }
  static Room& kept() {
    static thread_local Room room;
    return room;
  }
};

} // namespace motion_formula

template <class S, class AtTime>
void MotionFormula::read(const EvaluationData<S>& e, const OwnCoordinate<S>& own, const AtTime& at_time, S* x) const {
  for (const MotionOperand& operand : operands_) {
    switch (operand.kind) {
    case MotionOperand::Kind::own_value: *x = own.value; break;
    case MotionOperand::Kind::own_rate: *x = own.rate; break;
    case MotionOperand::Kind::coordinate: *x = motion_formula::coordinate_of(e.motion[operand.body], operand.coordinate); break;
    case MotionOperand::Kind::measure: {
      const MeasureValue<S> m = evaluate_row<false>(operand.row, e.motion[operand.row.a], e.motion[operand.row.b]);
      *x = operand.is_rate ? m.rate : m.value - S(operand.zero);
      break;
    }
    case MotionOperand::Kind::state: *x = S(operand.unit) * e.inner[operand.inner]; break;
    case MotionOperand::Kind::signal: *x = S(at_time(*operand.signal)); break;
    }
    ++x;
  }
}

template <class S, class AtTime>
S MotionFormula::value(const EvaluationData<S>& e, const OwnCoordinate<S>& own, const AtTime& at_time, SwitchBits bits, S* quantity) const {
  auto& room = motion_formula::Room<S>::kept();
  room.grow(operands_.size(), static_cast<std::size_t>(program().size()));
  read(e, own, at_time, room.operands.data());
  const S t = program().uses_time() ? S(at_time(clock_signal())) : S(0.0);
  return program().evaluate(room.operands.data(), t, bits, room.values.data(), quantity);
}

} // namespace steplap
