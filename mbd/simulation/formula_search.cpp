#include "mbd/simulation/formula_search.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_shortest = 1e-9; // spans shorter than this fraction of the step are not halved
// Within this fraction of the step from its ends undecided spans are ignored: conditions change there at the event that ends the step.
constexpr double k_beside_end = 1e-6;
constexpr std::size_t k_most_spans = 4000, k_most_spans_of_force = 200; // largest number of spans per step, for conditions and for forces
constexpr double k_half = 0.5;                                          // threshold between false, 0, and true, 1
constexpr double k_rounded_time = 4.0 * 0x1p-52;
// Width of the band on either side, relative to the range of the formula at start, middle and end of a step; a smooth formula exceeds this
// range by less.
constexpr double k_beyond = 3.0;
// In the first step after an event the event finder locates changes only beyond this fraction of it. A step with an earlier change is cut
// at k_behind_change times the position of the change.
constexpr double k_found_by_events = 1e-2, k_behind_change = 2.0;
constexpr double k_smooth = 0.5;      // largest deviation of the middle from a cubic, relative to its distance from the range of the ends
constexpr double k_least_peak = 1e-3; // peaks below this fraction of the range of the formula are ignored
// A formula that differs from a polynomial of degree 4 by less than this fraction of its range has no peak between the samples of a step.
constexpr double k_resolved = 1e-2;
// Assumed error of the polynomial of degree 4 through five samples of an operand, relative to its coefficients of degree 3 and 4. Over a step
// in which an angle turns by 1 rad, its sine has an error of 1/80 of them.
constexpr double k_off_quartic = 0.05;
constexpr double k_beyond_values = 1e-9; // additional width of the band for rounding, relative to the values

double value_of(const MotionOperand& operand, const FormulaInMotion& in_motion, const Snapshot& s) {
  switch (operand.kind) {
  case MotionOperand::Kind::coordinate: return motion_formula::coordinate_of(s.motion[operand.body], operand.coordinate);
  case MotionOperand::Kind::measure: {
    const MeasureValue<double> m = evaluate_row<false>(operand.row, s.motion[operand.row.a], s.motion[operand.row.b]);
    return operand.is_rate ? m.rate : m.value - operand.zero;
  }
  case MotionOperand::Kind::state: return operand.unit * s.evaluation->inner[operand.inner];
  case MotionOperand::Kind::signal: return operand.signal->value(s.t);
  case MotionOperand::Kind::own_value: return in_motion.own(*s.evaluation).value;
  case MotionOperand::Kind::own_rate: return in_motion.own(*s.evaluation).rate;
  }
  return 0.0;
}

std::vector<FormulaChannel::Leaf> leaves_of(const FormulaInMotion& in_motion) {
  std::vector<FormulaChannel::Leaf> leaves;
  for (const MotionOperand& operand : in_motion.formula->operands())
    leaves.push_back({"", [&operand, in_motion](const Snapshot& s) { return value_of(operand, in_motion, s); }, 1.0});
  return leaves;
}

} // namespace

FormulaPeakSearch::FormulaPeakSearch(const System& system, const ActionGroup* group)
    : y_(static_cast<std::size_t>(system.largest_dimension())), dy_(y_.size()) {
  std::vector<FormulaInMotion> formulas;
  for (const auto& force : system.groups) force->register_formulas(formulas);
  for (const FormulaInMotion& each : formulas)
    if (each.formula->program().may_peak()) add(k_no_action, each);
  has_forces_ = !sought_.empty();
  for (std::size_t i = 0; group && i < group->entries.size(); ++i) {
    const std::optional<MotionFormula>& formula = group->entries[i].trigger.formula;
    if (formula && group->entries[i].unit >= 0 && formula->program().may_peak()) add(static_cast<int>(i), {&*formula});
  }
}

