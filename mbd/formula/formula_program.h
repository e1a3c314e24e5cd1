// Evaluation of a formula in the equations of motion: in smooth pieces, for all number types.
//
// A formula is smooth except for its switches: |a|, min, max and comparisons. Each switch has a bit that selects one of its two pieces, and
// a quantity whose change of sign ends the piece:
//
//   switch     quantity      bit 1         bit 0
//   |a|        a             a             −a
//   min(a, b)  b − a         a             b
//   max(a, b)  a − b         a             b
//   a < b      b − a         true          false      (also for a ≤ b; they differ only if a run begins with a = b)
//
// For given bits evaluate() makes the same operations for all numbers: double, Dual (mbd/base/dual.h) or Traced (mbd/tape). The operands of
// `?` and `:` are evaluated only if selected. A step may continue slightly beyond the end of a piece before this is detected, and then
// sqrt(max(x, 0)) has a negative argument. Square roots and fractional powers of negative numbers are therefore 0 here, and asin and acos
// of arguments above 1 are those of 1. Integer powers are products. The derivative of sqrt(0) is 0, so that hypot(0, 0) has a derivative.
#pragma once

#include "mbd/base/dual.h"
#include "mbd/formula/formula_tree.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace steplap {

/// Bits of all switches of one or several formulas; bit s belongs to switch s.
using SwitchBits = std::uint32_t;
inline constexpr int k_most_switches = 32;

namespace formula_math {

/// Returns true if the exponent is not an integer, so that powers of negative numbers do not exist.
inline bool is_fraction(double exponent) { return exponent != std::floor(exponent); }
inline double power(double a, double b) { return a < 0.0 && is_fraction(b) ? 0.0 : portable::pow(a, b); }
inline double exponential(double a) { return portable::pow(std::numbers::e, a); }
inline double logarithm(double a) { return portable::log10(a) * std::numbers::ln10; }
inline double root(double a) { return std::sqrt(a < 0.0 ? 0.0 : a); }
inline double arc(double y, double x) { return portable::atan2(y, x); }
inline void turn(double a, double& sine, double& cosine) {
  const portable::SinCos both = portable::sin_cos(a);
  sine = both.sin;
  cosine = both.cos;
}

template <int N> Dual<N> exponential(const Dual<N>& a) {
  const double value = exponential(a.v);
  return {value, value * a.d};
}
template <int N> Dual<N> logarithm(const Dual<N>& a) { return {logarithm(a.v), a.d / a.v}; }
template <int N> Dual<N> root(const Dual<N>& a) {
  if (a.v <= 0.0) return {0.0};
  return sqrt(a);
}
template <int N> Dual<N> power(const Dual<N>& a, const Dual<N>& b) {
  if (a.v < 0.0 && is_fraction(b.v)) return {0.0};
  if ((b.d == 0.0).all()) return pow(a, b.v);
  const double value = power(a.v, b.v);
  return {value, value * (b.d * logarithm(a.v) + b.v / a.v * a.d)};
}
template <int N> Dual<N> arc(const Dual<N>& y, const Dual<N>& x) { return atan2(y, x); }
template <int N> void turn(const Dual<N>& a, Dual<N>& sine, Dual<N>& cosine) {
  sine = sin(a);
  cosine = cos(a);
}

// The functions below have no operation on a tape. They are recorded as calls (mbd/tape/traced.h).
template <class S> S power(const S& a, const S& b) {
  const S arguments[] = {a, b};
  S value;
  S::call([](const double* of, double* found) { *found = power(of[1], of[2]); }, arguments, {&value, 1});
  return value;
}
template <double (*function)(double), class S> S called(const S& a) {
  S value;
  S::call([](const double* of, double* found) { *found = function(of[1]); }, {&a, 1}, {&value, 1});
  return value;
}
template <class S> S exponential(const S& a) { return called<exponential>(a); }
template <class S> S logarithm(const S& a) { return called<logarithm>(a); }
template <class S> S root(const S& a) { return sqrt(greatest_of(a, S(0.0))); }
template <class S> S arc(const S& y, const S& x) { return atan2(y, x); }
template <class S> void turn(const S& a, S& sine, S& cosine) { find_sin_cos(a, sine, cosine); }

} // namespace formula_math

