#include "mbd/integrators/watch_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// A kink between two places shows in the differences at both as half of what would bound it there; and as much again.
constexpr double k_curvature_safety = 4.0;

// Least of chord − ½ M s (g − s) over 0 < s < g for values a, b at its ends: positive?
bool is_positive_between(double a, double b, double g, double m) {
  const double slope = (b - a) / g;
  const double s = 0.5 * g - slope / m; // where it is least
  if (!(s > 0.0)) return b > 0.0;
  if (!(s < g)) return a > 0.0;
  return a + slope * s - 0.5 * m * s * (g - s) > 0.0;
}

// Ranges by the values at four places.
void widen(int slots, const std::array<const double*, 4>& values, double* __restrict low, double* __restrict high) {
  const double *__restrict a = values[0], *__restrict b = values[1], *__restrict c = values[2], *__restrict d = values[3];
  for (int i = 0; i < slots; ++i) {
    double least = low[i], most = high[i];
    least = a[i] < least ? a[i] : least;
    most = a[i] > most ? a[i] : most;
    least = b[i] < least ? b[i] : least;
    most = b[i] > most ? b[i] : most;
    least = c[i] < least ? c[i] : least;
    most = c[i] > most ? c[i] : most;
    low[i] = d[i] < least ? d[i] : least;
    high[i] = d[i] > most ? d[i] : most;
  }
}

} // namespace

void WatchNodes::add(double theta, const double* watch) {
  if (count_ == k_most || !(theta > 0.0 && theta < 1.0)) return;
  int place = count_;
  while (place > 0 && theta_[order_[place - 1]] > theta) --place;
  if (place > 0 && theta_[order_[place - 1]] == theta) {
    // Of two stages at one place, the midpoints of rk4, one is off to either side, by h² a/8: their mean is not.
    double* const known = values_.data() + static_cast<std::ptrdiff_t>(order_[place - 1]) * stride_;
    for (int k = 0; k < slots_; ++k) known[k] = 0.5 * (known[k] + watch[k]);
    return;
  }
  for (int i = count_; i > place; --i) order_[i] = order_[i - 1];
  order_[place] = count_;
  theta_[count_] = theta;
  std::copy_n(watch, slots_, values_.data() + static_cast<std::ptrdiff_t>(count_) * stride_);
  ++count_;
}

void WatchNodes::close(const double* watch0, const double* watch1) {
  for (int i = 0; i < slots_; ++i) {
    low_[i] = watch0[i] < watch1[i] ? watch0[i] : watch1[i];
    high_[i] = watch0[i] < watch1[i] ? watch1[i] : watch0[i];
  }
  const auto at = [this](int place) { return values_.data() + static_cast<std::ptrdiff_t>(std::min(place, count_ - 1)) * stride_; };
  for (int k = 0; k < count_; k += 4) widen(slots_, {at(k), at(k + 1), at(k + 2), at(k + 3)}, low_.data(), high_.data());
}

bool WatchNodes::is_surely_positive(int slot, const WatchEnd& start, const WatchEnd& end) const {
  std::array<double, k_most + 2> x, w, bend; // bend[j]: |w″| by the difference about j
  const int n = count_ + 1;
  x[0] = 0.0;
  w[0] = start.value;
  for (int j = 1; j < n; ++j) {
    x[j] = theta_[order_[j - 1]];
    w[j] = values_[static_cast<std::size_t>(order_[j - 1]) * stride_ + slot];
    if (!(w[j] > 0.0)) return false;
  }
  x[n] = 1.0;
  w[n] = end.value;
  if (!(w[0] >= 0.0 && w[n] >= 0.0) || n < 2) return false;
  for (int j = 1; j < n; ++j)
    bend[j] = 2.0 * std::abs(((w[j + 1] - w[j]) / (x[j + 1] - x[j]) - (w[j] - w[j - 1]) / (x[j] - x[j - 1])) /
                             (x[j + 1] - x[j - 1]));
  bend[0] = bend[1];
  bend[n] = bend[n - 1];
  // What is known of slopes at the ends tells more than the stages.
  if (!std::isnan(start.slope)) bend[0] = 2.0 * std::abs((w[1] - w[0]) / x[1] - start.slope) / x[1];
  if (!std::isnan(end.slope)) bend[n] = 2.0 * std::abs(end.slope - (w[n] - w[n - 1]) / (1.0 - x[n - 1])) / (1.0 - x[n - 1]);
  for (int j = 0; j < n; ++j) {
    const double m = k_curvature_safety * std::max(bend[j], bend[j + 1]), g = x[j + 1] - x[j];
    if (is_positive_between(w[j], w[j + 1], g, m)) continue;
    // Out of the start or into the end with a slope that is known (comparisons with NaN are false).
    if (j == 0 && start.slope > 0.5 * m * g) continue;
    if (j == n - 1 && -end.slope > 0.5 * m * g) continue;
    return false;
  }
  return true;
}

bool WatchNodes::crosses_once(int slot) const {
  bool is_negative = false;
  for (int k = 0; k < count_; ++k) {
    const double w = values_[static_cast<std::size_t>(order_[k]) * stride_ + slot];
    if (is_negative && w >= 0.0) return false;
    is_negative = is_negative || w < 0.0;
  }
  return true;
}

} // namespace steplap
