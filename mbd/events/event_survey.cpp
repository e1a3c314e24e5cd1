// EventFinder: survey of the event functions that ends and stages of a step do not show to be positive.
//
// Each function g is interpolated on the dense output at the seven Chebyshev–Lobatto nodes of an interval, a part of the step. The
// error of the interpolant p is assumed to be |g − p| ≤ E, with E from its last two Chebyshev coefficients
// (mbd/base/part_polynomial.h). Starting with the whole step, the earliest part is treated as follows:
//   accept   if p and E show that every g is positive between the nodes, and one sample at a further point confirms |g − p| ≤ E;
//   bracket  if some g is negative at a node, has exactly one root since the node before, and all other g are positive up to the
//            end of the bracket;
//   split    otherwise, at the minimum of p or where |g − p| > E. The bottom of a dip becomes a node of both halves: g is sampled
//            there, and E of the halves is much smaller.
// The recursion ends at parts of length k_shortest, where only rounding is left.
//
// The bounds are derived in docs/explanation/theory.md, "Why no dip is missed". "Negative" means below −tolerance_ for functions that
// have a tolerance.
#include "mbd/events/event_finder.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ranges>
#include <utility>

namespace steplap {

namespace {

constexpr double k_shortest = 1e-9; // in θ: shorter parts are not split
// Smallest distance of a split from the ends of a part, relative to its length, so that both halves become shorter. If E exceeds the
// share k_rough of the largest value, the minimum of p is not reliable and the split is nearer to the middle.
constexpr double k_margin_of_cut = 0.1;
constexpr double k_margin_if_rough = 0.3, k_rough = 1e-3;
// A split has stalled if E is still above this share of the parent's E. Halving divides E by 32 for a smooth function and by 2 at
// a kink. After k_most_stalled such splits in a row E is rounding or a jump, and only the samples count.
constexpr double k_stalled = 0.9;
constexpr int k_most_stalled = 4;
constexpr int k_most_intervals = 400; // limit of the work in one step
// Smallest θ at which a function that is fresh or starts negative can become armed, because dense output does not resolve smaller changes.
// If such a function is still negative there, the event is at this θ.
constexpr double k_arming_theta = 1e-4;
// Allowance for functions that lie below their tangents. Two flanks of a sine, such as the end of an arm that turns past a thin wall, dip
// below the intersection of their tangents: by δ³/3 at a distance δ from it, which is 2 % of the value there between nodes of a step that
// turns by one radian. An intersection below this fraction of the larger of the two values therefore counts as negative, also because of a
// possible kink.
constexpr double k_of_flanks = 0.05;
constexpr double k_node_clearance = 0.25; // smallest distance of a check point from a node, relative to the gap: at the nodes g = p
// New E relative to the deviation |g − p| at the check point: between the first two nodes the deviation reaches only about a quarter of
// that in the middle of an interval.
constexpr double k_error_factor = 4.0;
constexpr double k_no_check_above = 0.25; // a function whose minimum is above this share of its largest value needs no check

} // namespace

// Finds two neighbouring nodes, up to `last`, between which a convex function may be negative although both samples are positive.
// The gap to a round body that is passed is such a function. With values w0, w1 and slopes s0 < 0 < s1, and the nodes `gap` apart,
// a convex function lies above both tangents. They meet at x from the first node:
//   w0 + s0 x = w1 + s1 (x − gap)   ⇒   x = (w1 − w0 − s1 gap)/(s0 − s1).
// Returns the position of x in the part, 0 … 1, if the tangents are below zero there, or near it (k_of_flanks); −1 otherwise, or if slopes
// are unknown.
double EventFinder::tangent_intersection(int slot, std::size_t last) const {
  const double begin = nodes_[0].theta, width = nodes_[k_node_count - 1].theta - begin;
  for (std::size_t k = 0; k < last; ++k) {
    const double w0 = nodes_[k].event_value[slot], w1 = nodes_[k + 1].event_value[slot];
    const double s0 = nodes_[k].rate[slot], s1 = nodes_[k + 1].rate[slot];
    if (!(s0 < 0.0 && s1 > 0.0)) continue;
    const double gap = nodes_[k + 1].theta - nodes_[k].theta, x = (w1 - w0 - s1 * gap) / (s0 - s1);
    if (x > 0.0 && x < gap && w0 + s0 * x < k_of_flanks * std::max(w0, w1))
      return std::clamp((nodes_[k].theta + x - begin) / width, k_margin_of_cut, 1.0 - k_margin_of_cut);
  }
  return -1.0;
}

// Fits an interpolant to each function in surveyed_slots_ and stores it in interpolants_, with the nodes from … to between which the
// function has to be positive. `last` is the last node before the first sign change. A function that fired ends there; all others are
// checked up to the next node, the end of the bracket. A function that is not armed, or is negative at the start of the part, is checked
// only from its first positive node on. Functions that are identically zero, or whose splits have stalled, are left out.
void EventFinder::fit_interpolants(const Interval& interval, std::size_t last) {
  interpolants_.clear();
  for (const int slot : surveyed_slots_) {
    Interpolant interpolant;
    interpolant.slot = slot;
    interpolant.has_fired = last + 1 < k_node_count && std::find(fired_.begin(), fired_.end(), slot) != fired_.end();
    interpolant.to = interpolant.has_fired ? last : std::min(last + 1, k_node_count - 1);
    const auto is_positive = [&](const Sample& sample) { return sample.event_value[slot] > 0.0 && sample.theta >= k_arming_theta; };
    if (armed_before_[slot] == 0 || nodes_[0].event_value[slot] < 0.0)
      while (interpolant.from < k_node_count && !is_positive(nodes_[interpolant.from])) ++interpolant.from;
    if (interpolant.from > interpolant.to) continue;
    PartPolynomial::Values values;
    for (std::size_t k = 0; k < k_node_count; ++k) values[k] = nodes_[k].event_value[slot];
    interpolant.polynomial.fit(values);
    if (interpolant.polynomial.largest() == 0.0) continue; // bodies that touch and do not move: a constant zero is not negative
    // Only the function that caused the split can stall. An error that does not decrease is rounding, as for an unloaded contact, or a
    // jump.
    const bool is_stalled = slot == interval.slot && interpolant.polynomial.error() > k_stalled * interval.error;
    interpolant.stalled = is_stalled ? interval.stalled + 1 : 0;
    if (interpolant.stalled < k_most_stalled) interpolants_.push_back(interpolant);
  }
}

// Returns the index of the first gap between nodes in which the function may be negative or, in the bracket, may have more than one
// root; −1 if there is none. Zero is replaced by −tolerance_.
int EventFinder::first_uncertain_gap(const Interpolant& interpolant) const {
  const double floor = -tolerance_[interpolant.slot];
  const int gap = interpolant.polynomial.first_uncertain_gap(floor, interpolant.from, interpolant.to);
  if (gap >= 0 || !interpolant.has_fired || interpolant.polynomial.falls_once(floor, interpolant.to)) return gap;
  return static_cast<int>(interpolant.to);
}

// Requests a split of the part at `position`, moved away from the ends of the part if necessary.
EventFinder::Split EventFinder::split_at(const Interpolant& interpolant, double position) const {
  const PartPolynomial& p = interpolant.polynomial;
  const double margin = p.error() > k_rough * p.largest() ? k_margin_if_rough : k_margin_of_cut;
  return {std::clamp(position, margin, 1.0 - margin), interpolant.slot, p.error(), interpolant.stalled};
}

// Returns the position at which the part has to be split because some function may be negative between nodes, by its tangents or by
// its interpolant. Returns nothing (slot −1) if all interpolants are positive. `last` as in fit_interpolants().
EventFinder::Split EventFinder::find_split(std::size_t last) const {
  for (const Interpolant& interpolant : interpolants_) {
    if (const double x = tangent_intersection(interpolant.slot, last); x >= 0.0) return {x, interpolant.slot, 0.0, 0};
    const int gap = first_uncertain_gap(interpolant);
    if (gap < 0) continue;
    const auto k = static_cast<std::size_t>(gap); // the minimum may lie just outside this gap, so the neighbours are searched too
    return split_at(interpolant, interpolant.polynomial.lowest(k > 0 ? k - 1 : 0, std::min(k + 2, k_node_count - 1)));
  }
  return {};
}

// Chooses the check point of a part: the minimum of the interpolant that comes nearest to zero relative to its largest value.
// Returns its position in the part, off the nodes; −1 if no function comes nearer than k_no_check_above, because then only an error of the
// size of the function itself could make it negative.
double EventFinder::check_point() const {
  const Interpolant* nearest = nullptr;
  double least = 0.0;
  for (const Interpolant& interpolant : interpolants_) {
    if (interpolant.from >= interpolant.to) continue;
    double low = nodes_[interpolant.from].event_value[interpolant.slot];
    for (std::size_t k = interpolant.from + 1; k <= interpolant.to; ++k) low = std::min(low, nodes_[k].event_value[interpolant.slot]);
    const double share = low / interpolant.polynomial.largest();
    if (nearest && share >= least) continue;
    nearest = &interpolant;
    least = share;
  }
  if (!nearest || least > k_no_check_above) return -1.0;
  const double x = nearest->polynomial.lowest(nearest->from, nearest->to);
  std::size_t gap = nearest->from;
  while (gap + 1 < nearest->to && x > PartPolynomial::node(gap + 1)) ++gap;
  const double begin = PartPolynomial::node(gap), width = PartPolynomial::node(gap + 1) - begin;
  return std::clamp(x, begin + k_node_clearance * width, begin + (1.0 - k_node_clearance) * width);
}

// Checks the interpolants, all positive so far, by one sample at x = check_point(). Returns a split at x in two cases:
//   - an armed function, interpolated or not, is negative at x although x lies before the first sign change at a node;
//   - an interpolant deviates from the sample by more than E, and with E enlarged accordingly it may be negative.
// Returns nothing (slot −1) otherwise.
EventFinder::Split EventFinder::verify_interpolants(Integrator& integrator, Dynamics& dynamics, const Interval& interval,
                                                    std::size_t last) {
  const double x = check_point();
  if (x < 0.0) return {};
  sample_at(integrator, dynamics, interval.begin + x * (interval.end - interval.begin), middle_);
  for (int i = 0; i < slots_ && x < PartPolynomial::node(last); ++i)
    if (armed_before_[i] && nodes_[0].event_value[i] >= -tolerance_[i] && middle_.event_value[i] < -tolerance_[i]) return {x, i, 0.0, 0};
  for (Interpolant& interpolant : interpolants_) {
    if (x < PartPolynomial::node(interpolant.from) || x > PartPolynomial::node(interpolant.to)) continue;
    const double off = std::abs(middle_.event_value[interpolant.slot] - interpolant.polynomial.at(x));
    if (!(off > interpolant.polynomial.error())) continue;
    interpolant.polynomial.widen(k_error_factor * off);
    if (first_uncertain_gap(interpolant) >= 0) return split_at(interpolant, x);
  }
  return {};
}

// Samples all event functions at the nodes 1 … 6 of the part, and arms those that are positive. Returns the last node before the
// first sign change of an armed function, or the last node of the part if there is none.
std::size_t EventFinder::sample_nodes(Integrator& integrator, Dynamics& dynamics, const Interval& interval) {
  const double width = interval.end - interval.begin;
  std::size_t last = k_node_count - 1;
  for (std::size_t k = 1; k < k_node_count; ++k) {
    const double theta = k == k_node_count - 1 ? interval.end : interval.begin + PartPolynomial::node(k) * width;
    if (theta == 1.0) stored_sample(integrator, true, nodes_[k]);
    else sample_at(integrator, dynamics, theta, nodes_[k]);
    if (last < k_node_count - 1) continue;
    if (find_sign_changes_beyond_tolerance(nodes_[k - 1], nodes_[k])) {
      last = k - 1;
      continue;
    }
    arm_positive(nodes_[k].theta, nodes_[k].event_value);
  }
  return last;
}

// Arms the functions that are positive at θ, unless θ is below k_arming_theta, where the sign is not reliable.
void EventFinder::arm_positive(double theta, const std::vector<double>& event_value) {
  if (theta < k_arming_theta) return;
  for (int i = 0; i < slots_; ++i)
    if (event_value[i] > 0.0) armed_[i] = 1;
}

// Creates the initial part, the whole step. If some function is not yet armed, the survey starts at k_arming_theta, where a sample arms
// the functions that are positive. The short interval before it becomes a separate part if an armed function is negative at
// k_arming_theta or not far from zero (test 1 of event_finder.h) between the two ends. Moves low_ to the start of the first part.
void EventFinder::push_first_interval(Integrator& integrator, Dynamics& dynamics, bool is_any_unarmed) {
  intervals_.clear();
  intervals_.push_back({});
  if (!is_any_unarmed) return;
  intervals_.back().begin = k_arming_theta;
  sample_at(integrator, dynamics, k_arming_theta, high_);
  const bool is_any_near = std::any_of(surveyed_slots_.begin(), surveyed_slots_.end(), [this](int slot) {
    const double low = std::min(low_.event_value[slot], high_.event_value[slot]),
                 high = std::max(low_.event_value[slot], high_.event_value[slot]);
    return armed_[slot] && 2.0 * low <= high;
  });
  if (is_any_near || find_sign_changes_beyond_tolerance(low_, high_)) {
    intervals_.push_back({0.0, k_arming_theta});
    return;
  }
  arm_positive(k_arming_theta, high_.event_value);
  std::swap(low_, high_);
}

// Treats one part; low_ must be the sample at its start. Returns true if it contains an event: the bracket is in low_ and high_, and
// the functions that change sign are in fired_. Returns false if the part is accepted, with low_ at its end, or split, with both
// halves on the stack, low_ unchanged and the functions armed in it disarmed again.
bool EventFinder::survey_interval(Integrator& integrator, Dynamics& dynamics, const Interval& interval) {
  const double width = interval.end - interval.begin;
  nodes_[0] = low_;
  armed_before_ = armed_;
  const std::size_t last = sample_nodes(integrator, dynamics, interval);
  if (last + 1 < k_node_count) (void)find_sign_changes_beyond_tolerance(nodes_[last], nodes_[last + 1]);
  if (width > k_shortest) {
    fit_interpolants(interval, last);
    Split split = find_split(last);
    if (split.slot < 0) split = verify_interpolants(integrator, dynamics, interval, last);
    if (split.slot >= 0) {
      const double cut = interval.begin + split.position * width;
      intervals_.push_back({cut, interval.end, split.slot, split.error, split.stalled});
      intervals_.push_back({interval.begin, cut, split.slot, split.error, split.stalled});
      armed_ = armed_before_;
      return false;
    }
  }
  if (last + 1 < k_node_count) {
    std::swap(low_, nodes_[last]);
    std::swap(high_, nodes_[last + 1]);
    return true;
  }
  std::swap(low_, nodes_[k_node_count - 1]);
  return false;
}

// Surveys the whole step. Returns the first bracket; `none` if every function is positive on all of the step.
EventFinder::Bracket EventFinder::survey(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh) {
  stored_sample(integrator, false, low_);
  bool is_any_unarmed = false;
  for (int i = 0; i < slots_; ++i) {
    armed_[i] = !fresh[i] && low_.event_value[i] >= 0.0;
    is_any_unarmed = is_any_unarmed || !armed_[i];
  }
  push_first_interval(integrator, dynamics, is_any_unarmed);
  // A function that is negative and has not been positive up to low_ shows that the mode chosen at the last event is wrong. An event
  // at θ = k_arming_theta makes EventHandler choose again. It has priority over a later bracket, so no step ends with a negative value.
  const auto every_slot = std::views::iota(0, slots_);
  const auto was_never_positive = [this](int slot) {
    return low_.theta < 1.0 ? armed_[slot] == 0 && low_.event_value[slot] < -tolerance_[slot] : low_.event_value[slot] < 0.0;
  };
  const auto falls_from_start = [this](int slot) { // after survey_interval() of a part that begins at k_arming_theta
    const double start = nodes_[0].event_value[slot];
    return armed_before_[slot] == 0 && start < -tolerance_[slot] && nodes_[1].event_value[slot] < start;
  };
  for (int parts = 0; !intervals_.empty(); ++parts) {
    const Interval interval = intervals_.back();
    intervals_.pop_back();
    // Limit of the work in one step: the step ends at low_; no event was found up to there.
    if (parts >= k_most_intervals && interval.begin > 0.0) {
      fired_.clear();
      high_ = low_;
      return Bracket::immediate;
    }
    const bool is_bracket = survey_interval(integrator, dynamics, interval);
    // So does a function that is negative and falls from k_arming_theta on, even if it is positive again at the end of the step.
    if (interval.begin == k_arming_theta && interval.end == 1.0 && std::any_of(every_slot.begin(), every_slot.end(), falls_from_start)) {
      fired_.clear();
      std::copy_if(every_slot.begin(), every_slot.end(), std::back_inserter(fired_), falls_from_start);
      high_.theta = k_arming_theta;
      return Bracket::immediate;
    }
    if (is_bracket) {
      const bool is_any_late = low_.theta >= k_arming_theta && std::any_of(every_slot.begin(), every_slot.end(), was_never_positive);
      if (!is_any_late) return classify_bracket();
      break;
    }
  }
  fired_.clear();
  std::copy_if(every_slot.begin(), every_slot.end(), std::back_inserter(fired_), was_never_positive);
  if (fired_.empty()) return Bracket::none;
  high_.theta = k_arming_theta;
  return Bracket::immediate;
}

// Classifies the bracket low_, high_. A function in fired_ that is between −tolerance_ and zero at low_ has passed zero before it. The
// event is then at low_, and fired_ keeps only such functions. Otherwise the bracket is ready for root finding.
EventFinder::Bracket EventFinder::classify_bracket() {
  const auto is_above = [this](int slot) { return low_.event_value[slot] >= 0.0; };
  if (std::all_of(fired_.begin(), fired_.end(), is_above)) return Bracket::found;
  fired_.erase(std::remove_if(fired_.begin(), fired_.end(), is_above), fired_.end());
  high_.theta = std::max(low_.theta, k_arming_theta);
  return Bracket::immediate;
}

} // namespace steplap
