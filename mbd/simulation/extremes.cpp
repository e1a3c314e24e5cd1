#include "mbd/simulation/extremes.h"

#include "mbd/integrators/methods.h"
#include "mbd/simulation/channel_rates.h"
#include "mbd/simulation/node_polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace steplap {

namespace {

// Returns the shortest period of the harmonics of loads and drives around t, s; infinite if there are none.
double shortest_period(const System& system, double t) { return 2.0 * std::numbers::pi / system.fastest_at(t); }

constexpr int k_last = NodePolynomial::k_last; // index of the last node, at the end of the stretch
constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();

// Safety factor of the curvature, which the second difference of three ends may underestimate.
constexpr double k_surprise = 3.0;
// Weight of the curvature from earlier stretches, because a long step may contain an oscillation whose ends show no curvature.
constexpr double k_remembered = 0.5;
constexpr double k_samples_per_period = 8.0; // samples per period of the fastest load
// Distance from both extremes, relative to the range of a channel, above which values are ignored if the curvature is small enough.
constexpr double k_within_reach = 0.25;
constexpr double k_bit_of_slack = 0.1; // accuracy of a polynomial's maximum, relative to the tolerance
// One error estimate in a hundred is too small by up to this factor. A maximum is evaluated if its estimate times this factor exceeds the
// tolerance.
constexpr double k_safety = 3.0;
constexpr double k_same_crossing = 1e-10; // accuracy of crossing times, relative to the stretch
// At most this number of channels are searched separately without a test for rounding noise.
constexpr std::size_t k_few = 8;
constexpr int k_most_probes = 8;
// Time shift of the test for rounding noise, relative to the stretch: smooth curves and kinks change by 1/100 of the differences between nodes
constexpr double k_hair = 1.25e-4;
// a channel that changes by more over a few time shifts, relative to the differences between nodes, is noise
constexpr double k_jitter = 0.25;
constexpr double k_most_jitter = 1e-6; // a change above this fraction of the largest value in the same unit is not rounding
// Limits of the error of linear extrapolation over two stretches, relative to the range of a channel. Below the first limit stretches of
// fixed steps are lengthened, above the second shortened.
constexpr double k_well_resolved = 0.01, k_badly_resolved = 0.05;

// Returns true for channels whose values are codes. They change only at events, so the ends of stretches contain their extremes.
bool is_mode(const Channel& channel) { return !channel.codes.empty(); }

// Returns the indices of the channels that have extremes.
std::vector<std::size_t> searched_channels(const System& system) {
  std::vector<std::size_t> searched;
  for (std::size_t c = 0; c < system.channels.size(); ++c)
    if (system.channels[c].has_extremes) searched.push_back(c);
  return searched;
}

} // namespace

const Extreme& ChannelRange::largest() const { return std::abs(low.value) > std::abs(high.value) ? low : high; }

ExtremeFinder::ExtremeFinder(const System& system, int max_dimension)
    : system_(system), searched_(searched_channels(system)), count_(searched_.size()), kind_(count_), screened_slot_(count_, -1),
      rate_of_(count_, k_no_rate), before_(count_, k_unknown), node_(k_nodes, std::vector<double>(count_, k_unknown)), curve_(count_),
      curvature_(count_, 0.0), step_t_(k_longest + 1), stride_(static_cast<std::size_t>(max_dimension)), y_(stride_), dy_(stride_),
      scratch_(count_), faces_(system) {
  step_y_.resize(stride_ * (k_longest + 1));
  step_k_.resize(stride_ * (k_longest + 1));
  ranges_.reserve(system.channels.size());
  for (const Channel& channel : system.channels) ranges_.emplace_back().channel = &channel;
  const std::vector<int> rates = rates_of(system);
  for (std::size_t c = 0; c < count_; ++c) {
    const Channel& channel = *range(c).channel;
    const auto kind = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& each) { return *each.unit == channel.unit; });
    kind_[c] = static_cast<int>(kind - kinds_.begin());
    if (kind == kinds_.end()) kinds_.push_back({&channel.unit});
    if (const int rate = rates[searched_[c]]; rate >= 0) {
      const auto found = std::lower_bound(searched_.begin(), searched_.end(), static_cast<std::size_t>(rate));
      const bool is_searched = found != searched_.end() && *found == static_cast<std::size_t>(rate);
      rate_of_[c] = is_searched ? static_cast<int>(found - searched_.begin()) : k_rate_not_searched;
    }
    if (channel.unit.empty()) dimensionless_.push_back(c);
    if (!channel.bounds) continue;
    screened_slot_[c] = static_cast<int>(bounds_.size());
    bounds_.emplace_back();
  }
  known_direction_.reserve(count_);
  formulas_ = std::make_unique<FormulaExtremes>(system, searched_, rates);
  bounds_before_ = bounds_;
  is_wanted_.assign(bounds_.size(), 1);
  open_.reserve(count_);
}

