#include "mbd/io/part_frame.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/formula/formula.h"
#include "mbd/io/parameters_reader.h"
#include "mbd/io/units.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

bool is_zero(const NumberOrFormula& number) { return number.is_number() && number.value == 0.0; }

// Returns the number as text for an operand of a formula, in brackets if it is a formula.
std::string operand(const NumberOrFormula& number, const std::string& unit) {
  if (!number.is_number()) return "(" + number.formula + ")";
  const std::string text = number_text(number.value);
  if (!unit.empty()) return "'" + text + " " + unit + "'";
  return number.value < 0.0 ? "(" + text + ")" : text;
}

// Returns the number as text for the first operand of a sum. It needs no brackets, since sums are evaluated from the left.
std::string summand(const NumberOrFormula& number, const std::string& unit) {
  return number.is_number() ? operand(number, unit) : number.formula;
}

NumberOrFormula sum(const NumberOrFormula& a, const NumberOrFormula& b, const std::string& unit) {
  if (a.is_number() && b.is_number()) return {a.value + b.value, ""};
  return {0.0, summand(a, unit) + " + " + operand(b, unit)};
}

bool is_sum(const NumberOrFormula& number) { return number.formula.find_first_of("?<>=&|") == std::string::npos; }

void set(Node& node, const NumberOrFormula& number) {
  node.type = number.is_number() ? Node::Type::number : Node::Type::text;
  if (number.is_number()) node.scalar = number.value;
  else node.scalar = "= " + number.formula;
}

// Returns the value of a formula without names; nothing if it has another unit.
std::optional<double> value_without_operands(const Node& node, const std::string& unit) {
  try {
    const Formula formula(node.text().substr(node.text().find('=') + 1), "", {});
    const std::optional<UnitDimension> wanted = dimension_of(unit);
    const bool is_constant = formula.names().empty() && std::none_of(formula.tree().begin(), formula.tree().end(),
                                                                     [](const FormulaNode& n) { return n.op == FormulaOp::time; });
    if (!is_constant || !wanted || formula.dimension({}).powers != wanted->powers) return std::nullopt;
    std::vector<double> nodes(formula.tree().size());
    const double value = value_of(formula.tree(), nullptr, 0.0, nodes.data());
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  } catch (const ModelError&) {
    return std::nullopt;
  }
}

} // namespace

Node node_at(const std::string& key, const Node& at) {
  Node node;
  node.key = key;
  node.file = at.file;
  node.line = at.line;
  node.column = at.column;
  return node;
}

std::optional<NumberOrFormula> number_or_formula(const Node& node, const std::string& unit) {
  if (node.type == Node::Type::integer) return NumberOrFormula{static_cast<double>(std::get<long>(node.scalar)), ""};
  if (node.type == Node::Type::number) return NumberOrFormula{std::get<double>(node.scalar), ""};
  if (node.type != Node::Type::text) return std::nullopt;
  if (is_formula(node)) {
    if (const std::optional<double> value = value_without_operands(node, unit)) return NumberOrFormula{*value, ""};
    NumberOrFormula made{0.0, node.text().substr(node.text().find('=') + 1)};
    if (!is_sum(made)) made.formula = "(" + made.formula + ")";
    return made;
  }
  const Quantity quantity = parse_quantity(node.text(), unit);
  if (!quantity.problem.empty()) return std::nullopt;
  return NumberOrFormula{quantity.value, ""};
}

PartFrame::PartFrame(const PartFrame& outer, const NumberOrFormula& x, const NumberOrFormula& y, const NumberOrFormula& angle)
    : x_(outer.placed(x, y, false)), y_(outer.placed(x, y, true)), angle_(is_zero(angle)          ? outer.angle_
                                                                          : is_zero(outer.angle_) ? angle
                                                                                                  : sum(outer.angle_, angle, "")) {
  is_turned_ = !is_zero(angle_);
  is_placed_ = is_turned_ || !is_zero(x_) || !is_zero(y_);
  if (!is_turned_) return;
  if (angle_.is_number()) {
    const portable::SinCos both = portable::sin_cos(angle_.value);
    cos_.value = both.cos;
    sin_.value = both.sin;
  } else {
    cos_.formula = "cos(" + angle_.formula + ")";
    sin_.formula = "sin(" + angle_.formula + ")";
  }
}

NumberOrFormula PartFrame::turned(const NumberOrFormula& first, const NumberOrFormula& second, bool is_y, const std::string& unit) const {
  const NumberOrFormula &along = is_y ? sin_ : cos_, &across = is_y ? cos_ : sin_;
  if (first.is_number() && second.is_number() && angle_.is_number())
    return {is_y ? along.value * first.value + across.value * second.value : along.value * first.value - across.value * second.value, ""};
  const auto factor = [](const NumberOrFormula& n) { return n.is_number() ? operand(n, "") : n.formula; };
  return {0.0, factor(along) + "*" + operand(first, unit) + (is_y ? " + " : " - ") + factor(across) + "*" + operand(second, unit)};
}

NumberOrFormula PartFrame::placed(const NumberOrFormula& first, const NumberOrFormula& second, bool is_y) const {
  const NumberOrFormula& origin = is_y ? y_ : x_;
  if (!is_placed_) return is_y ? second : first;
  if (!is_turned_) return sum(origin, is_y ? second : first, "m");
  return sum(origin, turned(first, second, is_y, "m"), "m");
}

void PartFrame::place_points(Node& node) const {
  if (!is_placed_ || node.type != Node::Type::array) return;
  if (node.children.size() != 2 || node.children.front().type == Node::Type::array) {
    for (Node& child : node.children) place_points(child);
    return;
  }
  const std::optional<NumberOrFormula> x = number_or_formula(node.children[0], "m"), y = number_or_formula(node.children[1], "m");
  if (!x || !y) return;
  set(node.children[0], placed(*x, *y, false));
  set(node.children[1], placed(*x, *y, true));
}

void PartFrame::turn_vector(Node& node, const std::string& unit) const {
  if (!is_turned_ || node.type != Node::Type::array || node.children.size() != 2) return;
  const std::optional<NumberOrFormula> x = number_or_formula(node.children[0], unit), y = number_or_formula(node.children[1], unit);
  if (!x || !y) return;
  set(node.children[0], turned(*x, *y, false, unit));
  set(node.children[1], turned(*x, *y, true, unit));
}

void PartFrame::turn_angle(Node& node) const {
  if (!is_turned_) return;
  if (const std::optional<NumberOrFormula> angle = number_or_formula(node, "rad")) set(node, sum(angle_, *angle, ""));
}

Node PartFrame::origin_node(const std::string& key, const Node& where) const {
  Node node = node_at(key, where);
  node.type = Node::Type::array;
  node.children = {node_at("", where), node_at("", where)};
  set(node.children[0], x_);
  set(node.children[1], y_);
  return node;
}

Node PartFrame::angle_node(const std::string& key, const Node& where) const {
  Node node = node_at(key, where);
  set(node, angle_);
  return node;
}

} // namespace steplap