/// A formula compiled to a list of steps (operations).
class FormulaProgram {
public:
  struct Step {
    FormulaOp op = FormulaOp::number;
    std::array<int, 3> of{-1, -1, -1}; ///< steps that are its operands
    double number = 0.0;
    int index = -1; ///< index of the operand or of the switch
    int guard = -1; ///< condition under which the step is evaluated, an index of a Guard; −1: always
  };
  struct Guard {
    int condition = -1; ///< index of a step
    bool is_wanted = true;
    int outer = -1; ///< enclosing guard, which must hold as well; −1: none
  };
  /// Bits of the switches. Bits not in `are_given` are determined during evaluation.
  struct Bits {
    SwitchBits values = 0;
    SwitchBits are_given = ~SwitchBits{0};
  };

  /// Compiles the formula. Throws std::invalid_argument for formulas that cannot be used in equations of motion; the message continues a
  /// sentence that begins with "the formula".
  explicit FormulaProgram(const FormulaTree& tree);

  [[nodiscard]] int size() const { return static_cast<int>(steps_.size()); }
  [[nodiscard]] int operand_count() const { return operand_count_; }
  [[nodiscard]] int switch_count() const { return switch_count_; }
  /// Returns true if the value can jump when switch `s` changes: for comparisons, not for |a|, min and max.
  [[nodiscard]] bool is_comparison(int s) const { return comparisons_[static_cast<std::size_t>(s)] != 0; }
  [[nodiscard]] bool has_comparisons() const;
  /// Returns true if all pieces and all switch quantities are linear in operands and time.
  [[nodiscard]] bool is_linear() const;
  [[nodiscard]] bool uses_time() const { return uses_time_; }
  /// Returns true if the value may rise and fall again during an arbitrarily small change of the operands. This is assumed for several
  /// switches, switches of nonlinear quantities, exponentials, and powers and quotients of variables.
  [[nodiscard]] bool may_peak() const;

  /// Returns the value for given switch bits. `values`: scratch for size() numbers. `quantity`, if not null, receives the quantity of each
  /// switch; entries of switches that are not evaluated stay unchanged.
  template <class S> S evaluate(const S* operands, const S& t, SwitchBits bits, S* values, S* quantity) const {
    Bits given{bits};
    return run<false>(operands, t, given, values, quantity);
  }
  /// Returns the value like evaluate(), and determines the bits that are not given from the operands. `bits.values` then contains the bits
  /// that were used.
  double find_bits(const double* operands, double t, Bits& bits, double* values) const {
    return run<true>(operands, t, bits, values, static_cast<double*>(nullptr));
  }
  /// Returns the set of switches that are evaluated for these bits; those in unselected branches of `? :` are not.
  [[nodiscard]] SwitchBits counting(SwitchBits bits) const;

private:
  [[nodiscard]] bool is_boolean(int node) const;
  void require_condition(int node) const;
  int add(FormulaOp op, int a = -1, int b = -1, int c = -1);
  int add_number(double number);
  int add_power(int base, int exponent);
  void add_node(const FormulaNode& node, std::vector<int>& place);
  void set_guards();
  // Returns the innermost of `guard` and its enclosing guards for which all conditions, its own and the enclosing ones, are computed before
  // `step`; −1 if there is none.
  [[nodiscard]] int innermost_guard_before(int guard, int step) const;
  template <class S> [[nodiscard]] bool holds(int guard, const S* values) const {
    for (; guard >= 0; guard = guards_[static_cast<std::size_t>(guard)].outer) {
      const Guard& g = guards_[static_cast<std::size_t>(guard)];
      if ((value_of(values[g.condition]) != 0.0) != g.is_wanted) return false;
    }
    return true;
  }
  // Returns the bit of switch `s` with quantity `q`. If the bit is not given, it is q > 0 for `is_strict`, else q ≥ 0.
  template <bool Finds, class S> static bool bit_of(int s, const S& q, Bits& bits, S* quantity, bool is_strict = false) {
    const SwitchBits mask = SwitchBits{1} << static_cast<unsigned>(s);
    if constexpr (Finds) {
      const bool is_set = is_strict ? value_of(q) > 0.0 : value_of(q) >= 0.0;
      if ((bits.are_given & mask) == 0) bits.values = is_set ? bits.values | mask : bits.values & ~mask;
    }
    if (quantity) quantity[s] = q;
    return (bits.values & mask) != 0;
  }
  template <bool Finds, class S> S run(const S* operands, const S& t, Bits& bits, S* values, S* quantity) const;