void ExtremeFinder::note(std::size_t c, double value, double t) {
  ChannelRange& r = range(c);
  if (std::isnan(value)) {
    r.had_no_value = true;
    return;
  }
  if (!(value >= r.low.value)) {
    r.low = {value, t};
    r.is_low_singular = is_singular_;
  }
  if (!(value <= r.high.value)) {
    r.high = {value, t};
    r.is_high_singular = is_singular_;
  }
}

void ExtremeFinder::take(std::size_t c, double t, const Snapshot& snapshot, double* values) {
  values[c] = range(c).channel->value(snapshot);
  take(c, t, values[c]);
}

void ExtremeFinder::take(std::size_t c, double t, double value) {
  if (!known_direction_.empty()) record_known_direction(c, value);
  const bool is_new = !(value >= range(c).low.value && value <= range(c).high.value);
  if (!is_new) return;
  note(c, value, t);
  if (!std::isfinite(value)) return;
  Kind& kind = kinds_[kind_[c]];
  const double spread = range(c).high.value - range(c).low.value;
  if (std::isfinite(spread)) kind.range = std::max(kind.range, spread);
  kind.largest = std::max(kind.largest, std::abs(value));
}

// Evaluates channels at an end of a stretch: all, or without `is_everything` only those whose extremes may be exceeded according to their
// bounds.
void ExtremeFinder::evaluate(double t, const Snapshot& snapshot, double* values, bool is_everything) {
  for (std::size_t c = 0; c < count_; ++c)
    if (is_everything || !is_ruled_out(c)) take(c, t, snapshot, values);
    else values[c] = k_unknown;
}

// Determines which expensive channels may exceed their extremes, from their bounds at the last two ends.
void ExtremeFinder::screen(const Snapshot& snapshot) {
  std::swap(bounds_, bounds_before_);
  for (std::size_t c = 0; c < count_; ++c) {
    const int slot = screened_slot_[c];
    if (slot < 0) continue;
    const ValueBounds now = range(c).channel->bounds(snapshot), before = bounds_before_[slot];
    bounds_[slot] = now;
    const double up = now.high + std::abs(now.high - before.high), down = now.low - std::abs(now.low - before.low);
    const double slack = tolerance(c);
    is_wanted_[slot] = !(up <= range(c).high.value + slack) || !(down >= range(c).low.value - slack);
  }
}

void ExtremeFinder::begin(double t, const Snapshot& snapshot) {
  const bool is_start = !is_begun_;
  is_begun_ = true;
  is_singular_ = false;
  if (!is_start && t > t_) pass_between(t, snapshot);
  screen(snapshot);
  evaluate(t, snapshot, node_[0].data(), is_start);
  if (is_start) {
    for (ChannelRange& each : ranges_) each.first = each.channel->value(snapshot);
    set_scales();
  }
  for (const std::size_t c : dimensionless_)
    if (!range(c).first_above_one && node_[0][c] > 1.0) range(c).first_above_one = t;
  formulas_->begin(snapshot);
  faces_.begin(snapshot);
  t_ = t;
  h_last_ = 0.0;
  steps_ = 0;
  longest_ = 1;
}

