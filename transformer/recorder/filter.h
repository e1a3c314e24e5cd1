// Channel frequency class filters of ISO 6487 and SAE J211: a two-pole Butterworth filter applied forwards and backwards, which gives four
// poles and no phase shift.
//
// The gain at frequency f is 1/(1 + (tan(π f/fs)/tan(π f0/fs))⁴) with f0 = 2.0775 CFC and the sampling rate fs; it is −3 dB near 1.667 CFC.
// The signal is extended by its first and last sample.
#pragma once

#include <span>

namespace steplap {

/// A low-pass filter of a channel frequency class.
class ChannelFilter {
public:
  static constexpr double k_ratio = 2.0775; ///< f0 / CFC, SAE J211-1 appendix C: at f0 the gain is 1/2

  /// `frequency_class`: CFC in Hz, as in "CFC 60". The sampling rate must be at least ten times larger (ISO 6487). Throws
  /// std::invalid_argument otherwise.
  ChannelFilter(double frequency_class, double rate);

  /// Filters in place, forwards and backwards.
  void apply(std::span<double> samples) const;
  /// Returns the frequency at which the gain is 1/√2, Hz.
  [[nodiscard]] double bandwidth() const { return bandwidth_; }
  /// Returns the number of samples after which the effect of earlier samples has decayed to 1e-12.
  [[nodiscard]] int settling() const { return settling_; }
  /// Returns true if the sampling rate is sufficient for the frequency class.
  [[nodiscard]] static bool is_possible(double frequency_class, double rate) {
    return frequency_class > 0.0 && rate >= 10.0 * frequency_class;
  }

private:
  template <class Iterator> void run(Iterator at, Iterator end) const;
  double a0_ = 1.0, b1_ = 0.0, b2_ = 0.0; ///< y = a0 (x + 2 x₋₁ + x₋₂) + b1 y₋₁ + b2 y₋₂
  double bandwidth_ = 0.0;
  int settling_ = 0;
};

} // namespace steplap
