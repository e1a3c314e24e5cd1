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
// The bounds are derived in docs/explanation/theory.md, "Why no dip is missed". "Negative" means below −slack_ for functions that
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
constexpr int k_most_parts = 400; // limit of the work in one step
// θ from which on a function that is fresh or starts negative can be armed, because dense output does not resolve smaller changes.
// A function that never becomes positive is reported here.
constexpr double k_at_once = 1e-4;
// Two flanks of a sine, such as the end of an arm that turns past a thin wall, dip below the point where their tangents meet: by δ³/3 at a
// distance δ from it, 2 % of the value there between nodes of a step that turns by a radian. So tangents that meet below this share of the
// larger of the two values count as well. A kink may lie there, too.
constexpr double k_of_flanks = 0.05;
constexpr double k_off_places = 0.25; // smallest distance of a check point from a node, in gaps between nodes: g = p at the nodes
// Factor from the deviation |g − p| at the check point to the new E: between the first two nodes the deviation reaches only about a
// quarter of that in the middle of a part.
constexpr double k_elsewhere = 4.0;
constexpr double k_far = 0.25; // a function whose minimum is above this share of its largest value needs no check

} // namespace

// Finds two neighbouring nodes, up to `last`, between which a convex function may be negative although both samples are positive.
// The gap to a round body that is passed is such a function. With values w0, w1 and slopes s0 < 0 < s1, and the nodes `gap` apart,
// a convex function lies above both tangents. They meet at x from the first node:
//   w0 + s0 x = w1 + s1 (x − gap)   ⇒   x = (w1 − w0 − s1 gap)/(s0 − s1).
// Returns the position of x in the part, 0 … 1, if the tangents are below zero there, or near it (k_of_flanks); −1 otherwise, or if slopes
// are unknown.
double EventFinder::tangents_meet_below(int slot, std::size_t last) const {
  const double begin = place_[0].theta, width = place_[k_places - 1].theta - begin;
  for (std::size_t k = 0; k < last; ++k) {
    const double w0 = place_[k].watch[slot], w1 = place_[k + 1].watch[slot];
    const double s0 = place_[k].rate[slot], s1 = place_[k + 1].rate[slot];
    if (!(s0 < 0.0 && s1 > 0.0)) continue;
    const double gap = place_[k + 1].theta - place_[k].theta, x = (w1 - w0 - s1 * gap) / (s0 - s1);
    if (x > 0.0 && x < gap && w0 + s0 * x < k_of_flanks * std::max(w0, w1))
      return std::clamp((place_[k].theta + x - begin) / width, k_margin_of_cut, 1.0 - k_margin_of_cut);
  }
  return -1.0;
}

// Fits an interpolant to each function in near_ and stores it in curves_, with the nodes from … to between which the function has
// to be positive. `last` is the last node before the first sign change. A function that fired ends there; all others are checked
// up to the next node, the end of the bracket. A function that is not armed, or is negative at the start of the part, is checked
// only from its first positive node on. Functions that are identically zero, or whose splits have stalled, are left out.
void EventFinder::fit_near(const Part& part, std::size_t last) {
  curves_.clear();
  for (const int slot : near_) {
    Near near;
    near.slot = slot;
    near.has_fired = last + 1 < k_places && std::find(fired_.begin(), fired_.end(), slot) != fired_.end();
    near.to = near.has_fired ? last : std::min(last + 1, k_places - 1);
    const auto is_positive = [&](const Look& place) { return place.watch[slot] > 0.0 && place.theta >= k_at_once; };
    if (armed_before_[slot] == 0 || place_[0].watch[slot] < 0.0)
      while (near.from < k_places && !is_positive(place_[near.from])) ++near.from;
    if (near.from > near.to) continue;
    PartPolynomial::Values values;
    for (std::size_t k = 0; k < k_places; ++k) values[k] = place_[k].watch[slot];
    near.polynomial.fit(values);
    if (near.polynomial.largest() == 0.0) continue; // bodies that touch and do not move: zero is not negative
    // Only the function that caused the split can stall: an error that does not fall is rounding, as of an unloaded contact, or a jump.
    const bool is_stalled = slot == part.slot && near.polynomial.error() > k_stalled * part.error;
    near.stalled = is_stalled ? part.stalled + 1 : 0;
    if (near.stalled < k_most_stalled) curves_.push_back(near);
  }
}

// Returns the index of the first gap between nodes in which the function may be negative or, in the bracket, may have more than one
// root; −1 if there is none. Zero is replaced by −slack_.
int EventFinder::doubtful_gap(const Near& near) const {
  const double floor = -slack_[near.slot];
  const int gap = near.polynomial.doubtful_gap(floor, near.from, near.to);
  if (gap >= 0 || !near.has_fired || near.polynomial.falls_once(floor, near.to)) return gap;
  return static_cast<int>(near.to);
}

