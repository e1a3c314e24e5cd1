#include "mbd/event_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr int k_scan_points = 8;
constexpr int k_most_dip_looks = 60;      // at one dip
constexpr double k_least_part = 0.02;     // of a dip's width, to either side of its bottom
constexpr double k_same_place = 1e-9;     // of a step: the bottom has settled
constexpr double k_rest = 1e-12;          // change of any coordinate or rate over a step in which nothing moves
constexpr double k_looks_per_period = 16.0;
constexpr double k_unseen_share = 8.0;    // of the variation seen: what may be unseen
constexpr double k_fewest_looks = 8.0, k_most_looks = 1e6;

// Lowest point inside (0, 1) of the cubic with values w0, w1 and slopes s0, s1; NaN if none.
double bottom_of_cubic(double w0, double s0, double w1, double s1) {
  const double a = 2.0 * (w0 - w1) + s0 + s1, b = 3.0 * (w1 - w0) - 2.0 * s0 - s1;
  // 3aθ² + 2bθ + s0 = 0, the root where the curve turns upward
  const double discriminant = b * b - 3.0 * a * s0;
  if (!(discriminant >= 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return -s0 / (b + std::sqrt(discriminant));
}

// Nothing that is nowhere steeper than at the steeper one of its ends gets below zero if this is false; so no straight
// line does. False where a slope is not known (NaN).
bool may_dip(double w0, double s0, double w1, double s1) {
  return w0 + w1 < std::max(std::abs(s0), std::abs(s1)) && !std::isnan(s0) && !std::isnan(s1);
}

} // namespace

EventFinder::EventFinder(const System& system, int max_dimension)
    : shortest_period_(system.shortest_period), slots_(system.watch_count),
      unit_slots_(system.frictions.empty() ? slots_ : system.frictions.front().watch), y_(max_dimension, 0.0),
      dy_(max_dimension, 0.0),
      armed_(slots_, 1) {
  for (Look* const look : {&low_, &high_, &middle_}) {
    look->watch.assign(slots_, 0.0);
    look->rate.assign(slots_, 0.0);
  }
  dips_.reserve(slots_);
  look_at_.reserve(slots_ + 2 * k_scan_points);
}

void EventFinder::watch_at(Integrator& integrator, Dynamics& dynamics, double theta, Look& look) {
  integrator.dense(dynamics, theta, y_.data());
  dynamics.rates(integrator.t0() + theta * integrator.h(), y_.data(), dy_.data());
  dynamics.watch_merged_if_near(dy_.data(), is_resting_);
  look.theta = theta;
  look.watch = dynamics.watch();
  look.rate = dynamics.watch_rate();
  for (double& rate : look.rate) rate *= integrator.h();
}

// An end of the step.
void EventFinder::look_at_end(const Integrator& integrator, bool is_last, Look& look) {
  look.theta = is_last ? 1.0 : 0.0;
  look.watch = is_last ? integrator.watch1() : integrator.watch0();
  look.rate = is_last ? integrator.watch_rate1() : integrator.watch_rate0();
  for (double& rate : look.rate) rate *= integrator.h();
}

// Rounding, or the projection at another event, can leave a gap negative before it was seen to cross. Not
// asked of friction: elements that share a load are at rest with bounds of their own already passed.
bool EventFinder::starts_negative(const Integrator& integrator, int slot) const {
  return slot < unit_slots_ && integrator.watch0()[slot] < 0.0;
}

EventFinder::Suspicion EventFinder::suspicion(const Integrator& integrator,
                                              const std::vector<char>& fresh) {
  look_at_.clear();
  dips_.clear();
  Suspicion worst = Suspicion::none;
  const double h = integrator.h();
  for (int i = 0; i < slots_; ++i) {
    const double w0 = integrator.watch0()[i], w1 = integrator.watch1()[i];
    if (w1 < 0.0) {
      // A plain crossing; a value that is fresh, or negative from the start, has to be followed.
      worst = std::max(worst, fresh[i] || starts_negative(integrator, i) ? Suspicion::inside : Suspicion::at_end);
      continue;
    }
    // A fresh value rises from zero; but a contact may open and close again, or the other way round, in one step.
    if (fresh[i] && i >= unit_slots_) continue;
    if (integrator.watch_low()[i] < 0.0) worst = Suspicion::inside;
    const double s0 = h * integrator.watch_rate0()[i], s1 = h * integrator.watch_rate1()[i];
    if (may_dip(w0, fresh[i] ? 0.0 : s0, w1, s1)) dips_.push_back(i);
  }
  return worst;
}

// A gap of something round is not as smooth as the motion: what passes a pin in a flight of one step comes near it for
// a moment. Parts of the step that can hold no zero are left, the others halved, or divided at the bottom of their
// cubic, until the value is below zero or cannot be.
bool EventFinder::follow_dip(Integrator& integrator, Dynamics& dynamics, int slot, const DipEnd& a, const DipEnd& b) {
  const double width = b.theta - a.theta;
  if (dip_looks_ >= k_most_dip_looks || width < k_same_place) return false;
  if (!may_dip(a.value, width * a.slope, b.value, width * b.slope)) return false;
  const double place = bottom_of_cubic(a.value, width * a.slope, b.value, width * b.slope);
  const double theta = a.theta + width * (place > k_least_part && place < 1.0 - k_least_part ? place : 0.5);
  ++dip_looks_;
  watch_at(integrator, dynamics, theta, middle_);
  const DipEnd now{theta, middle_.watch[slot], middle_.rate[slot]};
  if (now.value < 0.0) {
    look_at_.push_back(theta);
    return true;
  }
  return follow_dip(integrator, dynamics, slot, a, now) || follow_dip(integrator, dynamics, slot, now, b);
}

void EventFinder::follow_dips(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh) {
  const double h = integrator.h();
  for (const int slot : dips_) {
    dip_looks_ = 0;
    const double s0 = fresh[slot] ? 0.0 : h * integrator.watch_rate0()[slot];
    follow_dip(integrator, dynamics, slot, {0.0, integrator.watch0()[slot], s0},
               {1.0, integrator.watch1()[slot], h * integrator.watch_rate1()[slot]});
  }
}

// Golden section about the lowest of three looks; true (and a place to scan) if it gets below zero.
bool EventFinder::is_negative_near(Integrator& integrator, Dynamics& dynamics, int slot, double middle, double reach) {
  constexpr double k_golden = 0.3819660112501051;
  double low = middle - reach, high = middle + reach;
  for (int i = 0; i < 40 && high - low > k_same_place; ++i) {
    const double left = low + k_golden * (high - low), right = high - k_golden * (high - low);
    watch_at(integrator, dynamics, left, middle_);
    const double at_left = middle_.watch[slot];
    watch_at(integrator, dynamics, right, middle_);
    const double at_right = middle_.watch[slot];
    if (std::min(at_left, at_right) < 0.0) {
      look_at_.push_back(at_left < 0.0 ? left : right);
      return true;
    }
    (at_left < at_right ? high : low) = at_left < at_right ? right : left;
  }
  return false;
}

// Nothing has moved in a step whose length no error has limited: only loads change, and with them what friction has
// to hold.
void EventFinder::watch_rest(Integrator& integrator, Dynamics& dynamics) {
  const int n = 2 * dynamics.coordinate_count();
  for (int i = 0; i < n; ++i)
    if (std::abs(integrator.y1()[i] - integrator.y0()[i]) > k_rest) return;
  // The last of an element's slots is its place, which does not change at rest.
  const auto is_place = [this](int slot) { return (slot - unit_slots_) % k_friction_watches == k_friction_watches - 1; };
  // Nor is there anything to see where what the ends and the stages have met is far from zero, or constant.
  bool varies = dynamics.layout().is_merged_watched; // the stages have not looked at those
  for (int i = unit_slots_; i < slots_ && !varies; ++i) {
    if (is_place(i)) continue;
    const double w0 = integrator.watch0()[i], w1 = integrator.watch1()[i];
    const double low = std::min({w0, w1, integrator.watch_low()[i]});
    varies = low < k_unseen_share * (std::max(w0, w1) - low);
  }
  if (!varies) return;
  is_resting_ = true;
  const double looks = std::ceil(k_looks_per_period * integrator.h() / shortest_period_);
  const int count = static_cast<int>(std::clamp(looks, k_fewest_looks, k_most_looks));
  Look before, now, after;
  look_at_end(integrator, false, before);
  watch_at(integrator, dynamics, 1.0 / count, now);
  for (int p = 1; p < count; ++p) {
    if (p + 1 == count) look_at_end(integrator, true, after);
    else watch_at(integrator, dynamics, static_cast<double>(p + 1) / count, after);
    for (int i = unit_slots_; i < slots_; ++i) {
      if (is_place(i)) continue;
      if (now.watch[i] < 0.0) return look_at_.push_back(static_cast<double>(p) / count);
      const bool is_lowest = now.watch[i] <= before.watch[i] && now.watch[i] <= after.watch[i];
      // A parabola through the three falls below the lowest by an eighth of this at most; smooth curves by not much more.
      const double bend = before.watch[i] - 2.0 * now.watch[i] + after.watch[i];
      if (is_lowest && now.watch[i] < 0.25 * bend &&
          is_negative_near(integrator, dynamics, i, static_cast<double>(p) / count, 1.0 / count))
        return;
    }
    std::swap(before, now);
    std::swap(now, after);
  }
}

// Slots that were believed positive in `low` and are negative in `high` go to fired_.
bool EventFinder::crosses(const Look& low, const Look& high) {
  fired_.clear();
  for (int i = 0; i < slots_; ++i)
    if (armed_[i] && high.watch[i] < 0.0 && low.watch[i] >= 0.0) fired_.push_back(i);
  return !fired_.empty();
}

EventFinder::Bracket EventFinder::bracket_whole(const Integrator& integrator) {
  look_at_end(integrator, false, low_);
  look_at_end(integrator, true, high_);
  std::fill(armed_.begin(), armed_.end(), 1);
  return crosses(low_, high_) ? Bracket::found : Bracket::none;
}

EventFinder::Bracket EventFinder::scan(Integrator& integrator, Dynamics& dynamics,
                                       const std::vector<char>& fresh) {
  for (int i = 0; i < slots_; ++i) armed_[i] = !fresh[i] && !starts_negative(integrator, i);
  for (int p = 1; p < k_scan_points; ++p) look_at_.push_back(static_cast<double>(p) / k_scan_points);
  // Fresh values often turn within the first fraction of a step.
  if (std::find(armed_.begin(), armed_.end(), 0) != armed_.end())
    for (const double theta : {1e-4, 1e-3, 1e-2}) look_at_.push_back(theta);
  look_at_.push_back(1.0);
  std::sort(look_at_.begin(), look_at_.end());
  look_at_end(integrator, false, low_);
  for (const double theta : look_at_) {
    if (theta == 1.0) look_at_end(integrator, true, high_);
    else watch_at(integrator, dynamics, theta, high_);
    if (crosses(low_, high_)) return Bracket::found;
    for (int i = 0; i < slots_; ++i)
      if (high_.watch[i] > 0.0) armed_[i] = 1;
    std::swap(low_, high_);
  }
  // Fresh values that were never positive: the mode chosen is not the one the motion takes. The event
  // is at once; the handler decides anew a hair later.
  for (int i = 0; i < slots_; ++i)
    if (!armed_[i] && low_.watch[i] < 0.0) fired_.push_back(i);
  if (fired_.empty()) return Bracket::none;
  high_.theta = look_at_.front();
  return Bracket::at_once;
}

bool EventFinder::find(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh) {
  if (slots_ == 0) return false;
  is_resting_ = false;
  Suspicion suspected = suspicion(integrator, fresh);
  follow_dips(integrator, dynamics, fresh);
  if (!look_at_.empty()) suspected = Suspicion::inside;
  if (suspected == Suspicion::none && unit_slots_ < slots_ && integrator.is_adaptive()) {
    watch_rest(integrator, dynamics);
    if (!look_at_.empty()) suspected = Suspicion::inside;
  }
  if (suspected == Suspicion::none) return false;
  const Bracket bracket = suspected == Suspicion::inside ? scan(integrator, dynamics, fresh)
                                                         : bracket_whole(integrator);
  if (bracket == Bracket::none) return false;
  if (bracket == Bracket::found) close_in(integrator, dynamics);
  theta_ = high_.theta;
  integrator.dense(dynamics, theta_, y_.data());
  return true;
}

} // namespace steplap
