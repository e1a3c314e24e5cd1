#include "mbd/simulation/formula_extremes.h"

#include "mbd/simulation/extremes.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_surprise = 3.0, k_remembered = 0.5; // factors for recent curvatures, as in extremes.cpp
constexpr long k_most_spans = 20000;                   // largest number of intervals for one extreme in one stretch: 0.01 s of computing
constexpr long k_few_spans = 500;
constexpr long k_run_spans = 4000000; // number of intervals of a run after which only few are allowed for each extreme
constexpr int k_most_panels = 96;     // largest number of panels in one stretch
constexpr int k_few_panels = 8;
constexpr int k_run_panels = 20000;
constexpr int k_deepest_panel = 40;
// Largest number of bisections: a formula without value for less than 1e-7 of a stretch is not reported.
constexpr int k_deepest_missing = 24;
constexpr long k_missing_spans = 2000;
constexpr double k_shortest = 0x1p-51;    // shortest interval, relative to the stretch or to t; its ends are equal up to rounding
constexpr double k_same_crossing = 1e-10; // largest distance of two crossings that count as one, relative to the stretch

constexpr double k_golden = 0.3819660112501051;
constexpr int k_golden_steps = 60; // steps of golden-section search, enough to reach rounding

// An interval whose bound exceeds the value mainly by the error of the operands, more than this fraction of the gap, is not bisected
// further, because that does not reduce the gap.
constexpr double k_own = 0.5;

std::vector<FormulaChannel::Leaf> leaves_of(const System& system) {
  std::vector<FormulaChannel::Leaf> leaves;
  for (const Channel& channel : system.channels) {
    const FormulaChannel* const formula = formula_of(channel);
    if (!formula || !channel.has_extremes) continue;
    for (const FormulaChannel::Leaf& leaf : formula->leaves())
      if (std::none_of(leaves.begin(), leaves.end(), [&](const auto& other) { return other.name == leaf.name; })) leaves.push_back(leaf);
  }
  return leaves;
}

} // namespace

FormulaExtremes::FormulaExtremes(const System& system, const std::vector<std::size_t>& searched, const std::vector<int>& rate_of)
    : is_formula_(searched.size(), 0), curves_(leaves_of(system)), rate_(curves_.count()), rate_factor_(curves_.count(), 1.0),
      first_(curves_.count()), last_(first_), before_(first_), first_rate_(first_), last_rate_(first_), curvature_(first_), error_(first_) {
  const std::vector<FormulaChannel::Leaf> leaves = leaves_of(system);
  std::size_t nodes = 0;
  for (std::size_t i = 0; i < system.channels.size() && !leaves.empty(); ++i)
    for (std::size_t k = 0; k < leaves.size(); ++k)
      if (leaves[k].name == system.channels[i].name && rate_of[i] >= 0) {
        rate_[k] = system.channels[static_cast<std::size_t>(rate_of[i])].value;
        rate_factor_[k] = leaves[k].factor;
      }
  for (std::size_t c = 0; c < searched.size(); ++c) {
    const Channel& channel = system.channels[searched[c]];
    const FormulaChannel* const formula = formula_of(channel);
    if (!formula) continue;
    is_formula_[c] = 1;
    FormulaTarget& sought = formulas_.emplace_back(FormulaTarget{c, formula, {}, channel.unit.empty()});
    for (const FormulaChannel::Leaf& leaf : formula->leaves())
      sought.leaves.push_back(static_cast<std::size_t>(
          std::find_if(leaves.begin(), leaves.end(), [&](const auto& other) { return other.name == leaf.name; }) - leaves.begin()));
    nodes = std::max(nodes, formula->tree().size());
  }
  leaf_.resize(curves_.count());
  leaf_at_.resize(curves_.count());
  node_.resize(nodes);
  node_at_.resize(nodes);
}

// --- along the stretches --------------------------------------------------------------------------

void FormulaExtremes::read(const Snapshot& snapshot, std::vector<double>& values, std::vector<double>& rates) {
  curves_.read(snapshot, values.data());
  for (std::size_t i = 0; i < rate_.size(); ++i) rates[i] = rate_[i] ? rate_factor_[i] * rate_[i](snapshot) : 0.0;
}