// Requests a split of the part at `place`, moved away from the ends of the part if necessary.
EventFinder::Unclear EventFinder::unclear_at(const Near& near, double place) const {
  const PartPolynomial& p = near.polynomial;
  const double margin = p.error() > k_rough * p.largest() ? k_margin_if_rough : k_margin_of_cut;
  return {std::clamp(place, margin, 1.0 - margin), near.slot, p.error(), near.stalled};
}

// Returns the position at which the part has to be split because some function may be negative between nodes, by its tangents or by
// its interpolant. Returns nothing (slot −1) if all interpolants are positive. `last` as in fit_near().
EventFinder::Unclear EventFinder::unclear_place(std::size_t last) const {
  for (const Near& near : curves_) {
    if (const double x = tangents_meet_below(near.slot, last); x >= 0.0) return {x, near.slot, 0.0, 0};
    const int gap = doubtful_gap(near);
    if (gap < 0) continue;
    const auto k = static_cast<std::size_t>(gap); // the minimum may lie just outside this gap, so the neighbours are searched too
    return unclear_at(near, near.polynomial.lowest(k > 0 ? k - 1 : 0, std::min(k + 2, k_places - 1)));
  }
  return {};
}

// Chooses the check point of a part: the minimum of the interpolant that comes nearest to zero relative to its largest value.
// Returns its position in the part, off the nodes; −1 if no function comes nearer than k_far, because then only an error of the
// size of the function itself could make it negative.
double EventFinder::place_to_check() const {
  const Near* nearest = nullptr;
  double least = 0.0;
  for (const Near& near : curves_) {
    if (near.from >= near.to) continue;
    double low = place_[near.from].watch[near.slot];
    for (std::size_t k = near.from + 1; k <= near.to; ++k) low = std::min(low, place_[k].watch[near.slot]);
    const double share = low / near.polynomial.largest();
    if (nearest && share >= least) continue;
    nearest = &near;
    least = share;
  }
  if (!nearest || least > k_far) return -1.0;
  const double x = nearest->polynomial.lowest(nearest->from, nearest->to);
  std::size_t gap = nearest->from;
  while (gap + 1 < nearest->to && x > PartPolynomial::place(gap + 1)) ++gap;
  const double begin = PartPolynomial::place(gap), width = PartPolynomial::place(gap + 1) - begin;
  return std::clamp(x, begin + k_off_places * width, begin + (1.0 - k_off_places) * width);
}

// Checks the interpolants, all positive so far, by one sample at x = place_to_check(). Returns a split at x in two cases:
//   - an armed function, interpolated or not, is negative at x although x lies before the first sign change at a node;
//   - an interpolant deviates from the sample by more than E, and with E enlarged accordingly it may be negative.
// Returns nothing (slot −1) otherwise.
EventFinder::Unclear EventFinder::belied_place(Integrator& integrator, Dynamics& dynamics, const Part& part, std::size_t last) {
  const double x = place_to_check();
  if (x < 0.0) return {};
  watch_at(integrator, dynamics, part.begin + x * (part.end - part.begin), middle_);
  for (int i = 0; i < slots_ && x < PartPolynomial::place(last); ++i)
    if (armed_before_[i] && place_[0].watch[i] >= -slack_[i] && middle_.watch[i] < -slack_[i]) return {x, i, 0.0, 0};
  for (Near& near : curves_) {
    if (x < PartPolynomial::place(near.from) || x > PartPolynomial::place(near.to)) continue;
    const double off = std::abs(middle_.watch[near.slot] - near.polynomial.at(x));
    if (!(off > near.polynomial.error())) continue;
    near.polynomial.widen(k_elsewhere * off);
    if (doubtful_gap(near) >= 0) return unclear_at(near, x);
  }
  return {};
}

// Samples all event functions at the nodes 1 … 6 of the part, and arms those that are positive. Returns the last node before the
// first sign change of an armed function, or the last node of the part if there is none.
std::size_t EventFinder::look_at_places(Integrator& integrator, Dynamics& dynamics, const Part& part) {
  const double width = part.end - part.begin;
  std::size_t last = k_places - 1;
  for (std::size_t k = 1; k < k_places; ++k) {
    const double theta = k == k_places - 1 ? part.end : part.begin + PartPolynomial::place(k) * width;
    if (theta == 1.0) look_at_end(integrator, true, place_[k]);
    else watch_at(integrator, dynamics, theta, place_[k]);
    if (last < k_places - 1) continue;
    if (falls(place_[k - 1], place_[k])) {
      last = k - 1;
      continue;
    }
    arm_positive(place_[k].theta, place_[k].watch);
  }
  return last;
}

// Arms the functions that are positive at θ. Closer to the start than k_at_once the sign is not reliable.
void EventFinder::arm_positive(double theta, const std::vector<double>& watch) {
  if (theta < k_at_once) return;
  for (int i = 0; i < slots_; ++i)
    if (watch[i] > 0.0) armed_[i] = 1;
}

