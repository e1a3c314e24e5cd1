// Syntax tree of a formula: a list of nodes, each after its operands. The last node is the formula. Values, bounds over a time interval and
// derivatives are computed by traversing the same nodes with different number types (evaluate(), below). A node may be an operand of
// several others.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace steplap {

enum class FormulaOp : unsigned char {
  number,
  operand,
  time,
  add,
  subtract,
  multiply,
  divide,
  power,
  negate,
  abs,
  sqrt,
  hypot,
  min,
  max,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  exp,
  ln,
  log10,
  less,
  less_or_equal,
  equal,
  both,
  either,
  negation, ///< true is 1 and false is 0; any nonzero number counts as true
  choice,   ///< the second operand if the first is true, otherwise the third
  finite,   ///< NaN for infinite operands
};

/// One number, operand or operation of a formula.
struct FormulaNode {
  FormulaOp op = FormulaOp::number;
  std::array<int, 3> of{-1, -1, -1}; ///< nodes that are its operands
  double number = 0.0;               ///< SI
  int operand = 0;
  std::array<double, 3> powers{}; ///< exponents of kg, m, s in the unit of a number
  std::size_t begin = 0, end = 0; ///< range in the text covered by the node and its operands
};

using FormulaTree = std::vector<FormulaNode>;

/// Computes the values of all nodes in `values`, and returns that of the last one, which is the formula. The class `Numbers` defines the
/// number type and a static function for each operation.
template <class Numbers>
const typename Numbers::Value& evaluate(const FormulaTree& tree, const typename Numbers::Value* operands, const typename Numbers::Value& t,
                                        typename Numbers::Value* values) {
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const FormulaNode& node = tree[i];
    const auto of = [&](std::size_t k) -> const typename Numbers::Value& { return values[node.of[k]]; };
    auto& value = values[i];
    switch (node.op) {
    case FormulaOp::number: value = Numbers::number(node.number); break;
    case FormulaOp::operand: value = operands[node.operand]; break;
    case FormulaOp::time: value = t; break;
    case FormulaOp::add: value = Numbers::add(of(0), of(1)); break;
    case FormulaOp::subtract: value = Numbers::subtract(of(0), of(1)); break;
    case FormulaOp::multiply: value = Numbers::multiply(of(0), of(1)); break;
    case FormulaOp::divide: value = Numbers::divide(of(0), of(1)); break;
    case FormulaOp::power: value = Numbers::power(of(0), of(1)); break;
    case FormulaOp::negate: value = Numbers::negate(of(0)); break;
    case FormulaOp::abs: value = Numbers::abs(of(0)); break;
    case FormulaOp::sqrt: value = Numbers::sqrt(of(0)); break;
    case FormulaOp::hypot: value = Numbers::hypot(of(0), of(1)); break;
    case FormulaOp::min: value = Numbers::min(of(0), of(1)); break;
    case FormulaOp::max: value = Numbers::max(of(0), of(1)); break;
    case FormulaOp::sin: value = Numbers::sin(of(0)); break;
    case FormulaOp::cos: value = Numbers::cos(of(0)); break;
    case FormulaOp::tan: value = Numbers::tan(of(0)); break;
    case FormulaOp::asin: value = Numbers::asin(of(0)); break;
    case FormulaOp::acos: value = Numbers::acos(of(0)); break;
    case FormulaOp::atan: value = Numbers::atan(of(0)); break;
    case FormulaOp::atan2: value = Numbers::atan2(of(0), of(1)); break;
    case FormulaOp::exp: value = Numbers::exp(of(0)); break;
    case FormulaOp::ln: value = Numbers::ln(of(0)); break;
    case FormulaOp::log10: value = Numbers::log10(of(0)); break;
    case FormulaOp::less: value = Numbers::less(of(0), of(1)); break;
    case FormulaOp::less_or_equal: value = Numbers::less_or_equal(of(0), of(1)); break;
    case FormulaOp::equal: value = Numbers::equal(of(0), of(1)); break;
    case FormulaOp::both: value = Numbers::both(of(0), of(1)); break;
    case FormulaOp::either: value = Numbers::either(of(0), of(1)); break;
    case FormulaOp::negation: value = Numbers::negation(of(0)); break;
    case FormulaOp::choice: value = Numbers::choice(of(0), of(1), of(2)); break;
    case FormulaOp::finite: value = Numbers::finite(of(0)); break;
    }
  }
  return values[tree.size() - 1];
}

/// Returns the value of a tree for operands in SI; NaN if there is no finite value. `values`: scratch, one number per node.
[[nodiscard]] double value_of(const FormulaTree& tree, const double* operands, double t, double* values);

} // namespace steplap
