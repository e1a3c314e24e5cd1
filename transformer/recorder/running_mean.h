// Mean of a signal over about 0.2 s, in which a shock counts by its change of velocity and braking by its strength.
#pragma once

#include <cmath>

namespace steplap {

/// Exponentially weighted mean of equidistant samples; the signal is zero before the first.
class RunningMean {
public:
  static constexpr double k_time = 0.2; ///< time constant, s: ten times shorter than braking
  /// Adds a sample of a signal with `rate` samples per second and returns the mean.
  double put(double sample, double rate) { return mean_ += (sample - mean_) * -std::expm1(-1.0 / (k_time * rate)); }

private:
  double mean_ = 0.0;
};

} // namespace steplap
