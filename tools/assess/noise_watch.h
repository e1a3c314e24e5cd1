// Detects the stretch in which an axis of a recorder lost its noise: it was stuck, toggled between a few values, or the recorder stood still.
//
// A row repeats if its value is one of the `near` values before it. Noise of standard deviation σ, in steps of the converter, repeats with
// a probability of about 1 − exp(−0.28 near/σ). Noise never stops: a stretch in which nearly all rows repeat, between rows with noise, was not
// measured. σ is found where the signal is white, that is at rest. If the steps are as coarse as the noise, or if the record has many such
// stretches, they cannot be told from rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace steplap::assess {

/// Receives the samples of one axis as read.
class NoiseWatch {
public:
  /// `near`: number of values that a row is compared with, at most 15. 1 finds constant values, more of them few values.
  explicit NoiseWatch(std::size_t near) : near_(near) {}

  /// Adds a sample.
  void put(double t, double value);
  /// Must be called after the last sample.
  void finish();

  struct Silence {
    double from = 0.0, to = 0.0;        ///< s
    double least = 0.0, greatest = 0.0; ///< values in it, as given
    std::size_t rows = 0, repeats = 0;
  };
  /// Returns the longest stretch without noise; nothing if there is none that noise would hardly make by chance. `step`: smallest change of
  /// the value.
  [[nodiscard]] std::optional<Silence> silence(double step) const;

private:
  [[nodiscard]] double value_before(std::size_t rows) const { return values_[(rows_ - rows) % k_kept]; }
  void take_block(double value);
  void open();
  void close(int repeats_after);
  static constexpr std::size_t k_kept = 16;
  std::size_t near_;
  std::array<double, k_kept> times_{}, values_{}; ///< of the last rows
  std::uint64_t history_ = 0;                     ///< a bit for each of the last 64 rows, the latest lowest: 1 if it repeats
  std::size_t rows_ = 0, repeats_ = 0, all_silent_ = 0;
  struct Block { ///< sums over some rows of the values, less the first, their squares and the squares of the second differences
    double first = 0.0, sum = 0.0, squares = 0.0, bends = 0.0;
    std::size_t rows = 0;
  };
  Block block_;
  std::vector<double> deviations_; ///< standard deviations of every `stride_`-th white block
  std::size_t stride_ = 1, blocks_ = 0;
  bool is_open_ = false;
  int repeats_before_ = 0, rows_after_ = 0;
  Silence now_, longest_;
};

} // namespace steplap::assess
