// Formulas as people write them, `[[channel]] expression = "abs({front foot.force}) / '12 kN'"`: their text becomes a tree.
//
//   ? :   ||   &&   < <= > >= == !=   + -   * /   - !   ^   ( )     from the weakest to the strongest
//   abs sqrt hypot min max sin cos tan asin acos atan atan2 exp ln log10   pi   t (time)
//   name            of a channel, if it holds letters, digits, _ and points only; any other in braces, {active part.x},
//                   also as trajectory.csv heads it, {active part.x [m]}
//   '12 kN'         a number with its unit; a number without one has none
// Units are derived: what is added, compared or chosen from is of one dimension, functions of angles and logarithms take
// numbers. The same bits on every machine (portable_math.h). Where there is no finite value (a division by zero, a root of
// what is negative) it is not-a-number. min and max take two values or more; comparisons give 1 or 0.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/formula/formula_tree.h"
#include "mbd/formula/unit_dimension.h"

#include <string>
#include <string_view>
#include <vector>

namespace steplap {

class Formula {
public:
  /// Throws ModelError at `where` for what is no formula; `subject` begins its messages.
  Formula(const std::string& text, const std::string& subject, const Location& where);

  /// Names of channels, each once, in the order in which it first appears: the operands.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const FormulaTree& tree() const { return tree_; }
  /// What it is of, from the units of names(). Throws ModelError where they do not go together.
  [[nodiscard]] UnitDimension dimension(const std::vector<std::string>& units) const;

private:
  friend class FormulaParser;
  struct Typed; ///< a value as the derivation of units sees it
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