void FormulaExtremes::begin(const Snapshot& snapshot) {
  if (is_empty()) return;
  read(snapshot, first_, first_rate_);
  h_last_ = 0.0;
}

void FormulaExtremes::arrive(const Snapshot& snapshot) {
  if (!is_empty()) read(snapshot, last_, last_rate_);
}

void FormulaExtremes::pass(double h) {
  if (is_empty()) return;
  std::swap(before_, first_);
  std::swap(first_, last_);
  std::swap(first_rate_, last_rate_);
  h_last_ = h;
}

double FormulaExtremes::unclosed(std::size_t channel, const ChannelRange& found) const {
  for (const FormulaTarget& sought : formulas_)
    if (sought.channel == channel) return std::max({0.0, sought.high_bound - found.high.value, found.low.value - sought.low_bound});
  return 0.0;
}

// Computes the second derivatives of all operands by divided differences over the last three ends.
void FormulaExtremes::bend(double h) {
  for (std::size_t i = 0; i < curvature_.size(); ++i) {
    const double slope = last_[i] - first_[i], last = (first_[i] - before_[i]) * (h / h_last_);
    const double now = std::abs(slope - last) / (1.0 + h_last_ / h) / (h * h);
    curvature_[i] = std::max(std::isfinite(now) ? now : std::numeric_limits<double>::infinity(),
                             std::isfinite(curvature_[i]) ? k_remembered * curvature_[i] : 0.0);
  }
}

// Computes a safe bound of the deviation of each operand from the straight line between its ends: the sum of contributions by curvature, by
// the rates at the ends, and half of its change.
void FormulaExtremes::reach(double h, std::vector<double>& error) const {
  for (std::size_t i = 0; i < error.size(); ++i)
    error[i] = 0.25 * k_surprise * curvature_[i] * h * h + 0.25 * h * (std::abs(first_rate_[i]) + std::abs(last_rate_[i])) +
               0.5 * std::abs(last_[i] - first_[i]);
}

void FormulaExtremes::search(double t, double h, ExtremeSite& site) {
  if (is_empty()) return;
  t_ = t;
  h_ = h;
  is_straight_ = has_evaluated_ = false;
  const bool is_known = h_last_ > 0.0;
  if (is_known) {
    bend(h);
    reach(h, error_);
    curves_.begin_straight(first_.data(), last_.data(), error_.data());
  }
  for (FormulaTarget& sought : formulas_)
    if (!is_known || has_evaluated_ || may_improve_extremes(sought, site)) search_extremes(sought, site);
}

void FormulaExtremes::search_linear_step(double t, double h, ExtremeSite& site) {
  if (is_empty()) return;
  t_ = t;
  h_ = h;
  is_straight_ = has_evaluated_ = true;
  std::fill(error_.begin(), error_.end(), 0.0);
  curves_.begin_straight(first_.data(), last_.data(), error_.data());
  for (FormulaTarget& sought : formulas_) search_extremes(sought, site);
}

// Returns true if the formula may exceed its extremes in this stretch.
bool FormulaExtremes::may_improve_extremes(const FormulaTarget& sought, ExtremeSite& site) {
  const ChannelRange& range = site.range(sought.channel);
  const Whole& all = enclose(sought, {0.0, 0.0, 0, 0, 0.0, 1.0});
  if (all.is_partial && !range.had_no_value) return true;
  if (all.range.is_empty()) return false;
  const double slack = site.tolerance(sought.channel);
  return !(all.range.high <= range.high.value + slack) || !(all.range.low >= range.low.value - slack);
}

void FormulaExtremes::search_extremes(FormulaTarget& sought, ExtremeSite& site) {
  if (!has_evaluated_) {
    curves_.begin(first_.data(), last_.data(), [&site](double theta) { return site.evaluate_dense(theta); });
    ++run_panels_;
    has_evaluated_ = true;
  }
  seek(sought, 1.0, site);
  seek(sought, -1.0, site);
  seek_missing(sought, site);
  if (sought.is_number) seek_first(sought, site);
}

// --- enclosures -----------------------------------------------------------------------------------