// Access of the extreme search for formulas (FormulaExtremes) to the stretch that starts at t_.
class ExtremeFinder::Site : public ExtremeSite {
public:
  Site(ExtremeFinder& finder, double h, Integrator* integrator, Dynamics* dynamics)
      : finder_(finder), h_(h), integrator_(integrator), dynamics_(dynamics) {}
  ChannelRange& range(std::size_t channel) override { return finder_.range(channel); }
  [[nodiscard]] double tolerance(std::size_t channel) const override { return finder_.tolerance(channel); }
  Snapshot evaluate_dense(double theta) override { return finder_.evaluate_dense(theta, *integrator_, *dynamics_); }
  void note(std::size_t channel, double value, double theta) override { finder_.take(channel, finder_.t_ + theta * h_, value); }

private:
  ExtremeFinder& finder_;
  double h_;
  Integrator* integrator_; ///< null, like dynamics_, if there is no dense output
  Dynamics* dynamics_;
};

// Passes a step of a method that determines contact modes itself: only the ends are known, with straight lines between them.
void ExtremeFinder::pass_between(double t, const Snapshot& snapshot) {
  Site site(*this, t - t_, nullptr, nullptr);
  formulas_->arrive(snapshot);
  formulas_->search_linear_step(t_, t - t_, site);
}

void ExtremeFinder::finish(const Snapshot& snapshot) {
  for (ChannelRange& each : ranges_) each.final = each.channel->value(snapshot);
  for (std::size_t c = 0; c < count_; ++c) range(c).resolution = std::max(tolerance(c), formulas_->unclosed(c, range(c)));
  const auto beyond = [](double extreme, double sure) { return extreme == sure || std::isnan(extreme) ? 0.0 : std::abs(extreme - sure); };
  for (std::size_t c = 0; c < known_direction_.size(); ++c) {
    range(c).unsure_low = beyond(range(c).low.value, known_direction_[c].low);
    range(c).unsure_high = beyond(range(c).high.value, known_direction_[c].high);
  }
}

void ExtremeFinder::finish_rates(const Snapshot& snapshot, double before) {
  for (ChannelRange& each : ranges_)
    if (!is_mode(*each.channel)) each.final_rate = (each.final - each.channel->value(snapshot)) / before;
}

std::vector<double> ExtremeFinder::values(const Snapshot& snapshot) const {
  std::vector<double> values;
  values.reserve(ranges_.size());
  for (const ChannelRange& each : ranges_) values.push_back(each.channel->value(snapshot));
  return values;
}

void ExtremeFinder::finish_bends(const std::vector<double>& middle, const Snapshot& snapshot, double before) {
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    ChannelRange& each = ranges_[i];
    const double bend = (each.final - 2.0 * middle[i] + each.channel->value(snapshot)) / (before * before);
    if (!is_mode(*each.channel) && std::isfinite(bend)) each.final_bend = bend;
  }
}

// --- along the steps --------------------------------------------------------------------------------------------

// Stores the start of a fixed step; a stretch contains several.
void ExtremeFinder::keep_step(const Integrator& integrator, const Dynamics& dynamics) {
  if (integrator.is_adaptive()) return;
  const auto n = static_cast<std::size_t>(dynamics.dimension());
  const auto i = static_cast<std::size_t>(steps_++);
  step_t_[i] = integrator.t0();
  std::copy_n(integrator.y0(), n, &step_y_[stride_ * i]);
  std::copy_n(integrator.rate0(), n, &step_k_[stride_ * i]);
}

void ExtremeFinder::add_step(Integrator& integrator, Dynamics& dynamics, bool is_at_end, bool is_last) {
  keep_step(integrator, dynamics);
  if (steps_ > 0 && steps_ < longest_ && !is_last) return;
  if (!is_at_end) dynamics.rates(integrator.t1(), integrator.y1(), dy_.data());
  end_stretch(integrator.t1(), is_at_end ? integrator.rate1() : dy_.data(), integrator, dynamics);
}

void ExtremeFinder::end_at(double t, Integrator& integrator, Dynamics& dynamics) {
  keep_step(integrator, dynamics);
  state_at(t, integrator, dynamics);
  dynamics.rates(t, y_.data(), dy_.data());
  end_stretch(t, dy_.data(), integrator, dynamics);
}

