#include "mbd/integrators/rate_rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_rounding = 0.5 * std::numeric_limits<double>::epsilon(); // relative rounding error of one sum

// Linear congruential generator of Numerical Recipes; its highest bit is the sign.
double next_sign(std::uint32_t& state) {
  state = state * 1664525U + 1013904223U;
  return state >> 31U == 0 ? 1.0 : -1.0;
}

} // namespace

void RateRounding::restart() {
  steps_ = 0;
  is_known_ = false;
  signs_ = 0; // restarted, so that a leg does not depend on earlier ones
  std::fill(size_.begin(), size_.end(), 0.0);
}

void RateRounding::note_step(Dynamics& dynamics, double t, const double* y, const double* dy, double length, double* scratch) {
  if (steps_++ % k_interval == 0) measure(dynamics, t, y, dy, length, scratch);
}

// The rounding error of a position is that of the sum of coordinate and lever arm; that of an angle is the error of a direction, whose
// components are of size 1.
void RateRounding::measure(Dynamics& dynamics, double t, const double* y, const double* dy, double length, double* scratch) {
  const int n = dynamics.dimension();
  coordinates_ = dynamics.coordinate_count();
  double* const rounded = scratch;
  double* const rate = scratch + n;
  for (int i = 0; i < n; ++i) {
    const double lever = i >= coordinates_ ? 0.0 : (dynamics.layout().scales[i].is_place ? length : 1.0);
    rounded[i] = y[i] + next_sign(signs_) * k_rounding * (std::abs(y[i]) + lever);
  }
  dynamics.rates(t, rounded, rate);
  for (int i = 0; i < n; ++i) {
    const double change = std::abs(rate[i] - dy[i]);
    if (std::isfinite(change)) size_[i] = std::max(size_[i], change);
  }
  is_known_ = true;
}

} // namespace steplap