const FormulaExtremes::Whole& FormulaExtremes::enclose(const FormulaTarget& sought, const Span& span) {
  for (std::size_t i = 0; i < sought.leaves.size(); ++i) leaf_[i] = curves_.over(span.panel, sought.leaves[i], span.begin, span.end);
  const double begin = t_ + span.begin * h_, end = t_ + span.end * h_;
  std::array<double, OperandCurves::k_degree + 1> c{};
  c[0] = 0.5 * (begin + end);
  c[1] = 0.5 * (end - begin);
  ++run_spans_;
  return evaluate<EnclosingNumbers<OperandCurves::k_degree>>(sought.formula->tree(), leaf_.data(),
                                                             Whole::of_polynomial(c, 4.0 * 0x1p-52 * std::abs(end)), node_.data());
}

const Enclosure<0>& FormulaExtremes::enclose_at(const FormulaTarget& sought, int panel, double theta) {
  for (std::size_t i = 0; i < sought.leaves.size(); ++i) leaf_at_[i] = curves_.at(panel, sought.leaves[i], theta);
  const double t = t_ + theta * h_;
  return evaluate<EnclosingNumbers<0>>(sought.formula->tree(), leaf_at_.data(),
                                       Enclosure<0>::of_polynomial({t}, 4.0 * 0x1p-52 * std::abs(t)), node_at_.data());
}

// Returns the value of the formula on the motion itself. In time stepping the motion is the straight line between the ends of a step.
double FormulaExtremes::real_value(const FormulaTarget& sought, double theta, ExtremeSite& site) {
  double value = 0.0;
  if (is_straight_) {
    thread_local std::vector<double> leaves, values;
    leaves.resize(sought.leaves.size());
    values.resize(std::max(values.size(), sought.formula->tree().size()));
    for (std::size_t i = 0; i < leaves.size(); ++i) leaves[i] = (1.0 - theta) * first_[sought.leaves[i]] + theta * last_[sought.leaves[i]];
    value = value_of(sought.formula->tree(), leaves.data(), t_ + theta * h_, values.data());
  } else {
    value = sought.formula->value(site.evaluate_dense(theta));
  }
  site.note(sought.channel, value, theta);
  return value;
}

// --- branch and bound -----------------------------------------------------------------------------

long FormulaExtremes::spans_left() const { return run_spans_ < k_run_spans ? k_most_spans : k_few_spans; }

// Order of intervals in the heap. With equal bounds the more deeply divided one comes first, so that one of many equal peaks is found soon.
constexpr auto k_further_in = [](const auto& a, const auto& b) { return a.bound < b.bound || (a.bound == b.bound && a.depth < b.depth); };

void FormulaExtremes::push(const FormulaTarget& sought, double sign, Span span) {
  const Whole& value = enclose(sought, span);
  if (value.range.is_empty()) return;
  span.bound = std::min(span.bound, sign > 0.0 ? value.range.high : -value.range.low);
  span.likely = place_of_largest(value, sign);
  spans_.push_back(span);
  std::push_heap(spans_.begin(), spans_.end(), k_further_in);
}

FormulaExtremes::Span FormulaExtremes::pop() {
  std::pop_heap(spans_.begin(), spans_.end(), k_further_in);
  const Span span = spans_.back();
  spans_.pop_back();
  return span;
}

bool FormulaExtremes::is_shortest(const Span& span) const {
  return span.end - span.begin <= k_shortest * std::max(1.0, std::abs(t_ + h_) / h_);
}

// Adds both halves of an interval. If its panel has been halved meanwhile, adds its parts in each half of the panel.
void FormulaExtremes::push_parts(const FormulaTarget& sought, double sign, const Span& span) {
  const int half = curves_.panel(span.panel).half;
  const double middle = half >= 0 ? curves_.panel(half).end : 0.5 * (span.begin + span.end);
  const int depth = span.depth + 1, first = half >= 0 ? half : span.panel, second = half >= 0 ? half + 1 : span.panel;
  if (span.begin < middle) push(sought, sign, {span.bound, 0.0, first, depth, span.begin, std::min(span.end, middle)});
  if (span.end > middle) push(sought, sign, {span.bound, 0.0, second, depth, std::max(span.begin, middle), span.end});
}

