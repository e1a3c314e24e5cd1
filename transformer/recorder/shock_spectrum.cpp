#include "transformer/recorder/shock_spectrum.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

double shock_response(std::span<const double> samples, double rate, double frequency, double quality) {
  // Ramp-invariant filter: y_n = b0 x_n + b1 x_{n-1} + b2 x_{n-2} + 2 C y_{n-1} − E² y_{n-2}; E = exp(−ζ ω T), C = E cos ω_d T, S = E
  // sin(ω_d T)/(ω_d T)
  const double damping = 0.5 / quality, turn = 2.0 * std::numbers::pi * frequency / rate,
               damped = turn * std::sqrt(1.0 - damping * damping);
  const double decay = portable::pow(std::numbers::e, -damping * turn);
  const portable::SinCos angle = portable::sin_cos(damped);
  const double c = decay * angle.cos, s = decay * angle.sin / damped, e2 = decay * decay;
  const double b0 = 1.0 - s, b1 = 2.0 * (s - c), b2 = e2 - s;
  double x1 = 0.0, x2 = 0.0, y1 = 0.0, y2 = 0.0, greatest = 0.0;
  const std::size_t after = static_cast<std::size_t>(std::ceil(rate / frequency)) + 1;
  for (std::size_t i = 0; i < samples.size() + after; ++i) {
    const double x = i < samples.size() ? samples[i] : 0.0;
    const double y = b0 * x + b1 * x1 + b2 * x2 + 2.0 * c * y1 - e2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = y;
    greatest = std::max(greatest, std::abs(y));
  }
  return greatest;
}

std::vector<ShockPoint> shock_spectrum(std::span<const double> samples, double rate, double quality) {
  std::vector<ShockPoint> points;
  if (samples.size() < 2) return points;
  const double lowest = std::max(1.0, rate / static_cast<double>(samples.size()));
  for (int k = 0;; ++k) {
    const double frequency = lowest * portable::pow(2.0, k / 12.0);
    if (frequency > 0.1 * rate) return points;
    points.push_back({frequency, shock_response(samples, rate, frequency, quality)});
  }
}

} // namespace steplap
