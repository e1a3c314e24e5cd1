// Formulas of channels, `[[channel]] expression = "abs({front foot.force}) / '12 kN'"`.
//
//   + - * / ^ ( )   abs sqrt hypot min max sin cos tan asin acos atan atan2 exp ln log10   pi   t (time)
//   name            of a channel, if it holds letters, digits, _ and points only; any other in braces, {active part.x},
//                   also as trajectory.csv heads it, {active part.x [m]}
//   '12 kN'         a number with its unit; a number without one has none
// Units are derived: what is added or compared is of one dimension, functions of angles and logarithms take numbers. The same
// bits on every machine (portable_math.h). Where there is no finite value (a division by zero, a root of what is negative) it
// is not-a-number.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/system/unit_dimension.h"

#include <string>
#include <string_view>
#include <vector>

namespace steplap {

class ChannelExpression {
public:
  /// Throws ModelError at `where` for what is no formula; `subject` begins its messages.
  ChannelExpression(const std::string& text, const std::string& subject, const Location& where);

  /// Names of channels, each once, in the order in which it first appears.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// What it is of, from the units of names(). Throws ModelError where they do not go together.
  [[nodiscard]] UnitDimension dimension(const std::vector<std::string>& units) const;
  /// In SI, for values of names() and the time.
  [[nodiscard]] double value(const double* operands, double t) const;

private:
  friend class ExpressionParser;
  enum class Code : unsigned char {
    number, operand, time, add, subtract, multiply, divide, power, negate,
    abs, sqrt, hypot, min, max, sin, cos, tan, asin, acos, atan, atan2, exp, ln, log10
  };
  struct Op { // of a stack machine
    Code code;
    double number = 0.0; ///< SI
    int operand = 0;
    std::array<double, 3> powers{}; ///< of a number
    std::size_t begin = 0, end = 0; ///< in the text: what it and its operands span
  };
  struct Function {
    std::string_view name;
    Code code;
    int arguments;
  };
  struct Typed; ///< a value as the derivation of units sees it
  static const std::vector<Function>& functions();
  [[noreturn]] void fail(const Op& at, const std::string& message) const;
  void derive(const Op& op, std::vector<Typed>& stack) const;
  void same(const Op& op, const Typed& a, const Typed& b) const;

  static constexpr int k_deepest = 64; ///< of the stack

  std::string text_, subject_;
  Location where_;
  std::vector<std::string> names_;
  std::vector<Op> ops_;
};

} // namespace steplap
