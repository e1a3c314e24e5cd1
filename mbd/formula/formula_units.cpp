#include "mbd/formula/formula.h"

#include "mbd/base/number_text.h"

namespace steplap {

struct Formula::Typed {
  std::array<double, 3> powers{};
  bool is_any = false;      ///< zero, which has no unit and may be added to anything
  bool is_constant = false; ///< a number in the formula; `value` is set
  double value = 0.0;

  [[nodiscard]] bool is_number() const { return powers == std::array<double, 3>{}; }
};

namespace {

std::string said(const std::array<double, 3>& powers) {
  const std::string unit = unit_text(powers);
  return unit.empty() ? "no unit" : "the unit " + unit;
}

} // namespace

void Formula::fail(const FormulaNode& at, const std::string& message) const {
  throw ModelError(where_, subject_ + ": in '" + text_.substr(at.begin, at.end - at.begin) + "' " + message);
}

// Returns the common dimension of both operands. Throws ModelError if they differ.
Formula::Typed Formula::same(const FormulaNode& node, const Typed& a, const Typed& b) const {
  Typed both;
  both.powers = a.is_any ? b.powers : a.powers;
  both.is_any = a.is_any && b.is_any;
  if (a.is_any || b.is_any || a.powers == b.powers) return both;
  std::string hint;
  if (a.is_constant != b.is_constant) { // a number without unit
    const Typed& other = a.is_constant ? b : a;
    const Typed& bare = a.is_constant ? a : b;
    if (bare.is_number()) hint = "; write it with its unit, '" + number_text(bare.value) + " " + unit_text(other.powers) + "'";
  }
  fail(node, "one side has " + said(a.powers) + ", the other " + said(b.powers) + hint);
}

Formula::Typed Formula::of_leaf(const FormulaNode& node, const std::vector<std::string>& units) const {
  Typed value;
  if (node.op == FormulaOp::number) {
    value.powers = node.powers;
    value.value = node.number;
    value.is_constant = true;
    value.is_any = node.number == 0.0;
  } else if (node.op == FormulaOp::time) {
    value.powers = {0.0, 0.0, 1.0};
  } else {
    const std::string& unit = units[static_cast<std::size_t>(node.operand)];
    const std::optional<UnitDimension> known = dimension_of(unit);
    if (!known) fail(node, "the unit '" + unit + "' of the channel is not known to formulas");
    value.powers = known->powers;
  }
  return value;
}

Formula::Typed Formula::of_operation(const FormulaNode& node, const std::vector<Typed>& known) const {
  const auto of = [&](std::size_t k) { return known[static_cast<std::size_t>(node.of[k])]; };
  Typed a = of(0);
  switch (node.op) {
  case FormulaOp::add:
  case FormulaOp::subtract:
  case FormulaOp::hypot:
  case FormulaOp::min:
  case FormulaOp::max: return same(node, a, of(1));
  case FormulaOp::atan2:
  case FormulaOp::less:
  case FormulaOp::less_or_equal:
  case FormulaOp::equal: (void)same(node, a, of(1)); return {};
  case FormulaOp::choice:
    if (!a.is_number()) fail(node, "the condition has " + said(a.powers) + ": compare it with something");
    return same(node, of(1), of(2));
  case FormulaOp::both:
  case FormulaOp::either:
    if (!a.is_number() || !of(1).is_number())
      fail(node, "a condition has " + said(a.is_number() ? of(1).powers : a.powers) + ": compare it with something");
    return {};
  case FormulaOp::multiply:
  case FormulaOp::divide: {
    const Typed b = of(1);
    const bool is_quotient = node.op == FormulaOp::divide;
    for (std::size_t k = 0; k < 3; ++k) a.powers[k] += is_quotient ? -b.powers[k] : b.powers[k];
    a.is_any = a.is_any && is_quotient;
    a.is_constant = a.is_constant && b.is_constant;
    a.value = is_quotient ? a.value / b.value : a.value * b.value;
    return a;
  }
  case FormulaOp::power: {
    const Typed b = of(1);
    if (!b.is_number()) fail(node, "the exponent has " + said(b.powers));
    if (!a.is_number() && !b.is_constant) fail(node, "what has a unit takes a number as its exponent");
    for (double& power : a.powers)
      if (power != 0.0) power *= b.value;
    a.is_constant = a.is_any = false;
    return a;
  }
  case FormulaOp::negate: a.value = -a.value; return a;
  case FormulaOp::abs:
  case FormulaOp::finite: a.is_constant = false; return a;
  case FormulaOp::sqrt:
    for (double& power : a.powers) power *= 0.5;
    a.is_constant = false;
    return a;
  default: // functions of dimensionless numbers
    if (!a.is_number()) fail(node, "the function takes what has no unit, not " + said(a.powers) + ": divide by some '1 …' first");
    return {};
  }
}

UnitDimension Formula::dimension(const std::vector<std::string>& units) const {
  std::vector<Typed> known;
  for (const FormulaNode& node : tree_) known.push_back(node.of[0] < 0 ? of_leaf(node, units) : of_operation(node, known));
  return {1.0, known.back().powers};
}

} // namespace steplap
