#include "mbd/formula/formula_program.h"

#include <algorithm>
#include <stdexcept>

namespace steplap {

namespace {

constexpr double k_largest_product = 16.0; // integer exponents up to this are evaluated as products

bool is_switch(FormulaOp op) {
  return op == FormulaOp::abs || op == FormulaOp::min || op == FormulaOp::max || op == FormulaOp::less || op == FormulaOp::less_or_equal;
}

// Returns true if all steps are linear, between switches, in the inputs that vary: the time, and with `operands_vary` the operands as well.
bool are_linear(const std::vector<FormulaProgram::Step>& steps, bool operands_vary) {
  std::vector<char> varies; // per step
  for (const FormulaProgram::Step& step : steps) {
    const auto in = [&](std::size_t k) { return step.of[k] >= 0 && varies[static_cast<std::size_t>(step.of[k])] != 0; };
    const bool is_any = in(0) || in(1) || in(2);
    bool is_linear = true, does_vary = is_any;
    switch (step.op) {
    case FormulaOp::time: does_vary = true; break;
    case FormulaOp::operand: does_vary = operands_vary; break;
    case FormulaOp::add:
    case FormulaOp::subtract:
    case FormulaOp::negate:
    case FormulaOp::abs:
    case FormulaOp::min:
    case FormulaOp::max:
    case FormulaOp::finite:
    case FormulaOp::choice: break;
    case FormulaOp::multiply: is_linear = !(in(0) && in(1)); break;
    case FormulaOp::divide: is_linear = !in(1); break;
    case FormulaOp::less:
    case FormulaOp::less_or_equal: does_vary = false; break; // constant between switches
    default: is_linear = !is_any; break;
    }
    if (!is_linear) return false;
    varies.push_back(does_vary ? 1 : 0);
  }
  return true;
}

// Refuses formulas that depend on time in other ways than by sums, comparisons, and products with terms without time. Step control cannot
// bound the rate of change of such formulas, so that a run could step over a narrow pulse. It can for linear functions of time and for
// signals.
void require_plain_time(const std::vector<FormulaProgram::Step>& steps) {
  if (!are_linear(steps, false))
    throw std::invalid_argument(
        "has the time in a function, a power, a divisor or a product with itself, and no step can know how fast that changes: make it a "
        "[[signal]] and name that, or a [[state]]");
}

} // namespace

FormulaProgram::FormulaProgram(const FormulaTree& tree) {
  std::vector<int> place;
  for (const FormulaNode& node : tree) add_node(node, place);
  if (place.back() != size() - 1) (void)add(FormulaOp::finite, place.back());
  require_plain_time(steps_);
  set_guards();
}

bool FormulaProgram::is_linear() const { return are_linear(steps_, true); }

bool FormulaProgram::may_peak() const {
  int switches = 0;
  for (const Step& step : steps_)
    switches += step.op == FormulaOp::min || step.op == FormulaOp::max || step.op == FormulaOp::less || step.op == FormulaOp::less_or_equal;
  if (switches > 0) return switch_count_ > 1 || !is_linear();
  std::vector<char> varies;
  for (const Step& step : steps_) {
    const auto in = [&](std::size_t k) { return step.of[k] >= 0 && varies[static_cast<std::size_t>(step.of[k])] != 0; };
    const bool is_input = step.op == FormulaOp::operand || step.op == FormulaOp::time;
    switch (step.op) {
    case FormulaOp::divide:
      if (in(1)) return true;
      break;
    case FormulaOp::power:
    case FormulaOp::exp:
    case FormulaOp::tan:
    case FormulaOp::ln:
    case FormulaOp::log10:
      if (in(0) || in(1)) return true;
      break;
    default: break;
    }
    varies.push_back(is_input || in(0) || in(1) || in(2) ? 1 : 0);
  }
  return false;
}

bool FormulaProgram::has_comparisons() const {
  return std::any_of(comparisons_.begin(), comparisons_.end(), [](char is_one) { return is_one != 0; });
}

int FormulaProgram::add(FormulaOp op, int a, int b, int c) {
  Step& step = steps_.emplace_back();
  step.op = op;
  step.of = {a, b, c};
  if (is_switch(op)) {
    if (switch_count_ == k_most_switches)
      throw std::invalid_argument("has more than 32 places where abs, min, max and comparisons switch: split it into several elements");
    step.index = switch_count_++;
    comparisons_.push_back(op == FormulaOp::less || op == FormulaOp::less_or_equal ? 1 : 0);
  }
  uses_time_ = uses_time_ || op == FormulaOp::time;
  return size() - 1;
}

int FormulaProgram::add_number(double number) {
  const int made = add(FormulaOp::number);
  steps_.back().number = number;
  return made;
}

// Returns true if the value of the node is always 0 or 1, because it consists of comparisons only.
bool FormulaProgram::is_boolean(int node) const {
  const Step& step = steps_[static_cast<std::size_t>(node)];
  switch (step.op) {
  case FormulaOp::number:
  case FormulaOp::less:
  case FormulaOp::less_or_equal:
  case FormulaOp::both:
  case FormulaOp::either:
  case FormulaOp::negation: return true;
  case FormulaOp::choice: return is_boolean(step.of[1]) && is_boolean(step.of[2]);
  default: return false;
  }
}

void FormulaProgram::require_condition(int node) const {
  if (!is_boolean(node))
    throw std::invalid_argument(
        "has a condition that compares nothing: an event is where a comparison changes, so write x > 0 instead of x");
}

// Adds base^exponent. Integer exponents up to k_largest_product are expanded into products, which all number types have.
int FormulaProgram::add_power(int base, int exponent) {
  const Step& known = steps_[static_cast<std::size_t>(exponent)];
  const bool is_number = known.op == FormulaOp::number ||
                         (known.op == FormulaOp::negate && steps_[static_cast<std::size_t>(known.of[0])].op == FormulaOp::number);
  if (!is_number) return add(FormulaOp::power, base, exponent);
  const double value = known.op == FormulaOp::number ? known.number : -steps_[static_cast<std::size_t>(known.of[0])].number;
  const double size_of = std::abs(value);
  if (value == 0.5) return add(FormulaOp::sqrt, base);
  if (size_of != std::floor(size_of) || size_of > k_largest_product) return add(FormulaOp::power, base, exponent);
  int result = -1, square = base;
  for (auto left = static_cast<unsigned>(size_of); left != 0; left /= 2) {
    if (left % 2 == 1) result = result < 0 ? square : add(FormulaOp::multiply, result, square);
    if (left > 1) square = add(FormulaOp::multiply, square, square);
  }
  if (result < 0) return add_number(1.0);
  return value < 0.0 ? add(FormulaOp::divide, add_number(1.0), result) : result;
}

void FormulaProgram::add_node(const FormulaNode& node, std::vector<int>& place) {
  const auto of = [&](std::size_t k) { return node.of[k] < 0 ? -1 : place[static_cast<std::size_t>(node.of[k])]; };
  switch (node.op) {
  case FormulaOp::number: place.push_back(add_number(node.number)); return;
  case FormulaOp::operand:
    place.push_back(add(FormulaOp::operand));
    steps_.back().index = node.operand;
    operand_count_ = std::max(operand_count_, node.operand + 1);
    return;
  case FormulaOp::power: place.push_back(add_power(of(0), of(1))); return;
  case FormulaOp::equal: throw std::invalid_argument("compares with == or !=, which is true for no length of time: use <, <=, > or >=");
  case FormulaOp::choice:
  case FormulaOp::negation: require_condition(of(0)); break;
  case FormulaOp::both:
  case FormulaOp::either:
    require_condition(of(0));
    require_condition(of(1));
    break;
  default: break;
  }
  place.push_back(add(node.op, of(0), of(1), of(2)));
}

// Returns the first of `guard` and its enclosing guards such that its condition, and those of all guards around it, are evaluated before
// `step`; −1 if there is none.
int FormulaProgram::innermost_guard_before(int guard, int step) const {
  int known = std::max(guard, -1);
  for (int g = known; g >= 0; g = guards_[static_cast<std::size_t>(g)].outer)
    if (guards_[static_cast<std::size_t>(g)].condition >= step) known = guards_[static_cast<std::size_t>(g)].outer;
  return known;
}

// Finds the steps that are used in one branch of a choice only, from the last step backwards. Such a step is evaluated only if that branch
// is selected.
void FormulaProgram::set_guards() {
  constexpr int k_unused = -2;
  std::vector<int> guard(steps_.size(), k_unused);
  guard.back() = -1;
  const auto use = [&](int step, int with) {
    int& known = guard[static_cast<std::size_t>(step)];
    known = known == k_unused || known == with ? with : -1;
  };
  for (int i = size() - 1; i >= 0; --i) {
    const Step& step = steps_[static_cast<std::size_t>(i)];
    const int own = innermost_guard_before(guard[static_cast<std::size_t>(i)], i);
    steps_[static_cast<std::size_t>(i)].guard = own;
    if (step.op != FormulaOp::choice) {
      for (const int used : step.of)
        if (used >= 0) use(used, own);
      continue;
    }
    use(step.of[0], own);
    for (const int side : {1, 2}) {
      guards_.push_back({step.of[0], side == 1, own});
      use(step.of[static_cast<std::size_t>(side)], static_cast<int>(guards_.size()) - 1);
    }
  }
}

SwitchBits FormulaProgram::counting(SwitchBits bits) const {
  std::vector<double> truth(steps_.size(), 0.0);
  SwitchBits counting = 0;
  for (int i = 0; i < size(); ++i) {
    const Step& step = steps_[static_cast<std::size_t>(i)];
    const auto is_true = [&](std::size_t k) { return truth[static_cast<std::size_t>(step.of[k])] != 0.0; };
    if (step.guard >= 0 && !holds(step.guard, truth.data())) continue;
    double& value = truth[static_cast<std::size_t>(i)];
    if (is_switch(step.op)) {
      counting |= SwitchBits{1} << static_cast<unsigned>(step.index);
      value = (bits >> static_cast<unsigned>(step.index)) & 1U;
    } else if (step.op == FormulaOp::number) {
      value = step.number;
    } else if (step.op == FormulaOp::both) {
      value = is_true(0) && is_true(1);
    } else if (step.op == FormulaOp::either) {
      value = is_true(0) || is_true(1);
    } else if (step.op == FormulaOp::negation) {
      value = !is_true(0);
    } else if (step.op == FormulaOp::choice) {
      value = truth[static_cast<std::size_t>(step.of[is_true(0) ? 1 : 2])];
    }
  }
  return counting;
}

} // namespace steplap
