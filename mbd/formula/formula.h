// Parser for formulas in models, such as `[[channel]] expression = "abs({front foot.force}) / '12 kN'"`.
//
//   ? :   ||   &&   < <= > >= == !=   + -   * /   - !   ^   ( )     from lowest to highest precedence
//   abs sqrt hypot min max sin cos tan asin acos atan atan2 exp ln log10   pi   t (time)
//   name            a channel, if it consists of letters, digits, _ and points; any other name in braces, {active part.x},
//                   also with its unit, as in the header of trajectory.csv: {active part.x [m]}
//   '12 kN'         a number with its unit; a number without one has none
// Units are derived: operands of sums, comparisons and choices must have the same dimension; trigonometric functions and logarithms take
// dimensionless numbers. Results are bit-identical on every machine (portable_math.h), and NaN if there is no finite value (division by
// zero, square root of a negative number). min and max take two or more arguments; comparisons give 1 or 0.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/formula/formula_tree.h"
#include "mbd/formula/unit_dimension.h"

#include <string>
#include <string_view>
#include <vector>

namespace steplap {

/// A parsed formula.
class Formula {
public:
  /// Parses the text. Throws ModelError at `where` if it is not a formula; `subject` begins the messages.
  Formula(const std::string& text, const std::string& subject, const Location& where);

  /// Returns the names of the channels in the formula, its operands, each once, in the order of first appearance.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const FormulaTree& tree() const { return tree_; }
  /// Returns the dimension of the result if operand i has the unit units[i], in the order of names(). Throws ModelError if the units do not
  /// fit together.
  [[nodiscard]] UnitDimension dimension(const std::vector<std::string>& units) const;

private:
  friend class FormulaParser;
  struct Typed; ///< value with its dimension, for the derivation of units
  [[noreturn]] void fail(const FormulaNode& at, const std::string& message) const;
  [[nodiscard]] Typed of_leaf(const FormulaNode& node, const std::vector<std::string>& units) const;
  [[nodiscard]] Typed of_operation(const FormulaNode& node, const std::vector<Typed>& known) const;
  [[nodiscard]] Typed same(const FormulaNode& node, const Typed& a, const Typed& b) const;

  std::string text_, subject_;
  Location where_;
  std::vector<std::string> names_;
  FormulaTree tree_;
};

} // namespace steplap
