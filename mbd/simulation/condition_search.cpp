#include "mbd/simulation/condition_search.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_shortest = 1e-9; // relative to the step: intervals that are not bisected further
// Relative to the step: near its ends the condition may just be changing, and the event finder locates the change.
constexpr double k_beside_end = 1e-6;
constexpr std::size_t k_most_spans = 4000; // intervals examined in one step
constexpr double k_half = 0.5;             // a condition is a number, 0 false, 1 true; this is the limit
constexpr double k_rounded_time = 4.0 * 0x1p-52;

double value_of(const MotionOperand& operand, const Snapshot& s) {
  switch (operand.kind) {
  case MotionOperand::Kind::coordinate: return motion_formula::coordinate_of(s.motion[operand.body], operand.coordinate);
  case MotionOperand::Kind::measure: {
    const MeasureValue<double> m = evaluate_row<false>(operand.row, s.motion[operand.row.a], s.motion[operand.row.b]);
    return operand.is_rate ? m.rate : m.value - operand.zero;
  }
  case MotionOperand::Kind::state: return operand.unit * s.evaluation->inner[operand.inner];
  case MotionOperand::Kind::signal: return operand.signal->value(s.t);
  case MotionOperand::Kind::own_value:
  case MotionOperand::Kind::own_rate: break; // conditions do not have a coordinate of their own
  }
  return 0.0;
}

std::vector<FormulaChannel::Leaf> leaves_of(const MotionFormula& formula) {
  std::vector<FormulaChannel::Leaf> leaves;
  for (const MotionOperand& operand : formula.operands())
    leaves.push_back({"", [&operand](const Snapshot& s) { return value_of(operand, s); }, 1.0});
  return leaves;
}

} // namespace

ConditionSearch::ConditionSearch(const System& system, const ActionGroup* group)
    : y_(static_cast<std::size_t>(system.largest_dimension())), dy_(y_.size()) {
  if (!group) return;
  std::size_t most_operands = 0, most_nodes = 0;
  for (std::size_t i = 0; i < group->entries.size(); ++i) {
    const std::optional<MotionFormula>& formula = group->entries[i].trigger.formula;
    if (!formula || group->entries[i].unit < 0 || formula->program().is_linear()) continue;
    const std::size_t count = formula->operands().size();
    sought_.push_back({i, &formula->tree(), OperandCurves(leaves_of(*formula)), std::vector<double>(count), std::vector<double>(count),
                       std::vector<double>(count)});
    most_operands = std::max(most_operands, count);
    most_nodes = std::max(most_nodes, formula->tree().size());
  }
  operands_.resize(most_operands);
  leaf_.resize(most_operands);
  leaf_at_.resize(most_operands);
  values_.resize(most_nodes);
  node_.resize(most_nodes);
  node_at_.resize(most_nodes);
}

double ConditionSearch::place_of_truth(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& is_armed) {
  double place = 1.0;
  for (Sought& sought : sought_)
    if (is_armed[sought.action] != 0) place = std::min(place, place_of_truth(sought, integrator, dynamics));
  return place;
}

double ConditionSearch::place_of_truth(Sought& sought, Integrator& integrator, Dynamics& dynamics) {
  const double t0 = integrator.t0(), h = integrator.h();
  const auto look = [&](double theta) {
    integrator.dense(dynamics, theta, y_.data());
    dynamics.rates(t0 + theta * h, y_.data(), dy_.data());
    Snapshot snapshot;
    snapshot.t = t0 + theta * h;
    snapshot.motion = dynamics.motion().data();
    snapshot.evaluation = &dynamics.evaluation();
    return snapshot;
  };
  const auto read = [&](double theta, std::vector<double>& operands) { sought.curves.read(look(theta), operands.data()); };
  if (sought.is_known && sought.t_last == t0) std::swap(sought.first, sought.last);
  else read(0.0, sought.first);
  read(0.5, sought.middle);
  read(1.0, sought.last);
  sought.t_last = integrator.t1();
  sought.is_known = true;
  if (is_true(sought, sought.first.data(), t0)) return 1.0; // already true; the event finder locates the change to false
  if (!may_be_true_by_range(sought, t0, integrator.t1())) return 1.0;
  sought.curves.begin(sought.first.data(), sought.last.data(), look);
  const bool ends_true = is_true(sought, sought.last.data(), integrator.t1());
  spans_.assign(1, {});
  for (std::size_t count = 0; !spans_.empty(); ++count) {
    const Span span = spans_.back();
    spans_.pop_back();
    const Interval range = enclose(sought, span, t0, h).range;
    if (range.is_empty() || range.high < k_half) continue;
    const double middle = 0.5 * (span.begin + span.end);
    if (may_be_true_at(sought, middle, t0 + middle * h)) {
      sought.curves.read(look(middle), operands_.data());
      if (is_true(sought, operands_.data(), t0 + middle * h)) // true up to the end; the event finder locates the change
        return ends_true && enclose(sought, {middle, 1.0}, t0, h).range.low > k_half ? 1.0 : middle;
    }
    if (span.end - span.begin > k_shortest && count < k_most_spans) {
      spans_.push_back({middle, span.end});
      spans_.push_back({span.begin, middle});
    } else if (span.begin > k_beside_end && span.end < 1.0 - k_beside_end && !undecided_) {
      undecided_ = t0 + middle * h;
    }
  }
  return 1.0;
}

// Encloses each operand by the range of its three samples, widened by the same amount on either side, as for curves that are not smooth.
bool ConditionSearch::may_be_true_by_range(const Sought& sought, double t0, double t1) {
  for (std::size_t i = 0; i < sought.first.size(); ++i) {
    const auto [low, high] = std::minmax({sought.first[i], sought.middle[i], sought.last[i]});
    const double width = high - low;
    leaf_at_[i] = Enclosure<0>::of_range({low - width, high + width}, std::isnan(width));
  }
  const Interval range =
      evaluate<EnclosingNumbers<0>>(*sought.tree, leaf_at_.data(), Enclosure<0>::of_range({t0, t1}), node_at_.data()).range;
  return !range.is_empty() && !(range.high < k_half);
}

const Enclosure<ConditionSearch::k_degree>& ConditionSearch::enclose(const Sought& sought, const Span& span, double t0, double h) {
  for (std::size_t i = 0; i < sought.curves.count(); ++i) leaf_[i] = sought.curves.over(0, i, span.begin, span.end);
  const double begin = t0 + span.begin * h, end = t0 + span.end * h;
  std::array<double, k_degree + 1> c{};
  c[0] = 0.5 * (begin + end);
  c[1] = 0.5 * (end - begin);
  return evaluate<EnclosingNumbers<k_degree>>(*sought.tree, leaf_.data(),
                                              Enclosure<k_degree>::of_polynomial(c, k_rounded_time * std::abs(end)), node_.data());
}

bool ConditionSearch::may_be_true_at(const Sought& sought, double theta, double t) {
  for (std::size_t i = 0; i < sought.curves.count(); ++i) leaf_at_[i] = sought.curves.at(0, i, theta);
  const Interval range = evaluate<EnclosingNumbers<0>>(*sought.tree, leaf_at_.data(),
                                                       Enclosure<0>::of_polynomial({t}, k_rounded_time * std::abs(t)), node_at_.data())
                             .range;
  return !range.is_empty() && !(range.high < k_half);
}

bool ConditionSearch::is_true(const Sought& sought, const double* operands, double t) {
  return steplap::value_of(*sought.tree, operands, t, values_.data()) == 1.0;
}

} // namespace steplap