// Returns the increase of the tolerance if the extreme rises from `record` to `promised`: 1e-6 of the change of the channel's range, or of
// its magnitude if it has no unit (extreme_scales.cpp).
double FormulaExtremes::gained(const FormulaTarget& sought, double promised, double record) {
  const double gain = promised - record;
  if (!std::isfinite(gain)) return 0.0;
  return ExtremeFinder::k_resolution * (sought.is_number ? std::min(gain, std::max(1.0, std::abs(record))) : gain);
}

// Halves the panel. Returns true if its bounds of the operands are improved by this.
bool FormulaExtremes::improve(const FormulaTarget& sought, int panel, ExtremeSite& site) {
  if (is_straight_ || curves_.panel(panel).depth >= k_deepest_panel) return false;
  if (curves_.panels() >= (run_panels_ < k_run_panels ? k_most_panels : k_few_panels)) return false;
  if (std::none_of(sought.leaves.begin(), sought.leaves.end(), [&](std::size_t leaf) { return curves_.can_improve(panel, leaf); }))
    return false;
  curves_.halve(panel, [&site](double theta) { return site.evaluate_dense(theta); });
  run_panels_ += 2;
  return true;
}

void FormulaExtremes::keep_bound(FormulaTarget& sought, double sign, double bound) {
  if (sign > 0.0) sought.high_bound = std::max(sought.high_bound, bound);
  else sought.low_bound = std::min(sought.low_bound, -bound);
}

void FormulaExtremes::seek(FormulaTarget& sought, double sign, ExtremeSite& site) {
  const ChannelRange& range = site.range(sought.channel);
  const double known = sign * (sign > 0.0 ? range.high.value : range.low.value);
  const double record = std::isnan(known) ? -std::numeric_limits<double>::infinity() : known;
  const double tolerance = std::max(site.tolerance(sought.channel), 0.0);
  double promised = record, at = -1.0, width = 0.0;
  const auto wanted = [&] { return promised + std::max(tolerance, gained(sought, promised, record)); };
  spans_.clear();
  push_parts(sought, sign, {std::numeric_limits<double>::infinity(), 0.0, 0, 0, 0.0, 1.0});
  const double unbounded = std::numeric_limits<double>::infinity();
  for (long left = spans_left(); !spans_.empty() && spans_.front().bound > wanted() && left > 0; --left) {
    const Span span = pop();
    // Formula without bound here; already recorded.
    if (span.bound == unbounded && (sign > 0.0 ? sought.high_bound : -sought.low_bound) == unbounded) continue;
    if (curves_.panel(span.panel).half >= 0) {
      push_parts(sought, sign, span);
      continue;
    }
    const double theta = std::clamp(0.5 * (span.begin + span.end) + 0.5 * span.likely * (span.end - span.begin), span.begin, span.end);
    const Enclosure<0>& there = enclose_at(sought, span.panel, theta);
    const bool has_value = !there.range.is_empty();
    const double low = sign > 0.0 ? there.range.low : -there.range.high, high = sign > 0.0 ? there.range.high : -there.range.low;
    if (has_value && !there.is_partial && low > promised) {
      promised = low;
      at = theta;
      width = span.end - span.begin;
    }
    const bool is_anything = has_value && low == -unbounded && high == unbounded;
    const bool is_fine = is_shortest(span) || is_anything || (has_value && high - low > k_own * (span.bound - low));
    if (!is_fine || improve(sought, span.panel, site)) push_parts(sought, sign, span);
    else keep_bound(sought, sign, span.bound);
  }
  if (!spans_.empty() && spans_.front().bound > wanted()) keep_bound(sought, sign, spans_.front().bound);
  if (at >= 0.0) check(sought, sign, top_about(sought, sign, at, width), promised, site);
}

// Returns the position of the maximum of the curves near theta, by golden sections. A maximum is flat, so its position would otherwise be
// much less accurate than its value.
double FormulaExtremes::top_about(const FormulaTarget& sought, double sign, double theta, double width) {
  const auto value = [&](double x) {
    const Interval range = enclose_at(sought, panel_at(x), x).range;
    return range.is_empty() ? -std::numeric_limits<double>::infinity() : sign * range.middle();
  };
  double a = std::max(0.0, theta - width), b = std::min(1.0, theta + width), best = theta, at_best = value(theta);
  for (int i = 0; i < k_golden_steps && b - a > k_shortest; ++i) {
    const double p = a + k_golden * (b - a), q = b - k_golden * (b - a), at_p = value(p), at_q = value(q);
    const bool is_left = at_p > at_q;
    if (const double higher = is_left ? at_p : at_q; higher > at_best) {
      at_best = higher;
      best = is_left ? p : q;
    }
    (is_left ? b : a) = is_left ? q : p;
  }
  return best;
}