void ExtremeFinder::end_stretch(double t, const double* dy, Integrator& integrator, Dynamics& dynamics) {
  // A step without motion may be longer than many periods of a load. Such a step is divided into pieces.
  const double begin = t_, pieces = std::ceil((t - t_) / shortest_period(system_, 0.5 * (t_ + t)) * k_samples_per_period / k_last);
  for (double i = 1.0; i < pieces; ++i) {
    const double piece_end = begin + i / pieces * (t - begin);
    state_at(piece_end, integrator, dynamics);
    dynamics.rates(piece_end, y_.data(), dy_.data());
    arrive(piece_end, dynamics.snapshot(dy_.data()), integrator, dynamics);
  }
  if (pieces > 1.0) { // `dy` of the end has been overwritten and is computed again
    state_at(t, integrator, dynamics);
    dynamics.rates(t, y_.data(), dy_.data());
    dy = dy_.data();
  }
  arrive(t, dynamics.snapshot(dy), integrator, dynamics);
  steps_ = 0;
}

void ExtremeFinder::arrive(double t, const Snapshot& snapshot, Integrator& integrator, Dynamics& dynamics) {
  is_singular_ = dynamics.smallest_pivot() < k_singular_pivot;
  const bool was_unsure = is_unsure_;
  check_slip_directions(integrator, dynamics, false);
  screen(snapshot);
  evaluate(t, snapshot, node_[k_last].data(), false);
  formulas_->arrive(snapshot);
  faces_.arrive(snapshot);
  const bool is_unsure = is_unsure_;
  is_unsure_ = was_unsure; // the flag at the start applies to the inside of the stretch
  close(t, integrator, dynamics);
  is_unsure_ = is_unsure;
}

void ExtremeFinder::state_at(double t, Integrator& integrator, Dynamics& dynamics) {
  int i = steps_ - 1;
  while (i > 0 && t < step_t_[i]) --i;
  if (i == steps_ - 1 || i < 0) {
    integrator.dense(dynamics, std::clamp((t - integrator.t0()) / integrator.h(), 0.0, 1.0), y_.data());
    return;
  }
  const double h = step_t_[i + 1] - step_t_[i];
  const double *y = &step_y_[stride_ * i], *k = &step_k_[stride_ * i];
  hermite_dense(dynamics.coordinate_count(), dynamics.dimension(), (t - step_t_[i]) / h, h, y, y + stride_, k, k + stride_, y_.data());
}

Snapshot ExtremeFinder::evaluate_dense(double theta, Integrator& integrator, Dynamics& dynamics) {
  const double t = t_ + theta * (t1_ - t_);
  state_at(t, integrator, dynamics);
  dynamics.rates(t, y_.data(), dy_.data());
  is_singular_ = dynamics.smallest_pivot() < k_singular_pivot;
  return dynamics.snapshot(dy_.data());
}

void ExtremeFinder::close(double t, Integrator& integrator, Dynamics& dynamics) {
  t1_ = t;
  const double h = t1_ - t_;
  if (h > 0.0) {
    if (suspect(h)) search(integrator, dynamics);
    Site site(*this, h, &integrator, &dynamics);
    formulas_->search(t_, h, site);
    find_crossings(integrator, dynamics);
    adapt_length();
  }
  std::swap(before_, node_[0]);
  std::swap(node_[0], node_[k_last]);
  formulas_->pass(h);
  t_last_ = t_;
  h_last_ = h;
  t_ = t;
}

// Returns true if the cubic through values and rates at both ends of a stretch has an extreme inside. For coordinates and velocities of
// bodies.
bool ExtremeFinder::turns_inside(std::size_t c, double h) const {
  const int rate = rate_of_[c];
  if (rate < 0) return rate == k_rate_not_searched; // values of the rate are unknown: the channel may turn
  const double s0 = h * at(rate, 0), s1 = h * at(rate, k_last), rise = at(c, k_last) - at(c, 0);
  if (!(s0 * s1 > 0.0)) return s0 != 0.0 || s1 != 0.0;
  // The slope is s0 + 2 (3 rise − 2 s0 − s1) θ + 3 (s0 + s1 − 2 rise) θ²; its extreme value is compared with the sign of s0.
  const double b = 3.0 * rise - 2.0 * s0 - s1, a = 3.0 * (s0 + s1 - 2.0 * rise), theta = a != 0.0 ? -b / a : -1.0;
  return theta > 0.0 && theta < 1.0 && (s0 + b * theta) * s0 <= 0.0;
}