  std::vector<Step> steps_;
  std::vector<Guard> guards_;
  std::vector<char> comparisons_; ///< per switch
  int operand_count_ = 0, switch_count_ = 0;
  bool uses_time_ = false;
};

// ---------------------------------------------------------------------------------------------

template <bool Finds, class S> S FormulaProgram::run(const S* operands, const S& t, Bits& bits, S* values, S* quantity) const {
  using namespace formula_math;
  const auto is_true = [&](int step) { return value_of(values[step]) != 0.0; };
  S* value = values;
  for (const Step& step : steps_) {
    if (step.guard >= 0 && !holds(step.guard, values)) {
      ++value;
      continue;
    }
    const auto of = [&](std::size_t k) -> const S& { return values[step.of[k]]; };
    S sine, cosine;
    switch (step.op) {
    case FormulaOp::number: *value = S(step.number); break;
    case FormulaOp::operand: *value = operands[step.index]; break;
    case FormulaOp::time: *value = t; break;
    case FormulaOp::add: *value = of(0) + of(1); break;
    case FormulaOp::subtract: *value = of(0) - of(1); break;
    case FormulaOp::multiply: *value = of(0) * of(1); break;
    case FormulaOp::divide: *value = of(0) / of(1); break;
    case FormulaOp::power: *value = power(of(0), of(1)); break;
    case FormulaOp::negate: *value = -of(0); break;
    case FormulaOp::sqrt: *value = root(of(0)); break;
    case FormulaOp::hypot: *value = root(of(0) * of(0) + of(1) * of(1)); break;
    case FormulaOp::sin: turn(of(0), *value, cosine); break;
    case FormulaOp::cos: turn(of(0), sine, *value); break;
    case FormulaOp::tan:
      turn(of(0), sine, cosine);
      *value = sine / cosine;
      break;
    case FormulaOp::asin: *value = arc(of(0), root((S(1.0) - of(0)) * (S(1.0) + of(0)))); break;
    case FormulaOp::acos: *value = arc(root((S(1.0) - of(0)) * (S(1.0) + of(0))), of(0)); break;
    case FormulaOp::atan: *value = arc(of(0), S(1.0)); break;
    case FormulaOp::atan2: *value = arc(of(0), of(1)); break;
    case FormulaOp::exp: *value = exponential(of(0)); break;
    case FormulaOp::ln: *value = logarithm(of(0)); break;
    case FormulaOp::log10: *value = logarithm(of(0)) * S(1.0 / std::numbers::ln10); break;
    case FormulaOp::abs: *value = bit_of<Finds>(step.index, of(0), bits, quantity) ? of(0) : -of(0); break;
    case FormulaOp::min: *value = bit_of<Finds>(step.index, S(of(1) - of(0)), bits, quantity) ? of(0) : of(1); break;
    case FormulaOp::max: *value = bit_of<Finds>(step.index, S(of(0) - of(1)), bits, quantity) ? of(0) : of(1); break;
    case FormulaOp::less:
    case FormulaOp::less_or_equal:
      *value = S(bit_of<Finds>(step.index, S(of(1) - of(0)), bits, quantity, step.op == FormulaOp::less) ? 1.0 : 0.0);
      break;
    case FormulaOp::both: *value = S(is_true(step.of[0]) && is_true(step.of[1]) ? 1.0 : 0.0); break;
    case FormulaOp::either: *value = S(is_true(step.of[0]) || is_true(step.of[1]) ? 1.0 : 0.0); break;
    case FormulaOp::negation: *value = S(is_true(step.of[0]) ? 0.0 : 1.0); break;
    case FormulaOp::choice: *value = is_true(step.of[0]) ? of(1) : of(2); break;
    case FormulaOp::equal: break; // rejected by the constructor
    case FormulaOp::finite: *value = of(0); break;
    }
    ++value;
  }
  return values[steps_.size() - 1];
}

} // namespace steplap
