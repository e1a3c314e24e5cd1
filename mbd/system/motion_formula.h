// Formulas in the equations of motion: of places, angles and velocities, of states, signals, parameters and time.
//
// What a name stands for, in this order:
//   value, rate            of the element's own coordinate, where it has one
//   a state's name         `[[state]]`
//   a parameter's name     `[parameters]`
//   a signal's name        at the time; a number without a unit, for a signal has none: drive * '1 N'
//   B.x .y .theta .vx .vy .omega   of body B;  M.x .y .vx .vy  of marker M: as the channels of these names
//   a channel that is a measure of two bodies, or its rate (measured_channel.h): "spring.elongation", "pin.angle"
//   a `[[channel]]` whose formula is made of these
// Forces, reactions and accelerations are none: they follow from the forces that such a formula gives.
#pragma once

#include "mbd/formula/formula_program.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/turn_table.h"

#include <array>
#include <string>
#include <vector>

namespace steplap {

/// What a motion formula reads.
struct MotionOperand {
  enum class Kind : unsigned char { own_value, own_rate, coordinate, measure, state, signal };
  Kind kind = Kind::own_value;
  int body = k_ground, coordinate = 0; ///< coordinate: 0 … 5, x, y, θ and their rates
  RowSpec row;                         ///< of a measure
  double zero = 0.0;                   ///< what is taken from its value
  bool is_rate = false;                ///< of a measure
  int inner = 0;                       ///< of a state: in State::inner
  double unit = 1.0;                   ///< of a state: SI for one of what is kept there
  const Signal* signal = nullptr;
};

/// What the formula of an element is asked with.
struct MotionFormulaText {
  std::string text;
  std::string field;                    ///< that holds it, for messages
  std::string unit;                     ///< that its value must have; nothing is converted: values are in SI
  std::string own_value, own_rate = {}; ///< units of `value` and `rate`; "-": there is no such name
};

/// `value` and `rate` of the element's own coordinate, where it has one.
template <class S> struct OwnCoordinate {
  S value{0}, rate{0};
};

class MotionFormula {
public:
  /// Reports what is wrong through the builder's errors; then the formula is not valid. To be called at stage 1.
  MotionFormula(SystemBuilder& builder, const MotionFormulaText& text);

  [[nodiscard]] bool is_valid() const { return !programs_.empty(); }
  [[nodiscard]] const FormulaProgram& program() const { return programs_.front(); }
  /// Returns the tree that the program was made of.
  [[nodiscard]] const FormulaTree& tree() const { return tree_; }
  [[nodiscard]] const std::vector<MotionOperand>& operands() const { return operands_; }
  /// Bodies whose motion it reads, besides that of its own coordinate.
  [[nodiscard]] const std::vector<int>& bodies() const { return bodies_; }

  /// Enters the angles on which it depends other than linearly, besides its own coordinate.
  void enter_turns(TurnTable& turns) const;

  /// The value in an evaluation. `at_time(signal)`: what a signal is at the time; `quantity` as in FormulaProgram.
  template <class S, class AtTime>
  S value(const Evaluated<S>& e, const OwnCoordinate<S>& own, const AtTime& at_time, SwitchBits bits, S* quantity) const;
  /// Bits of its switches as they are now, but for those given.
  void find_bits(const Evaluation& e, const OwnCoordinate<double>& own, FormulaProgram::Bits& bits) const;
  /// Value with its derivatives by all operands: into `derivatives`, which has room for them.
  double differentiate(const Evaluation& e, const OwnCoordinate<double>& own, SwitchBits bits, double* derivatives) const;
  /// By what each switch's quantity changes with places and velocities in this pose, all together: at least a little.
  [[nodiscard]] std::vector<double> gains(const Evaluation& e, const OwnCoordinate<double>& own, SwitchBits bits) const;

private:
  class Resolver;
  template <class S, class AtTime> void read(const Evaluated<S>& e, const OwnCoordinate<S>& own, const AtTime& at_time, S* x) const;

