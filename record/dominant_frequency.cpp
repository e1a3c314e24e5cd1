#include "record/dominant_frequency.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <numeric>

namespace steplap {

namespace {

struct FreeMemory {
  void operator()(void* memory) const { fftw_free(memory); }
};

} // namespace

double dominant_frequency(std::span<const double> samples, double rate) {
  if (samples.size() < 8) return 0.0;
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  std::size_t length = 16;
  while (length < 4 * samples.size()) length *= 2; // zeros after it: lines lie four times as close
  const std::unique_ptr<double, FreeMemory> in(fftw_alloc_real(length));
  const std::unique_ptr<fftw_complex, FreeMemory> out(fftw_alloc_complex(length / 2 + 1));
  static std::mutex mutex; // making and freeing plans shares memory
  fftw_plan plan = nullptr;
  {
    const std::lock_guard lock(mutex);
    // Estimated, not measured, and without the instructions of this processor: the same bits on every machine.
    plan = fftw_plan_dft_r2c_1d(static_cast<int>(length), in.get(), out.get(), FFTW_ESTIMATE | FFTW_NO_SIMD);
  }
  for (std::size_t i = 0; i < length; ++i) in.get()[i] = i < samples.size() ? samples[i] - mean : 0.0;
  fftw_execute(plan);
  const auto size_at = [&](std::size_t k) { return std::sqrt(out.get()[k][0] * out.get()[k][0] + out.get()[k][1] * out.get()[k][1]); };
  std::size_t best = 1;
  for (std::size_t k = 2; k < length / 2; ++k)
    if (size_at(k) > size_at(best)) best = k;
  const double before = size_at(best - 1), here = size_at(best), after = size_at(best + 1), bend = before - 2.0 * here + after;
  const double shift = bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
  {
    const std::lock_guard lock(mutex);
    fftw_destroy_plan(plan);
  }
  const double scale = std::max(std::abs(*std::max_element(samples.begin(), samples.end())), std::abs(*std::min_element(samples.begin(), samples.end())));
  if (here <= 1e-12 * scale * static_cast<double>(samples.size())) return 0.0;
  return (static_cast<double>(best) + shift) * rate / static_cast<double>(length);
}

} // namespace steplap