// Collects in open_ the channels that may exceed their extremes of the run inside the stretch. Returns true if there are any.
bool ExtremeFinder::suspect(double h) {
  open_.clear();
  const double *const first = node_[0].data(), *const end = node_[k_last].data(), *const before = before_.data();
  const double h_last = h_last_, share = h / h_last, halves = 1.0 + h_last / h,
               square = h * h; // h² converts between second differences of this stretch and curvature per s²
  for (std::size_t c = 0; c < count_; ++c) {
    const double a = first[c], b = end[c];
    ChannelSearchState& curve = curve_[c];
    curve.is_open = false;
    curve.error = std::numeric_limits<double>::infinity();
    if (h_last > 0.0 && a == b && a == before[c] && curvature_[c] == 0.0 && rate_of_[c] == k_no_rate) continue; // channel at rest
    if (is_mode(*range(c).channel) || formulas_->is_formula(c) || is_ruled_out(c) || std::isinf(a) || std::isinf(b)) continue;
    const double slope = b - a, last = h_last > 0.0 ? (a - before[c]) * share : k_unknown;
    if (!std::isnan(slope) && !std::isnan(last)) { // change over this stretch, and over the same duration before
      const double bend_now = std::abs(slope - last) / halves;
      curvature_[c] = std::max(bend_now / square, k_remembered * curvature_[c]);
      const double bend = k_surprise * curvature_[c] * h * h;
      const bool turns = turns_inside(c, h);
      if (std::abs(slope) > bend && !turns) continue; // monotonic: no extreme inside
      const double slack = tolerance(c);
      const int rate = rate_of_[c];
      const double steepest = turns && rate >= 0 ? std::max(std::abs(at(rate, 0)), std::abs(at(rate, k_last))) : 0.0;
      const double gain = 0.25 * std::max(bend, std::abs(h) * steepest);
      const ChannelRange& r = range(c);
      if (gain <= slack) continue;
      if (std::max(a, b) + gain <= r.high.value + slack && std::min(a, b) - gain >= r.low.value - slack) continue;
    }
    curve.is_open = true;
    open_.push_back(c);
  }
  return !open_.empty();
}

// --- inside a stretch ---------------------------------------------------------------------------------------------

// Returns the polynomial through the values of channel c at the nodes of a level, multiplied by `sign`.
static NodePolynomial through_nodes(const std::vector<std::vector<double>>& nodes, std::size_t c, int level, double sign) {
  NodePolynomial::Values values;
  for (int i = 0, place = 0; place <= k_last; ++i, place += NodePolynomial::spacing(level)) values[i] = sign * nodes[place][c];
  return {level, values};
}

// Returns the interpolated value at a node of the next level.
static double interpolated(const std::vector<std::vector<double>>& nodes, std::size_t c, int level,
                           const NodePolynomial::Weights& weights) {
  const int n = 1 << level, step = NodePolynomial::spacing(level);
  const std::vector<double>* row = nodes.data();
  double above = 0.0;
  for (int i = 0; i <= n; ++i, row += step) above += weights.of[i] * (*row)[c];
  return above / weights.sum;
}