  std::vector<FormulaProgram> programs_; ///< one, if it is valid
  std::vector<MotionOperand> operands_;
  std::vector<int> bodies_;
  FormulaTree tree_;
};

/// A body's share of the derivatives of an operand: by its pose and its velocity.
struct MotionShare {
  int body = k_ground;
  Vec3 pose = Vec3::Zero(), velocity = Vec3::Zero();
};
/// Of an operand that is no state and no signal; `own`: the element's coordinate by poses and velocities of `own_a` and `own_b`.
[[nodiscard]] std::array<MotionShare, 2> shares_of(const MotionOperand& operand, const Evaluation& e, const OwnCoordinate<Dual<12>>& own,
                                                   int own_a, int own_b);

/// How a switch's quantity becomes a watch value.
struct SwitchScale {
  double weight = 1.0; ///< of |a|, min and max: to what places and velocities change by
  double slack = 0.0;  ///< by which a piece goes on beyond its end: what joints hold at zero is known no better
};
/// Before a formula is evaluated: what does not count is far from its end.
template <class S> void preset_quantities(int count, SwitchBits bits, S* quantity) {
  for (int s = 0; s < count; ++s) quantity[s] = S(((bits >> static_cast<unsigned>(s)) & 1U) != 0 ? 1.0 : -1.0);
}
/// After it: watch values that hold while they are ≥ 0.
template <class S>
void watch_switches(SwitchBits bits, const S* quantity, const std::vector<SwitchScale>& scales, S* watch, S* watch_rate) {
  for (std::size_t s = 0; s < scales.size(); ++s) {
    const bool is_set = ((bits >> static_cast<unsigned>(s)) & 1U) != 0;
    watch[s] = S(scales[s].weight) * (is_set ? quantity[s] : -quantity[s]) + S(scales[s].slack);
    watch_rate[s] = S(std::numeric_limits<double>::quiet_NaN());
  }
}
/// The bits after that of `slot` has changed: what did not count before is found anew.
[[nodiscard]] SwitchBits next_bits(const MotionFormula& formula, SwitchBits bits, int slot, const Evaluation& e,
                                   const OwnCoordinate<double>& own);
/// Per switch, from where the motion is.
[[nodiscard]] std::vector<SwitchScale> scales_of(const MotionFormula& formula, const Evaluation& e, const OwnCoordinate<double>& own);

/// The time as a signal.
[[nodiscard]] const Signal& clock_signal();

/// What signals are in an evaluation of doubles, and in one that is written down.
struct SignalsNow {
  double t;
  double operator()(const Signal& signal) const { return &signal == &clock_signal() ? t : signal.value(t); }
};
struct SignalsTraced {
  TracedEvaluation& e;
  Traced operator()(const Signal& signal) const { return e.of_time({&signal}); }
};

// ---------------------------------------------------------------------------------------------

namespace motion_formula {

template <class S> [[nodiscard]] const S& coordinate_of(const Motion<S>& m, int k) {
  const S* const all[] = {&m.x, &m.y, &m.theta, &m.vx, &m.vy, &m.omega};
  return *all[k];
}

/// Room that one evaluation needs.
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
void MotionFormula::read(const Evaluated<S>& e, const OwnCoordinate<S>& own, const AtTime& at_time, S* x) const {
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
S MotionFormula::value(const Evaluated<S>& e, const OwnCoordinate<S>& own, const AtTime& at_time, SwitchBits bits, S* quantity) const {
  auto& room = motion_formula::Room<S>::kept();
  room.grow(operands_.size(), static_cast<std::size_t>(program().size()));
  read(e, own, at_time, room.operands.data());
  const S t = program().uses_time() ? S(at_time(clock_signal())) : S(0.0);
  return program().evaluate(room.operands.data(), t, bits, room.values.data(), quantity);
}

} // namespace steplap