void FormulaPeakSearch::add(int action, const FormulaInMotion& in_motion) {
  const FormulaTree& tree = in_motion.formula->tree();
  const FormulaProgram& program = in_motion.formula->program();
  const std::size_t count = in_motion.formula->operands().size(), nodes = std::max(values_.size(), tree.size());
  MonitoredFormula& sought =
      sought_.emplace_back(MonitoredFormula{action, &tree, OperandCurves(leaves_of(in_motion)), {}, {}, &program, in_motion.unit});
  // Switches of a formula are numbered in the order of its nodes.
  for (std::size_t i = 0; action == k_no_action && program.has_comparisons() && i < tree.size(); ++i) {
    const FormulaOp op = tree[i].op;
    const bool is_comparison = op == FormulaOp::less || op == FormulaOp::less_or_equal;
    if (is_comparison || op == FormulaOp::abs || op == FormulaOp::min || op == FormulaOp::max)
      sought.comparisons.push_back(is_comparison ? static_cast<int>(i) : -1);
  }
  for (std::vector<double>& operands : sought.operands) operands.resize(count);
  operands_.resize(std::max(operands_.size(), count));
  leaf_.resize(operands_.size());
  leaf_quartic_.resize(operands_.size());
  leaf_at_.resize(operands_.size());
  values_.resize(nodes);
  node_.resize(nodes);
  node_quartic_.resize(nodes);
  node_at_.resize(nodes);
}

Snapshot FormulaPeakSearch::evaluate_dense(double theta, Integrator& integrator, Dynamics& dynamics) {
  Snapshot snapshot;
  snapshot.t = integrator.t0() + theta * integrator.h();
  integrator.dense(dynamics, theta, y_.data());
  dynamics.rates(snapshot.t, y_.data(), dy_.data());
  snapshot.motion = dynamics.motion().data();
  snapshot.evaluation = &dynamics.evaluation();
  return snapshot;
}

double FormulaPeakSearch::place_of_peak(Integrator& integrator, Dynamics& dynamics, const std::vector<char>* is_armed) {
  const auto is_asked = [&](const MonitoredFormula& sought) {
    return !sought.is_condition() || (is_armed && (*is_armed)[static_cast<std::size_t>(sought.action)] != 0);
  };
  if (!has_forces_ && std::none_of(sought_.begin(), sought_.end(), is_asked)) {
    is_known_ = false;
    return 1.0;
  }
  const auto read = [&](double theta, std::size_t place) {
    const Snapshot snapshot = evaluate_dense(theta, integrator, dynamics);
    for (MonitoredFormula& sought : sought_) sought.curves.read(snapshot, sought.operands[place].data());
  };
  if (is_known_ && t_last_ == integrator.t0()) {
    for (MonitoredFormula& sought : sought_) std::swap(sought.operands[0], sought.operands[k_last]);
  } else {
    read(0.0, 0);
  }
  const std::size_t stride = has_forces_ ? 1 : k_middle; // conditions need no quarters
  for (std::size_t i = stride; i < k_samples; i += stride) read(0.25 * static_cast<double>(i), i);
  t_last_ = integrator.t1();
  is_known_ = true;
  if (is_behind_event_) t_event_ = integrator.t0();
  is_behind_event_ = false;
  const bool is_first = integrator.t0() == t_event_;
  double place = 1.0;
  for (MonitoredFormula& sought : sought_) {
    if (!is_asked(sought)) continue;
    place = std::min(place, place_of_peak(sought, integrator, dynamics));
    if (!is_first || sought.comparisons.empty() || sought.unit < 0) continue;
    const double change = first_change(sought, integrator, dynamics);
    if (change < k_found_by_events) place = std::min(place, k_behind_change * change);
  }
  return place;
}

// Test that needs no further samples: returns true if the formula follows a polynomial of degree 4, or differs from it by a peak that is
// ignored. The operands follow the polynomials through their samples.
bool FormulaPeakSearch::is_resolved(MonitoredFormula& sought, double t0, double h) {
  Interval seen = interval::k_none;
  for (std::size_t i = 0; i < k_samples; ++i) {
    const double f = value(sought, sought.operands[i].data(), t0 + 0.25 * static_cast<double>(i) * h);
    if (!std::isfinite(f)) return false;
    seen = interval::hull(seen, {f, f});
  }
  for (std::size_t i = 0; i < sought.curves.count(); ++i) {
    const auto x = [&](std::size_t sample) { return sought.operands[sample][i]; };
    const double middle = x(2), even = 0.5 * (x(0) + x(4)) - middle, odd = 0.5 * (x(4) - x(0));
    const double c4 = (even - 2.0 * (x(1) + x(3) - 2.0 * middle)) / 0.75, c3 = (odd - (x(3) - x(1))) / 0.75;
    const double rest = k_off_quartic * (std::abs(c3) + std::abs(c4)) + k_rounded_time * (std::abs(middle) + std::abs(odd));
    if (!std::isfinite(rest)) return false;
    leaf_quartic_[i] = Enclosure<k_quartic>::of_polynomial({middle, odd - c3, even - c4, c3, c4}, rest);
  }
  const auto t = Enclosure<k_quartic>::of_polynomial({t0 + 0.5 * h, 0.5 * h}, k_rounded_time * std::abs(t0 + h));
  const double rest = evaluate<EnclosingNumbers<k_quartic>>(*sought.tree, leaf_quartic_.data(), t, node_quartic_.data()).rest;
  const double range = seen.high - seen.low;
  sought.scale = std::max(sought.scale, range);
  return rest <=
         std::max(k_resolved * range, k_least_peak * sought.scale) + k_beyond_values * std::max(std::abs(seen.low), std::abs(seen.high));
}

