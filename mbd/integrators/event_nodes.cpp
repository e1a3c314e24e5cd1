#include "mbd/integrators/event_nodes.h"

#include "mbd/integrators/explicit_runge_kutta.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace steplap {

namespace {

// Safety factor of the curvature bound M. A kink between two nodes enters each of the two adjacent second differences with half of the
// curvature that covers it (factor 2); the rest is a margin of 2.
constexpr double k_curvature_safety = 4.0;
// For few nodes: |w″| in terms of the range of w, because second differences miss the curvature where w″ changes sign. A harmonic that
// turns by 1.6 rad about such a point has |w″| up to 1.28 times the range of w.
constexpr double k_bend_of_range = 2.0;
// |w″| in terms of the range of w for the utilisation of a joint with variable clamping pressure, 1 − 1/q with q = 1 + b (1 − cos 1.6 θ). Its
// curvature is 2.56 (1 + b) times its range where the pressure is least, and small elsewhere. b = 9 if the pressure falls to a tenth of
// its mean.
constexpr double k_bend_of_share = 25.6;
constexpr double k_steeper = 1.5;       // largest increase of a slope towards a kink (EventNodes::Curve::bound): 1/cos of 0.84 rad
constexpr int k_few = 3;                // with at most this many gaps between nodes the range of w determines M
constexpr double k_unseen_by_one = 2.0; // with a single inner node: possible minimum below the lowest node, in ranges of the three values

// Returns true if chord − ½ M s (g − s) > 0 for 0 < s < g, with end values a and b.
bool is_positive_between(double a, double b, double g, double m) {
  const double slope = (b - a) / g;
  const double s = 0.5 * g - slope / m; // position of the minimum
  if (!(s > 0.0)) return b > 0.0;
  if (!(s < g)) return a > 0.0;
  return a + slope * s - 0.5 * m * s * (g - s) > 0.0;
}

// Returns true if the curvature can be estimated. Three nodes (rk4) have a single second difference, in which components of a sum of
// harmonics may cancel; then slopes at both ends are required.
template <class Curve> bool tells_bend(const Curve& c) {
  return c.last > 2 || (c.last == 2 && !std::isnan(c.start_slope) && !std::isnan(c.end_slope));
}

} // namespace

void EventNodes::add(double theta, const double* event_value, bool has_merged) {
  if (count_ == k_most || !(theta > 0.0 && theta < 1.0)) return;
  int place = count_;
  for (; place > 0 && theta_[order_[place - 1]] > theta; --place) order_[place] = order_[place - 1];
  if (place > 0 && theta_[order_[place - 1]] == theta) {
    for (int i = place; i < count_; ++i) order_[i] = order_[i + 1];
    // rk4 has two stages at the midpoint, which deviate by h² a/8 in opposite directions; their mean is used.
    double* const known = values_.data() + static_cast<std::ptrdiff_t>(order_[place - 1]) * stride_;
    for (int k = 0; k < slots_; ++k) known[k] = 0.5 * (known[k] + event_value[k]);
    has_merged_[order_[place - 1]] = has_merged_[order_[place - 1]] && has_merged;
    return;
  }
  order_[place] = count_;
  theta_[count_] = theta;
  has_merged_[count_] = has_merged;
  std::copy_n(event_value, slots_, values_.data() + static_cast<std::ptrdiff_t>(count_) * stride_);
  ++count_;
}

void EventNodes::close(const double* event_value0, const double* event_value1) {
  for_numbers(
      slots_,
      [ event_value0, event_value1, values = values_.data(), count = count_, stride = stride_, low = low_.data(),
        high = high_.data() ]<class S>(int i) __attribute__((always_inline)) {
        S first, last, value;
        read_numbers(event_value0 + i, first);
        read_numbers(event_value1 + i, last);
        S least = first < last ? first : last, most = first < last ? last : first;
        const double* at = values + i;
        // NaN: the event function was not evaluated at this stage; the previous value is kept
        for (int k = 0; k < count; ++k, at += stride) {
          read_numbers(at, value);
          least = value < least ? value : least;
          most = value > most ? value : most;
        }
        std::memcpy(low + i, &least, sizeof least);
        std::memcpy(high + i, &most, sizeof most);
      });
  if (count_ > 1) return;
  // With one inner node (rk4) components of a sum of harmonics may cancel at all three nodes, so the function may be lower between them.
  for (int i = 0; i < slots_; ++i) low_[i] -= k_unseen_by_one * (high_[i] - low_[i]);
}

