// EventFinder: what watch values do inside a step that its ends and stages do not make certain.
//
// Part by part from the step's start, values at seven Chebyshev–Lobatto places of dense output are interpolated. With
// the Chebyshev coefficients a_0 … a_6 of a value, 4 (|a_5| + |a_6|) stands for the error of the polynomial: a part is clear of a value that stays above it. Else the part is divided, where the polynomial is
// least, so that the bottom of a dip becomes an end of both halves; a value that is negative at any place makes the
// bracket of an event. What dips below zero for less than k_shortest of a step, and only by rounding, is no event.
#include "mbd/events/event_finder.h"
#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace steplap {

namespace {

constexpr int k_order = 6;
constexpr int k_samples = 32;          // of the polynomial, to find its least value
constexpr double k_shortest = 1e-9;    // part of a step that is not divided
constexpr double k_margin_of_cut = 0.1; // of a part: not nearer to its ends;
constexpr double k_margin_if_rough = 0.3, k_rough = 1e-3; // … where the error is a larger share of the values than this
// Coefficients fall as 1/j² at a kink, the gap to a pin that is passed, and the rest of them sum up to so many of the
// last two; those of what is smooth fall much faster.
constexpr double k_tail = 4.0;
constexpr double k_rounding = 1e-15;   // of a value's largest: coefficients below it are rounding
constexpr double k_stalled = 0.9;      // of the error of the part before: no more exact
constexpr int k_most_stalled = 4;      // generations in a row
constexpr int k_most_parts = 400;      // of one step
constexpr double k_at_once = 1e-4;     // of the step: where what was never positive is decided anew

struct Chebyshev {
  double place[k_order + 1];                       // in [0, 1]
  double transform[k_order + 1][k_order + 1];      // coefficients from values
  double sample[k_samples + 1][k_order + 1];       // T_j at even places

  Chebyshev() {
    const double pi = std::numbers::pi;
    for (int k = 0; k <= k_order; ++k)
      place[k] = 0.5 * (1.0 - portable::cos(pi * k / k_order));
    for (int j = 0; j <= k_order; ++j)
      for (int k = 0; k <= k_order; ++k) {
        double w = 2.0 / k_order * portable::cos(pi * j * (k_order - k) / k_order);
        if (j == 0 || j == k_order) w *= 0.5;
        if (k == 0 || k == k_order) w *= 0.5;
        transform[j][k] = w;
      }
    for (int m = 0; m <= k_samples; ++m) { // T_j+1 = 2u T_j − T_j−1
      const double u = -1.0 + 2.0 * m / k_samples;
      sample[m][0] = 1.0;
      sample[m][1] = u;
      for (int j = 2; j <= k_order; ++j)
        sample[m][j] = 2.0 * u * sample[m][j - 1] - sample[m][j - 2];
    }
  }
};

const Chebyshev k_chebyshev; // made before main(): threads that run side by side find it made

double sum_at(const double* a, double x) {
  const double u = 2.0 * x - 1.0;
  double b1 = 0.0, b2 = 0.0;
  for (int j = k_order; j > 0; --j) {
    const double b = a[j] + 2.0 * u * b1 - b2;
    b2 = b1;
    b1 = b;
  }
  return a[0] + u * b1 - b2;
}

// Least value of the series between the samples beside x, where it is moved to (golden section).
double bottom_near(const double* a, double& x) {
  constexpr double k_golden = 0.3819660112501051;
  double low = x - 1.0 / k_samples, high = x + 1.0 / k_samples;
  for (int i = 0; i < 40; ++i) {
    const double left = low + k_golden * (high - low), right = high - k_golden * (high - low);
    (sum_at(a, left) < sum_at(a, right) ? high : low) = sum_at(a, left) < sum_at(a, right) ? right : left;
  }
  x = 0.5 * (low + high);
  return sum_at(a, x);
}

} // namespace

// Where the tangents at two neighbouring places, falling at one and rising at the next, meet below zero: the bottom of
// what is convex between them, as the gap to anything round that is flown past, may be as low. −1: nowhere, or rates
// are not known.
double EventFinder::tangents_meet_below(int slot, std::size_t last) const {
  const double begin = place_[0].theta, width = place_[k_order].theta - begin;
  for (std::size_t k = 0; k < last; ++k) {
    const double w0 = place_[k].watch[slot], w1 = place_[k + 1].watch[slot];
    const double s0 = place_[k].rate[slot], s1 = place_[k + 1].rate[slot];
    if (!(s0 < 0.0 && s1 > 0.0)) continue;
    const double gap = place_[k + 1].theta - place_[k].theta, x = (w1 - w0 - s1 * gap) / (s0 - s1);
    if (x > 0.0 && x < gap && w0 + s0 * x < 0.0)
      return std::clamp((place_[k].theta + x - begin) / width, k_margin_of_cut, 1.0 - k_margin_of_cut);
  }
  return -1.0;
}