// Returns true if a comparison, min, max or abs may have more than one outcome. Precondition: node_ contains enclosures over the step.
bool FormulaPeakSearch::may_switch(const MonitoredFormula& sought) const {
  const auto may_meet = [](const Interval& a, const Interval& b) { return !(a.low > b.high || a.high < b.low); };
  for (std::size_t i = 0; i < sought.tree->size(); ++i) {
    const FormulaNode& node = (*sought.tree)[i];
    const auto of = [&](std::size_t k) { return node_[static_cast<std::size_t>(node.of[k])].range; };
    switch (node.op) {
    case FormulaOp::less:
    case FormulaOp::less_or_equal:
    case FormulaOp::equal:
      if (node_[i].range.low != node_[i].range.high) return true;
      break;
    case FormulaOp::min:
    case FormulaOp::max:
      if (may_meet(of(0), of(1))) return true;
      break;
    case FormulaOp::abs:
      if (may_meet(of(0), {0.0, 0.0})) return true;
      break;
    default: break;
    }
  }
  return false;
}

// Fits the polynomial through the values at the nodes. Returns false if an operand is not smooth or a value not finite.
bool FormulaPeakSearch::fit_polynomial(MonitoredFormula& sought, double t0, double h) {
  for (std::size_t i = 0; i < sought.curves.count(); ++i)
    if (!sought.curves.curve(0, i).is_smooth) return false;
  OperandCurves::Coefficients values;
  for (int k = 0; k < OperandCurves::k_nodes; ++k) {
    const double theta = 0.5 + 0.5 * OperandCurves::node(k);
    for (std::size_t i = 0; i < sought.curves.count(); ++i) operands_[i] = sought.curves.at(0, i, theta).c[0];
    values[k] = value(sought, operands_.data(), t0 + theta * h);
    if (!std::isfinite(values[k])) return false;
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  sought.scale = std::max(sought.scale, *high - *low);
  sought.polynomial = OperandCurves::polynomial_through(values);
  return true;
}

// Sets the band of a force or rate. Returns false if it cannot be searched. Precondition: the curves of its operands are known.
bool FormulaPeakSearch::set_limits(MonitoredFormula& sought, double t0, double h) {
  sought.is_about_polynomial = false;
  const Interval all = range_over(sought, {}, t0, h);
  if (all.is_empty() || !std::isfinite(all.high - all.low)) return false;
  if (!may_switch(sought) && fit_polynomial(sought, t0, h)) {
    sought.is_about_polynomial = true;
    sought.high =
        k_least_peak * std::max(sought.scale, all.high - all.low) + k_beyond_values * std::max(std::abs(all.low), std::abs(all.high));
    sought.low = -sought.high;
    return true;
  }
  if (!set_band(sought, t0, h)) return false;
  sought.low -= k_least_peak * (all.high - all.low);
  sought.high += k_least_peak * (all.high - all.low);
  return true;
}

// Sets the band in which a force or rate may vary without a search for peaks: the range of its values at the ends and in the middle of the
// step, extended by three times this range on either side. A middle value far outside the range of the ends belongs to the band only if it
// agrees with the cubic through the ends and the quarter points; otherwise it may be a peak and is excluded. Returns false if a value is
// not finite.
bool FormulaPeakSearch::set_band(MonitoredFormula& sought, double t0, double h) {
  double f[k_samples];
  for (std::size_t i = 0; i < k_samples; ++i) {
    f[i] = value(sought, sought.operands[i].data(), t0 + 0.25 * static_cast<double>(i) * h);
    if (!std::isfinite(f[i])) return false;
  }
  double low = std::min(f[0], f[k_last]), high = std::max(f[0], f[k_last]);
  const double middle = f[k_middle], beyond_ends = std::max({low - middle, middle - high, 0.0});
  if (beyond_ends <= k_beyond * (high - low)) {
    low = std::min(low, middle);
    high = std::max(high, middle);
  } else if (std::abs(middle - (4.0 * (f[1] + f[3]) - f[0] - f[k_last]) / 6.0) <= k_smooth * beyond_ends) {
    low = *std::min_element(f, f + k_samples);
    high = *std::max_element(f, f + k_samples);
  }
  const double beyond = k_beyond * (high - low) + k_beyond_values * std::max(std::abs(low), std::abs(high));
  sought.low = low - beyond;
  sought.high = high + beyond;
  return true;
}

double FormulaPeakSearch::place_of_peak(MonitoredFormula& sought, Integrator& integrator, Dynamics& dynamics) {
  const double t0 = integrator.t0(), h = integrator.h(), t1 = integrator.t1();
  if (sought.is_condition()) {
    sought.high = k_half;
    // Already true at the start: the event finder locates its end.
    if (sought.is_outside(value(sought, sought.operands[0].data(), t0))) return 1.0;
    if (!may_be_outside_by_range(sought, t0, t1)) return 1.0;
  } else if (is_resolved(sought, t0, h)) {
    return 1.0;
  }
  sought.curves.begin(sought.operands[0].data(), sought.operands[k_last].data(),
                      [&](double theta) { return evaluate_dense(theta, integrator, dynamics); });
  if (!sought.is_condition() && !set_limits(sought, t0, h)) return 1.0;
  const std::size_t most_spans = sought.is_condition() ? k_most_spans : k_most_spans_of_force;
  const bool ends_outside = sought.is_outside(value_in_band(sought, sought.operands[k_last].data(), t1, 1.0));
  spans_.assign(1, {});
  for (std::size_t count = 0; !spans_.empty(); ++count) {
    const Span span = spans_.back();
    spans_.pop_back();
    if (!sought.may_be_outside(range_over(sought, span, t0, h))) continue;
    const double middle = 0.5 * (span.begin + span.end);
    if (may_be_outside_at(sought, middle, t0 + middle * h)) {
      sought.curves.read(evaluate_dense(middle, integrator, dynamics), operands_.data());
      // If the value stays outside until the end of the interval, the event finder locates the change.
      if (sought.is_outside(value_in_band(sought, operands_.data(), t0 + middle * h, middle)))
        return ends_outside && range_over(sought, {middle, 1.0}, t0, h).low > k_half ? 1.0 : middle;
    }
    if (span.end - span.begin > k_shortest && count < most_spans) {
      spans_.push_back({middle, span.end});
      spans_.push_back({span.begin, middle});
    } else if (sought.is_condition() && span.begin > k_beside_end && span.end < 1.0 - k_beside_end && !undecided_) {
      undecided_ = t0 + middle * h;
    }
  }
  return 1.0;
}

// Returns true if a comparison that is relevant with these bits may have another outcome than its bit.
template <class Value> bool FormulaPeakSearch::may_change(const MonitoredFormula& sought, SwitchBits bits, const Value& value_at) {
  const SwitchBits counting = sought.program->counting(bits);
  for (std::size_t s = 0; s < sought.comparisons.size(); ++s) {
    const SwitchBits mask = SwitchBits{1} << s;
    if (sought.comparisons[s] < 0 || (counting & mask) == 0) continue;
    const double wanted = (bits & mask) != 0 ? 1.0 : 0.0;
    const Interval value = value_at(static_cast<std::size_t>(sought.comparisons[s]));
    if (!(value.low == wanted && value.high == wanted)) return true;
  }
  return false;
}

// Returns the position, as fraction of the step with a relative accuracy of a tenth, where a comparison first differs from the mode; 1 if
// there is none.
double FormulaPeakSearch::first_change(MonitoredFormula& sought, Integrator& integrator, Dynamics& dynamics) {
  const double t0 = integrator.t0(), h = integrator.h();
  const SwitchBits bits = dynamics.evaluation().mode[sought.unit];
  sought.curves.begin(sought.operands[0].data(), sought.operands[k_last].data(),
                      [&](double theta) { return evaluate_dense(theta, integrator, dynamics); });
  double first = 1.0;
  spans_.assign(1, {});
  for (std::size_t count = 0; !spans_.empty() && count < k_most_spans_of_force; ++count) {
    const Span span = spans_.back();
    spans_.pop_back();
    (void)enclosure_over(sought, span, t0, h);
    if (!may_change(sought, bits, [&](std::size_t node) { return node_[node].range; })) continue;
    const double middle = 0.5 * (span.begin + span.end);
    sought.curves.read(evaluate_dense(middle, integrator, dynamics), operands_.data());
    (void)value(sought, operands_.data(), t0 + middle * h);
    if (may_change(sought, bits, [&](std::size_t node) { return Interval{values_[node], values_[node]}; })) {
      first = middle;
      spans_.clear();
    } else if (span.end - span.begin > k_shortest) {
      spans_.push_back({middle, span.end});
    }
    const double enough = first < 1.0 ? 0.1 * first : k_shortest;
    if (middle - span.begin > enough) spans_.push_back({span.begin, middle});
  }
  return first;
}

// Test for curves that are not smooth: returns true if the formula may leave its band while each operand stays within the range of its
// three samples, extended by its width on either side.
bool FormulaPeakSearch::may_be_outside_by_range(const MonitoredFormula& sought, double t0, double t1) {
  for (std::size_t i = 0; i < sought.curves.count(); ++i) {
    const auto [low, high] = std::minmax({sought.operands[0][i], sought.operands[k_middle][i], sought.operands[k_last][i]});
    const double width = high - low;
    leaf_at_[i] = Enclosure<0>::of_range({low - width, high + width}, std::isnan(width));
  }
  return sought.may_be_outside(
      evaluate<EnclosingNumbers<0>>(*sought.tree, leaf_at_.data(), Enclosure<0>::of_range({t0, t1}), node_at_.data()).range);
}

Enclosure<FormulaPeakSearch::k_degree> FormulaPeakSearch::enclosure_over(const MonitoredFormula& sought, const Span& span, double t0,
                                                                         double h) {
  for (std::size_t i = 0; i < sought.curves.count(); ++i) leaf_[i] = sought.curves.over(0, i, span.begin, span.end);
  const double begin = t0 + span.begin * h, end = t0 + span.end * h;
  std::array<double, k_degree + 1> c{};
  c[0] = 0.5 * (begin + end);
  c[1] = 0.5 * (end - begin);
  return evaluate<EnclosingNumbers<k_degree>>(*sought.tree, leaf_.data(),
                                              Enclosure<k_degree>::of_polynomial(c, k_rounded_time * std::abs(end)), node_.data());
}

// Returns the range of what the band bounds: the formula, or its difference to the polynomial.
Interval FormulaPeakSearch::range_over(const MonitoredFormula& sought, const Span& span, double t0, double h) {
  const Enclosure<k_degree> all = enclosure_over(sought, span, t0, h);
  if (!sought.is_about_polynomial || all.range.is_empty()) return all.range;
  const auto polynomial = OperandCurves::part_of(sought.polynomial, span.begin + span.end - 1.0, span.end - span.begin, 0.0);
  return EnclosingNumbers<k_degree>::subtract(all, polynomial).range;
}

double FormulaPeakSearch::value_in_band(const MonitoredFormula& sought, const double* operands, double t, double theta) {
  const double f = value(sought, operands, t);
  return sought.is_about_polynomial ? f - OperandCurves::part_of(sought.polynomial, 2.0 * theta - 1.0, 0.0, 0.0).c[0] : f;
}

bool FormulaPeakSearch::may_be_outside_at(const MonitoredFormula& sought, double theta, double t) {
  for (std::size_t i = 0; i < sought.curves.count(); ++i) leaf_at_[i] = sought.curves.at(0, i, theta);
  Interval range = evaluate<EnclosingNumbers<0>>(*sought.tree, leaf_at_.data(),
                                                 Enclosure<0>::of_polynomial({t}, k_rounded_time * std::abs(t)), node_at_.data())
                       .range;
  if (sought.is_about_polynomial && !range.is_empty())
    range = interval::subtract(range, OperandCurves::part_of(sought.polynomial, 2.0 * theta - 1.0, 0.0, 0.0).range);
  return sought.may_be_outside(range);
}

} // namespace steplap