// Ends the search for channel c after the nodes of `level` if its polynomial is accurate enough or no extreme can be exceeded. Stores the
// extremes found, or puts uncertain ones into unchecked_. Returns false if more nodes are needed.
bool ExtremeFinder::settle(std::size_t c, int level) {
  const int n = 1 << level;
  const double slack = tolerance(c);
  const ChannelRange& r = range(c);
  // curve_[c].error is the deviation of the polynomial of half the degree at the new nodes. For a smooth curve, doubling the number of
  // nodes squares the relative error; at a kink it halves the error.
  constexpr double k_faster_than_at_kink = 0.25;
  NodePolynomial::Values v;
  const std::vector<double>* row = node_.data();
  double least = (*row)[c], most = least, sum = 0.0;
  for (int i = 0; i <= n; ++i, row += NodePolynomial::spacing(level)) {
    v[i] = (*row)[c];
    least = std::min(least, v[i]);
    most = std::max(most, v[i]);
    sum += v[i];
  }
  const double spread = most - least;
  const bool is_smooth = level > 1 && spread > 0.0 && curve_[c].error <= k_faster_than_at_kink * curve_[c].earlier_error;
  const double error = is_smooth ? curve_[c].error * std::min(1.0, curve_[c].error / spread) : curve_[c].error;
  for (const double sign : {1.0, -1.0}) {
    const double record = sign > 0.0 ? r.high.value : -r.low.value, best = sign > 0.0 ? most : -least;
    if (!std::isfinite(best)) continue;
    if (!std::isfinite(sum)) return false;
    // Skip if the extreme of the run cannot be exceeded by more than the tolerance.
    if (best + NodePolynomial::k_overshoot * spread + error <= record + slack) continue;
    if (!NodePolynomial::may_exceed(record + slack, error, level, v, sign, best)) continue;
    if (error > slack) return false;
    // Beyond k_at_pole only the magnitude matters, which the nodes show. Between them a polynomial through reciprocals of rounding errors
    // may have any sign.
    if (range(c).channel->unit.empty() && std::abs(best) > k_at_pole) continue;
    const double bit = k_bit_of_slack * slack; // accuracy of the maximum of the polynomial
    const auto top = through_nodes(node_, c, level, sign).top_above(record + slack - bit - error, bit);
    if (!top || !(top->value + bit + error > record + slack)) continue;
    // At the first level the error estimate is the deviation at a single point, which may be small by chance.
    if (level == 1 || k_safety * error > slack) {
      unchecked_.push_back({c, top->theta, sign * top->value});
      continue;
    }
    if (!known_direction_.empty()) record_known_direction(c, sign * top->value);
    note(c, sign * top->value, t_ + top->theta * (t1_ - t_));
  }
  return true;
}

// Evaluates the maxima that settle() put into unchecked_, one evaluation for each; channels whose polynomial deviates there remain open. If
// there are many, evaluations are saved: after the first level all these channels get the nodes of the next level, which they share, and at
// higher levels the maxima are accepted without evaluation.
void ExtremeFinder::check_tops(int level, Integrator& integrator, Dynamics& dynamics) {
  const bool are_many = unchecked_.size() > k_few;
  for (const Top& top : unchecked_) {
    const double t = t_ + top.theta * (t1_ - t_);
    bool is_exact = true;
    if (!are_many) {
      const double value = range(top.channel).channel->value(evaluate_dense(top.theta, integrator, dynamics));
      take(top.channel, t, value);
      is_exact = std::abs(value - top.value) <= tolerance(top.channel);
    } else if (level == 1) {
      is_exact = false;
    } else {
      if (!known_direction_.empty()) record_known_direction(top.channel, top.value);
      note(top.channel, top.value, t);
    }
    if (!is_exact && std::find(open_.begin(), open_.end(), top.channel) == open_.end()) open_.push_back(top.channel);
  }
  unchecked_.clear();
}