int FormulaExtremes::panel_at(double theta) const {
  int panel = 0;
  while (curves_.panel(panel).half >= 0) {
    const int half = curves_.panel(panel).half;
    panel = theta <= curves_.panel(half).end ? half : half + 1;
  }
  return panel;
}

// Evaluates the formula on the motion itself at the maximum `theta`. If the value is lower than `promised`, the curves are inaccurate, and
// the difference is added to the bounds.
void FormulaExtremes::check(FormulaTarget& sought, double sign, double theta, double promised, ExtremeSite& site) {
  const double value = sign * real_value(sought, theta, site);
  if (value >= promised - std::max(site.tolerance(sought.channel), 0.0)) return;
  keep_bound(sought, sign, std::isfinite(value) ? 2.0 * promised - value : std::numeric_limits<double>::infinity());
}

// Searches for a time at which the formula has no value (NaN), if its enclosure contains such a time.
void FormulaExtremes::seek_missing(const FormulaTarget& sought, ExtremeSite& site) {
  spans_.clear();
  spans_.push_back({0.0, 0.0, 0, 0, 0.0, 1.0});
  for (long left = std::min(k_missing_spans, spans_left()); !spans_.empty() && left > 0 && !site.range(sought.channel).had_no_value;
       --left) {
    const Span span = spans_.back();
    spans_.pop_back();
    const double middle = 0.5 * (span.begin + span.end);
    if (const int half = curves_.panel(span.panel).half; half >= 0) {
      const double border = curves_.panel(half).end;
      if (span.end > border) spans_.push_back({0.0, 0.0, half + 1, span.depth, std::max(span.begin, border), span.end});
      if (span.begin < border) spans_.push_back({0.0, 0.0, half, span.depth, span.begin, std::min(span.end, border)});
      continue;
    }
    if (!enclose(sought, span).is_partial || span.depth > k_deepest_missing) continue;
    if (enclose_at(sought, span.panel, middle).range.is_empty()) (void)real_value(sought, middle, site);
    spans_.push_back({0.0, 0.0, span.panel, span.depth + 1, middle, span.end});
    spans_.push_back({0.0, 0.0, span.panel, span.depth + 1, span.begin, middle});
  }
}

// Finds the first time at which a channel without unit exceeds 1, by bisection of intervals from the left.
void FormulaExtremes::seek_first(const FormulaTarget& sought, ExtremeSite& site) {
  ChannelRange& range = site.range(sought.channel);
  if (range.first_above_one || !(range.high.value > 1.0)) return;
  spans_.clear();
  spans_.push_back({0.0, 0.0, 0, 0, 0.0, 1.0});
  for (long left = spans_left(); !spans_.empty() && left > 0; --left) {
    const Span span = spans_.back();
    spans_.pop_back();
    const double middle = 0.5 * (span.begin + span.end);
    if (const int half = curves_.panel(span.panel).half; half >= 0) {
      const double border = curves_.panel(half).end;
      if (span.end > border) spans_.push_back({0.0, 0.0, half + 1, span.depth, std::max(span.begin, border), span.end});
      if (span.begin < border) spans_.push_back({0.0, 0.0, half, span.depth, span.begin, std::min(span.end, border)});
      continue;
    }
    const Interval values = enclose(sought, span).range;
    if (values.is_empty() || !(values.high > 1.0)) continue;
    if (span.end - span.begin <= k_same_crossing) {
      if (!(values.low > 1.0) && !(enclose_at(sought, span.panel, span.end).range.high > 1.0)) continue;
      range.first_above_one = t_ + span.end * h_;
      return;
    }
    spans_.push_back({0.0, 0.0, span.panel, span.depth + 1, middle, span.end});
    spans_.push_back({0.0, 0.0, span.panel, span.depth + 1, span.begin, middle});
  }
}

} // namespace steplap