EventNodes::Curve EventNodes::curve_of(const EventStep& watched) const {
  Curve c;
  int n = 0;
  c.x[0] = 0.0;
  c.w[0] = watched.start.value;
  for (int k = 0; k < count_; ++k) {
    const int place = order_[k];
    if (watched.is_merged && !has_merged_[place]) continue;
    c.x[++n] = theta_[place];
    c.w[n] = values_[static_cast<std::size_t>(place) * stride_ + watched.slot];
  }
  c.x[++n] = 1.0;
  c.w[n] = watched.end.value;
  c.last = n;
  c.start_slope = watched.start.slope;
  c.end_slope = watched.end.slope;
  for (int j = 1; j < n; ++j)
    c.bend[j] =
        2.0 * ((c.w[j + 1] - c.w[j]) / (c.x[j + 1] - c.x[j]) - (c.w[j] - c.w[j - 1]) / (c.x[j] - c.x[j - 1])) / (c.x[j + 1] - c.x[j - 1]);
  c.bend[0] = c.bend[1];
  c.bend[n] = c.bend[n - 1];
  // Slopes at the ends of the step, if known, are exact; second differences there are not.
  const auto [least, most] = std::minmax_element(c.w.begin(), c.w.begin() + n + 1);
  c.most_bend = (watched.is_of_joint ? k_bend_of_share : k_bend_of_range) * (*most - *least);
  const double first = c.x[1], rest = 1.0 - c.x[n - 1];
  if (!std::isnan(c.start_slope)) c.bend[0] = 2.0 * ((c.w[1] - c.w[0]) / first - c.start_slope) / first;
  if (!std::isnan(c.end_slope)) c.bend[n] = 2.0 * (c.end_slope - (c.w[n] - c.w[n - 1]) / rest) / rest;
  return c;
}

// Returns M. A kink with slope jump s at distance u from one node lowers w below its chord by s u (g − u)/g; this corresponds to M = 2
// s/g. (Example: the distance to an object that is passed.) Second differences underestimate s if the neighbouring gaps are wide, so s
// is also taken from the slopes of the adjacent chords. The flanks of a point that passes on a circle get steeper towards the kink, by
// at most k_steeper in a step that turns by one radian. If a slope is unknown, comparisons with NaN are false.
double EventNodes::Curve::bound(int gap) const {
  const auto chord = [this](int i) { return (w[i + 1] - w[i]) / (x[i + 1] - x[i]); };
  const double before = gap > 0 ? chord(gap - 1) : start_slope, after = gap + 1 < last ? chord(gap + 1) : end_slope;
  const double kink = 2.0 * k_steeper * std::abs(after - before) / (x[gap + 1] - x[gap]);
  const double seen = std::max(k_curvature_safety * std::max(std::abs(bend[gap]), std::abs(bend[gap + 1])), kink);
  return last > k_few ? seen : std::max(seen, most_bend);
}

bool EventNodes::Curve::is_positive_in(int gap) const {
  const double m = bound(gap), g = x[gap + 1] - x[gap];
  if (is_positive_between(w[gap], w[gap + 1], g, m)) return true;
  // Returns true if w leaves zero at the start of the step, or approaches zero at its end, with a slope that exceeds the possible
  // curvature (comparisons with NaN are false).
  return (gap == 0 && start_slope > 0.5 * m * g) || (gap == last - 1 && -end_slope > 0.5 * m * g);
}

bool EventNodes::Curve::falls_once_in(int gap) const {
  const double g = x[gap + 1] - x[gap];
  return w[gap] - w[gap + 1] > 0.5 * bound(gap) * g * g || bend[gap] * bend[gap + 1] > 0.0;
}

bool EventNodes::is_proven_positive(const EventStep& watched) const {
  const Curve c = curve_of(watched);
  if (!(c.w[0] >= 0.0 && c.w[c.last] >= 0.0) || !tells_bend(c)) return false;
  for (int j = 1; j < c.last; ++j)
    if (!(c.w[j] > 0.0)) return false;
  for (int gap = 0; gap < c.last; ++gap)
    if (!c.is_positive_in(gap)) return false;
  return true;
}

bool EventNodes::crosses_once(const EventStep& watched) const {
  const Curve c = curve_of(watched);
  if (!tells_bend(c)) return false;
  int gap = 0;
  for (; c.w[gap + 1] >= 0.0; ++gap)
    if (!c.is_positive_in(gap)) return false;
  return c.falls_once_in(gap);
}

} // namespace steplap