void ExtremeFinder::refine(int level, Integrator& integrator, Dynamics& dynamics) {
  const int step = NodePolynomial::spacing(level);
  for (const std::size_t c : open_) {
    curve_[c].earlier_error = level == 1 ? std::numeric_limits<double>::infinity() : curve_[c].error;
    curve_[c].error = level == 1 && h_last_ == 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  }
  for (int i = step; i < k_last; i += 2 * step) {
    const double theta = NodePolynomial::theta(i);
    const Snapshot snapshot = evaluate_dense(theta, integrator, dynamics);
    const NodePolynomial::Weights* const weights = level > 1 ? &NodePolynomial::weights_at(level - 1, theta) : nullptr;
    // The value in the middle may reveal an extreme that the ends did not indicate. All channels are checked, because everything has been
    // evaluated there. Fixed steps are excluded: near the end of a slip their accuracy of its direction is too low.
    if (level == 1 && integrator.is_adaptive()) {
      for (std::size_t c = 0; c < count_; ++c) {
        ChannelSearchState& curve = curve_[c];
        if (curve.is_open || rate_of_[c] != k_no_rate || formulas_->is_formula(c))
          continue; // turns_inside() already covers positions and velocities
        const ChannelRange& r = range(c);
        const double a = at(c, 0), b = at(c, k_last), reach = k_within_reach * (r.high.value - r.low.value);
        if (std::max(a, b) + reach < r.high.value && std::min(a, b) - reach > r.low.value) continue;
        if (a == b && a == before_[c]) continue; // channel at rest
        const double slack = tolerance(c);
        const auto may_be_beyond = [&](double above, double below, double bend) {
          const double gain = k_surprise * bend / 8.0;
          return gain > slack && (above + gain > r.high.value + slack || below - gain < r.low.value - slack);
        };
        bool is_beyond = false;
        if (is_ruled_out(c)) {
          const ValueBounds &from = bounds_before_[screened_slot_[c]], m = r.channel->bounds(snapshot), &to = bounds_[screened_slot_[c]];
          const double bend = std::max(std::abs(from.low - 2.0 * m.low + to.low), std::abs(from.high - 2.0 * m.high + to.high));
          is_beyond = may_be_beyond(std::max({from.high, m.high, to.high}), std::min({from.low, m.low, to.low}), bend);
        } else {
          const double m = r.channel->value(snapshot), bend = std::abs(a - 2.0 * m + b);
          take(c, t_ + theta * (t1_ - t_), m);
          is_beyond = may_be_beyond(std::max({a, m, b}), std::min({a, m, b}), bend);
        }
        if (!is_beyond) continue;
        curve = {true, h_last_ == 0.0 ? std::numeric_limits<double>::infinity() : 0.0};
        open_.push_back(c);
      }
    }
    for (const std::size_t c : open_) {
      take(c, t_ + theta * (t1_ - t_), snapshot, node_[i].data());
      double guess = k_unknown;
      if (level > 1) guess = interpolated(node_, c, level - 1, *weights);
      // Deviation of the middle from the parabola through the ends of this stretch and the start of the previous one.
      else if (h_last_ > 0.0) {
        const double h = t1_ - t_, a = at(c, 0), b = at(c, k_last);
        const double bend = ((b - a) - (a - before_[c]) * (h / h_last_)) / (1.0 + h_last_ / h);
        guess = 0.5 * (a + b) - 0.25 * bend;
      }
      const double error = std::abs(at(c, i) - guess);
      curve_[c].error = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(curve_[c].error, error);
    }
  }
}

void ExtremeFinder::search(Integrator& integrator, Dynamics& dynamics) {
  // Evaluates, at an end of the stretch, the channels that were not evaluated there because of their bounds.
  const auto stored_sample = [&](int node) {
    const auto is_missing = [&](std::size_t c) { return screened_slot_[c] >= 0 && std::isnan(node_[node][c]); };
    if (std::none_of(open_.begin(), open_.end(), is_missing)) return;
    const Snapshot snapshot = evaluate_dense(NodePolynomial::theta(node), integrator, dynamics);
    for (const std::size_t c : open_)
      if (is_missing(c)) take(c, t_ + NodePolynomial::theta(node) * (t1_ - t_), snapshot, node_[node].data());
  };
  stored_sample(0);
  const double wanted = (t1_ - t_) / shortest_period(system_, 0.5 * (t_ + t1_)) * k_samples_per_period;
  for (int level = 1; level <= 3 && !open_.empty(); ++level) {
    refine(level, integrator, dynamics);
    if (level == 1)
      for (const int node : {0, k_last}) stored_sample(node);
    if (wanted > 1 << level) continue; // the nodes of this level are too few for oscillating loads
    std::erase_if(open_, [&](std::size_t c) { return settle(c, level); });
    check_tops(level, integrator, dynamics);
  }
  drop_jittery(integrator, dynamics);
  for (const std::size_t c : open_) section(c, integrator, dynamics);
}

// Returns the larger difference between the value at node `middle` and those at its neighbours.
double ExtremeFinder::spread_about(std::size_t c, int middle) const {
  return std::max(std::abs(at(c, middle + 1) - at(c, middle)), std::abs(at(c, middle) - at(c, middle - 1)));
}

