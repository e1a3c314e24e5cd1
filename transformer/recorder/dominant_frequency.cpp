#include "transformer/recorder/dominant_frequency.h"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numeric>
#include <vector>

namespace steplap {

double dominant_frequency(std::span<const double> samples, double rate) {
  if (samples.size() < 8) return 0.0;
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  std::size_t length = 16;
  while (length < 4 * samples.size()) length *= 2; // zero padding makes the spectral lines four times denser
  std::vector<double> in(length, 0.0);
  std::transform(samples.begin(), samples.end(), in.begin(), [&](double x) { return x - mean; });
  std::vector<std::complex<double>> out;
  Eigen::FFT<double> transform; // Eigen's own FFT (KissFFT)
  transform.fwd(out, in);
  const auto size_at = [&](std::size_t k) { return std::sqrt(std::norm(out[k])); };
  std::size_t best = 1;
  for (std::size_t k = 2; k < length / 2; ++k)
    if (size_at(k) > size_at(best)) best = k;
  const double before = size_at(best - 1), here = size_at(best), after = size_at(best + 1), bend = before - 2.0 * here + after;
  const double shift = bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
  const double scale =
      std::max(std::abs(*std::max_element(samples.begin(), samples.end())), std::abs(*std::min_element(samples.begin(), samples.end())));
  if (here <= 1e-12 * scale * static_cast<double>(samples.size())) return 0.0;
  return (static_cast<double>(best) + shift) * rate / static_cast<double>(length);
}

} // namespace steplap
