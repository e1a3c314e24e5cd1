// Channel frequency classes of ISO 6487 and SAE J211: a Butterworth filter of two poles, run forwards and backwards, so that there are
// four poles and no phase shift.
//
// The gain at f is 1/(1 + (tan(π f/fs)/tan(π f0/fs))⁴), f0 = 2.0775 CFC, fs the rate of sampling: −3 dB near 1.667 CFC. Before the first and
// after the last sample the signal is taken to stay as it is there.
#pragma once

#include <span>

namespace steplap {

class ChannelFilter {
public:
  static constexpr double k_ratio = 2.0775; ///< f0 / CFC, SAE J211-1 appendix C: where the gain is 1/2

  /// `frequency_class` in Hz, as in "CFC 60"; needs a rate of ten times that at least (ISO 6487). Throws std::invalid_argument.
  ChannelFilter(double frequency_class, double rate);

  /// In place, forwards and backwards.
  void apply(std::span<double> samples) const;
  /// Where the gain is 1/√2, Hz.
  [[nodiscard]] double bandwidth() const { return bandwidth_; }
  /// Samples after which what came before has died away to 1e-12.
  [[nodiscard]] int settling() const { return settling_; }
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