// Closes the search for channels that contain rounding noise. In a large scene the changes of accelerations in a short stretch are rounding
// errors of positions far from the origin. No polynomial approximates them, and separate searches for all channels would cost the square of
// the scene. A channel is noise if a tiny time shift changes it as much as it changes between its nodes; a few evaluations common to all
// channels test this. Its extremes are then known only to that accuracy.
void ExtremeFinder::drop_jittery(Integrator& integrator, Dynamics& dynamics) {
  if (open_.size() <= k_few) return;
  constexpr std::size_t k_places = k_last / 2;
  std::vector<std::array<double, k_places>> changes(open_.size()); // per channel: largest change at each place
  for (int probe = 0; probe < k_most_probes && open_.size() > k_few; ++probe) {
    for (std::size_t place = 0; place < k_places; ++place) {
      const int node = 2 * static_cast<int>(place) + 1;
      const double theta = NodePolynomial::theta(node) + (probe + 1) * k_hair;
      const Snapshot snapshot = evaluate_dense(theta, integrator, dynamics);
      for (std::size_t k = 0; k < open_.size(); ++k) {
        take(open_[k], t_ + theta * (t1_ - t_), snapshot, scratch_.data());
        const double change = std::abs(scratch_[open_[k]] - at(open_[k], node));
        if (std::isfinite(change)) changes[k][place] = std::max(changes[k][place], change);
      }
    }
    std::size_t left = 0;
    for (std::size_t k = 0; k < open_.size(); ++k) {
      std::array<double, k_places> sorted = changes[k];
      std::sort(sorted.begin(), sorted.end());
      if (is_jitter(open_[k], sorted[k_places - 2])) continue; // the second largest, because a single place may be at a jump
      changes[left] = changes[k];
      open_[left++] = open_[k];
    }
    open_.resize(left);
  }
}

// Returns true if `change`, over a tiny time shift, is comparable to the differences between nodes, and stores it in jitter_.
bool ExtremeFinder::is_jitter(std::size_t c, double change) {
  double spread = 0.0;
  for (int i = 1; i < k_last; ++i) spread = std::max(spread, spread_about(c, i));
  if (!(change > 0.0 && change >= k_jitter * spread && change <= k_most_jitter * kinds_[kind_[c]].largest)) return false;
  if (jitter_.empty()) jitter_.assign(count_, 0.0);
  jitter_[c] = std::max(jitter_[c], change);
  return true;
}

// Finds by bisection the first time at which a channel without unit exceeds 1 (ChannelRange::first_above_one).
void ExtremeFinder::find_crossings(Integrator& integrator, Dynamics& dynamics) {
  for (const std::size_t c : dimensionless_) {
    ChannelRange& r = range(c);
    if (r.first_above_one || !(r.high.value > 1.0)) continue;
    if (r.high.t <= t_) { // the largest value was reached before the present stretch
      r.first_above_one = r.high.t;
      continue;
    }
    const double h = t1_ - t_;
    double low = 0.0, high = std::min(1.0, (r.high.t - t_) / h);
    while (high - low > k_same_crossing) {
      const double middle = 0.5 * (low + high);
      take(c, t_ + middle * h, evaluate_dense(middle, integrator, dynamics), scratch_.data());
      (scratch_[c] > 1.0 ? high : low) = middle;
    }
    r.first_above_one = t_ + high * h;
  }
}

// Adapts the number of fixed steps in a stretch, from the error of linear extrapolation over two stretches.
void ExtremeFinder::adapt_length() {
  if (steps_ == 0) return;
  const double h = t1_ - t_;
  if (!(h_last_ > 0.0)) {
    longest_ = 1;
    return;
  }
  double worst = 0.0;
  for (std::size_t c = 0; c < count_; ++c) {
    const double off = std::abs((at(c, k_last) - at(c, 0)) - (at(c, 0) - before_[c]) * (h / h_last_));
    if (!std::isfinite(off)) continue;
    const ChannelRange& r = range(c);
    const double scale = r.high.value - r.low.value + (tolerance(c) / k_badly_resolved);
    worst = std::max(worst, off / scale);
  }
  if (worst < k_well_resolved) longest_ = std::min(2 * longest_, k_longest);
  else if (worst > k_badly_resolved) longest_ = std::max(1, longest_ / 2);
}

} // namespace steplap
