// Detects an interval in which the noise of a recorder's axis is missing: the axis was stuck or toggled between a few values, or the
// recorder did not record.
//
// A row repeats if its value equals one of the `near` values before it. Noise with the standard deviation σ, in steps of the converter,
// repeats with a probability of about 1 − exp(−0.28 near/σ). Real noise never stops, so an interval in which nearly all rows repeat,
// between intervals with noise, was not measured. σ is estimated where the signal is white, that is at rest. If the steps are as coarse as
// the noise, or if there are many such intervals, they cannot be distinguished from rest and are not reported.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace steplap::assess {

/// Inspects the samples of one axis as read from the file.
class NoiseWatch {
public:
  /// `near`: number of preceding values with which a row is compared, 1 to 15. 1 detects constant values; larger numbers detect toggling
  /// between a few values.
  explicit NoiseWatch(std::size_t near) : near_(near) {}

  /// Adds a sample.
  void put(double t, double value);
  /// Must be called after the last sample.
  void finish();

  struct Silence {
    double from = 0.0, to = 0.0;        ///< begin and end of the interval, s
    double least = 0.0, greatest = 0.0; ///< smallest and largest value in the interval, in the unit of put()
    std::size_t rows = 0, repeats = 0;
  };
  /// Returns the longest interval without noise that is too long to occur by chance (probability below 1e-6); nothing if there is none.
  /// `step`: smallest change of the value.
  [[nodiscard]] std::optional<Silence> silence(double step) const;

private:
  [[nodiscard]] double value_before(std::size_t rows) const { return values_[(rows_ - rows) % k_kept]; }
  void take_block(double value);
  void begin_silence();
  void end_silence(int repeats_after);
  static constexpr std::size_t k_kept = 16;
  std::size_t near_;
  std::array<double, k_kept> times_{}, values_{}; ///< times and values of the last rows
  std::uint64_t history_ = 0;                     ///< one bit for each of the last 64 rows, 1 if it repeats; the last row is the lowest bit
  std::size_t rows_ = 0, repeats_ = 0, all_silent_ = 0;
  struct Block { ///< sums over the rows of a block: values minus the first one, their squares, and squared second differences
    double first = 0.0, sum = 0.0, squares = 0.0, second_differences = 0.0;
    std::size_t rows = 0;
  };
  Block block_;
  std::vector<double> deviations_; ///< standard deviations of every `stride_`-th white block
  std::size_t stride_ = 1, blocks_ = 0;
  bool is_silent_ = false; ///< true while `now_` is an interval without noise
  int repeats_before_ = 0, rows_after_ = 0;
  Silence now_, longest_;
};

} // namespace steplap::assess