// Where in the part between the first `count` + 1 places some near value may be below zero (0 … 1), −1 if nowhere.
EventFinder::Unclear EventFinder::unclear_place(const Part& part, std::size_t last) const {
  const Chebyshev& table = k_chebyshev;
  const double until = table.place[last];
  for (const int slot : near_) {
    if (!armed_[slot] || place_[0].watch[slot] < 0.0) continue; // not believed yet, or followed by the looks themselves
    if (const double x = tangents_meet_below(slot, last); x >= 0.0) return {x, slot, 0.0, 0};
    double a[k_order + 1] = {}, largest = 0.0;
    for (int k = 0; k <= k_order; ++k) {
      const double w = place_[k].watch[slot];
      largest = std::max(largest, std::abs(w));
      for (int j = 0; j <= k_order; ++j) a[j] += table.transform[j][k] * w;
    }
    if (largest == 0.0) continue; // what touches and does not move: zero is not below zero, however fine one looks
    double error = k_tail * (std::abs(a[k_order]) + std::abs(a[k_order - 1]));
    if (error < k_rounding * largest) error = 0.0;
    // What dividing does not make more exact is rounding (a contact that touches without being pressed), or a jump: its
    // values at the places are all there is to know. Errors at a kink fall with the width, those of what is smooth much
    // faster.
    const bool is_stalled = slot == part.slot && error > k_stalled * part.error;
    const int stalled = is_stalled ? part.stalled + 1 : 0;
    if (stalled >= k_most_stalled) continue;
    double p[k_samples + 1];
    for (int m = 0; m <= k_samples; ++m) {
      p[m] = 0.0;
      for (int j = 0; j <= k_order; ++j) p[m] += a[j] * table.sample[m][j];
    }
    double least = error - slack_[slot], at = -1.0;
    // The ends are known; what leaves one upward is above the error at the first sample.
    for (int m = 1; m < k_samples && static_cast<double>(m) / k_samples <= until; ++m) {
      double place = static_cast<double>(m) / k_samples, value = p[m];
      const bool is_bottom = p[m] <= p[m - 1] && p[m] <= p[m + 1] && p[m] < p[m - 1] - 2.0 * p[m] + p[m + 1];
      if (is_bottom && value > least) value = bottom_near(a, place);
      if (value > least) continue;
      least = value;
      at = place;
    }
    const double margin = error > k_rough * largest ? k_margin_if_rough : k_margin_of_cut;
    if (at >= 0.0) return {std::clamp(at, margin, 1.0 - margin), slot, error, stalled};
  }
  return {};
}

// A look beyond low_: true if something falls below zero between the two.
bool EventFinder::look_along(Integrator& integrator, Dynamics& dynamics, double theta) {
  if (theta == 1.0) look_at_end(integrator, true, high_);
  else watch_at(integrator, dynamics, theta, high_);
  if (falls(low_, high_)) return true;
  for (int i = 0; i < slots_; ++i)
    if (high_.watch[i] > 0.0) armed_[i] = 1;
  std::swap(low_, high_);
  return false;
}

// low_ is at the part's begin. True with a bracket in low_ and high_; else low_ is at its end, or the part has been divided.
bool EventFinder::look_through(Integrator& integrator, Dynamics& dynamics, const Part& part) {
  const Chebyshev& table = k_chebyshev;
  const double width = part.end - part.begin;
  place_[0] = low_;
  armed_before_ = armed_;
  std::size_t last = k_order; // place up to which nothing has been seen below zero
  for (std::size_t k = 1; k <= k_order; ++k) {
    const double theta = k == k_order ? part.end : part.begin + table.place[k] * width;
    if (theta == 1.0) look_at_end(integrator, true, place_[k]);
    else watch_at(integrator, dynamics, theta, place_[k]);
    if (last == k_order && falls(place_[k - 1], place_[k])) last = k - 1;
    if (last == k_order)
      for (int i = 0; i < slots_; ++i)
        if (place_[k].watch[i] > 0.0) armed_[i] = 1;
  }
  const bool may_divide = width > k_shortest && ++looked_through_ < k_most_parts;
  const Unclear unclear = may_divide ? unclear_place(part, last) : Unclear{};
  if (unclear.slot >= 0) {
    const double cut = part.begin + unclear.place * width;
    parts_.push_back({cut, part.end, unclear.slot, unclear.error, unclear.stalled});
    parts_.push_back({part.begin, cut, unclear.slot, unclear.error, unclear.stalled});
    armed_ = armed_before_;
    return false;
  }
  if (last < k_order) {
    (void)falls(place_[last], place_[last + 1]);
    std::swap(low_, place_[last]);
    std::swap(high_, place_[last + 1]);
    return true;
  }
  std::swap(low_, place_[k_order]);
  return false;
}

EventFinder::Bracket EventFinder::survey(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh) {
  look_at_end(integrator, false, low_);
  bool is_any_unarmed = false;
  for (int i = 0; i < slots_; ++i) {
    armed_[i] = !fresh[i] && low_.watch[i] >= 0.0;
    is_any_unarmed = is_any_unarmed || !armed_[i];
  }
  looked_through_ = 0;
  parts_.clear();
  parts_.push_back({});
  // Fresh values often turn within the first fraction of a step.
  if (is_any_unarmed)
    for (const double theta : {1e-4, 1e-3, 1e-2}) {
      if (look_along(integrator, dynamics, theta)) return bracket_of_fall();
      parts_.back().begin = theta;
    }
  while (!parts_.empty()) {
    const Part part = parts_.back();
    parts_.pop_back();
    if (look_through(integrator, dynamics, part)) return bracket_of_fall();
  }
  // Values that were never positive: the mode chosen is not the one the motion takes. The event
  // is at once; the handler decides anew a hair later. No step ends with a value below zero.
  fired_.clear();
  for (int i = 0; i < slots_; ++i)
    if (low_.watch[i] < 0.0) fired_.push_back(i);
  if (fired_.empty()) return Bracket::none;
  high_.theta = k_at_once;
  return Bracket::at_once;
}

// Of a value that lies within the slack below zero where the bracket begins, that is the event.
EventFinder::Bracket EventFinder::bracket_of_fall() {
  const auto is_above = [this](int slot) { return low_.watch[slot] >= 0.0; };
  if (std::all_of(fired_.begin(), fired_.end(), is_above)) return Bracket::found;
  fired_.erase(std::remove_if(fired_.begin(), fired_.end(), is_above), fired_.end());
  high_.theta = std::max(low_.theta, k_at_once);
  return Bracket::at_once;
}

} // namespace steplap