// Creates the initial part, the whole step. If some function is not yet armed, the survey starts at k_at_once, where a sample arms
// the functions that are positive. The short interval before it becomes a part of its own if an armed function is negative at
// k_at_once or not far from zero (test 1 of event_finder.h) between the two ends. Moves low_ to the start of the first part.
void EventFinder::begin_parts(Integrator& integrator, Dynamics& dynamics, bool is_any_unarmed) {
  parts_.clear();
  parts_.push_back({});
  if (!is_any_unarmed) return;
  parts_.back().begin = k_at_once;
  watch_at(integrator, dynamics, k_at_once, high_);
  const bool is_any_near = std::any_of(near_.begin(), near_.end(), [this](int slot) {
    const double low = std::min(low_.watch[slot], high_.watch[slot]), high = std::max(low_.watch[slot], high_.watch[slot]);
    return armed_[slot] && 2.0 * low <= high;
  });
  if (is_any_near || falls(low_, high_)) {
    parts_.push_back({0.0, k_at_once});
    return;
  }
  arm_positive(k_at_once, high_.watch);
  std::swap(low_, high_);
}

// Treats one part; low_ must be the sample at its start. Returns true if it contains an event: the bracket is in low_ and high_, and
// the functions that change sign are in fired_. Returns false if the part is accepted, with low_ at its end, or split, with both
// halves on the stack, low_ unchanged and the functions armed in it disarmed again.
bool EventFinder::look_through(Integrator& integrator, Dynamics& dynamics, const Part& part) {
  const double width = part.end - part.begin;
  place_[0] = low_;
  armed_before_ = armed_;
  const std::size_t last = look_at_places(integrator, dynamics, part);
  if (last + 1 < k_places) (void)falls(place_[last], place_[last + 1]);
  if (width > k_shortest) {
    fit_near(part, last);
    Unclear unclear = unclear_place(last);
    if (unclear.slot < 0) unclear = belied_place(integrator, dynamics, part, last);
    if (unclear.slot >= 0) {
      const double cut = part.begin + unclear.place * width;
      parts_.push_back({cut, part.end, unclear.slot, unclear.error, unclear.stalled});
      parts_.push_back({part.begin, cut, unclear.slot, unclear.error, unclear.stalled});
      armed_ = armed_before_;
      return false;
    }
  }
  if (last + 1 < k_places) {
    std::swap(low_, place_[last]);
    std::swap(high_, place_[last + 1]);
    return true;
  }
  std::swap(low_, place_[k_places - 1]);
  return false;
}

// Surveys the whole step. Returns the first bracket; `none` if every function is positive on all of the step.
EventFinder::Bracket EventFinder::survey(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh) {
  look_at_end(integrator, false, low_);
  bool is_any_unarmed = false;
  for (int i = 0; i < slots_; ++i) {
    armed_[i] = !fresh[i] && low_.watch[i] >= 0.0;
    is_any_unarmed = is_any_unarmed || !armed_[i];
  }
  begin_parts(integrator, dynamics, is_any_unarmed);
  // A function that is negative and has not been positive up to low_ shows that the mode chosen at the last event is wrong. An event
  // at θ = k_at_once makes EventHandler choose again. It has priority over a later bracket, so no step ends with a negative value.
  const auto every_slot = std::views::iota(0, slots_);
  const auto was_never_positive = [this](int slot) {
    return low_.theta < 1.0 ? armed_[slot] == 0 && low_.watch[slot] < -slack_[slot] : low_.watch[slot] < 0.0;
  };
  for (int parts = 0; !parts_.empty(); ++parts) {
    const Part part = parts_.back();
    parts_.pop_back();
    if (parts >= k_most_parts && part.begin > 0.0) { // too much work: the step ends at low_, up to which no event was found
      fired_.clear();
      high_ = low_;
      return Bracket::at_once;
    }
    if (look_through(integrator, dynamics, part)) {
      const bool is_any_late = low_.theta >= k_at_once && std::any_of(every_slot.begin(), every_slot.end(), was_never_positive);
      if (!is_any_late) return bracket_of_fall();
      break;
    }
  }
  fired_.clear();
  std::copy_if(every_slot.begin(), every_slot.end(), std::back_inserter(fired_), was_never_positive);
  if (fired_.empty()) return Bracket::none;
  high_.theta = k_at_once;
  return Bracket::at_once;
}

// Classifies the bracket low_, high_. A function in fired_ that is between −slack_ and zero at low_ has passed zero before it. The
// event is then at low_, and fired_ keeps only such functions. Otherwise the bracket is ready for root finding.
EventFinder::Bracket EventFinder::bracket_of_fall() {
  const auto is_above = [this](int slot) { return low_.watch[slot] >= 0.0; };
  if (std::all_of(fired_.begin(), fired_.end(), is_above)) return Bracket::found;
  fired_.erase(std::remove_if(fired_.begin(), fired_.end(), is_above), fired_.end());
  high_.theta = std::max(low_.theta, k_at_once);
  return Bracket::at_once;
}

} // namespace steplap
