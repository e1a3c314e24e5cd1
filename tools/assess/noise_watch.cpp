#include "tools/assess/noise_watch.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace steplap::assess {

namespace {

constexpr int k_dull = 12;      // smallest number of repeating rows among the last 16 for an interval without noise
constexpr int k_side = 32;      // number of rows before and after such an interval that must contain noise
constexpr double k_often = 0.5; // largest fraction of repeating rows in an interval with noise
// largest probability of repetition at which the end of noise can be detected; noise coarser than this repeats too often
constexpr double k_fine = 0.25;
constexpr double k_mode = 1.4143;   // the most frequent value repeats √2 times as often as all do on average
constexpr double k_rarely = 0.05;   // smallest probability of repetition used, because the estimate is based on few rows
constexpr double k_chance = 1e-6;   // largest probability that noise alone causes such an interval anywhere in the record
constexpr double k_brief = 0.005;   // shortest interval, s; a shorter shock has only frequencies to which joints do not respond
constexpr std::size_t k_many = 100; // smallest number of rows for an estimate of the probability of repetition
constexpr std::size_t k_block = 16; // number of rows in a block
// a block is white noise if the mean square of its second differences exceeds this multiple of the variance: 6 for white noise, less for
// vibration below a quarter of the sampling rate
constexpr double k_white = 3.6;
constexpr std::size_t k_blocks = 4;         // smallest number of white blocks for an estimate of the noise
constexpr double k_quiet = 0.1;             // quantile of the white blocks' deviations that is used as the noise
constexpr std::size_t k_kept_blocks = 1024; // largest number of deviations kept, which limits the memory
constexpr double k_density = 0.2821;        // probability that two rows are equal, times σ in steps: 1/(2 √π)

int repeats_in(std::uint64_t history, int rows) { return std::popcount(history & ((std::uint64_t{1} << rows) - 1)); }

// Returns Chernoff's bound for the probability that at least the fraction `share` of the rows repeats, if each repeats with probability q <
// share.
double bound_of_chance(double share, double q, double rows) {
  const double rest = share < 1.0 ? (1.0 - share) * std::log((1.0 - share) / (1.0 - q)) : 0.0;
  return std::exp(-rows * (share * std::log(share / q) + rest));
}

} // namespace

void NoiseWatch::put(double t, double value) {
  bool is_repeat = false;
  for (std::size_t k = 1; k <= std::min(near_, rows_); ++k) is_repeat |= value_before(k) == value;
  if (is_silent_) block_ = {};
  else if (rows_ >= 2) take_block(value);
  times_[rows_ % k_kept] = t, values_[rows_ % k_kept] = value;
  history_ = history_ << 1U | (is_repeat ? 1U : 0U);
  ++rows_;
  repeats_ += is_repeat;
  if (repeats_in(history_, k_kept) >= k_dull) {
    if (!is_silent_) begin_silence();
    now_.to = t;
    now_.rows += 1 + static_cast<std::size_t>(rows_after_);
    now_.repeats += is_repeat;
    now_.least = std::min(now_.least, value), now_.greatest = std::max(now_.greatest, value);
    rows_after_ = 0;
  } else if (is_silent_) {
    now_.repeats += is_repeat;
    if (++rows_after_ == k_side) end_silence(repeats_in(history_, k_side));
  }
}

// Adds a value to the current block. Stores the standard deviation of each completed block of white noise; if there are too many, every
// second one is deleted.
void NoiseWatch::take_block(double value) {
  if (block_.rows == 0) block_.first = value;
  const double x = value - block_.first, second_difference = value - 2.0 * value_before(1) + value_before(2);
  block_.sum += x, block_.squares += x * x, block_.second_differences += second_difference * second_difference;
  if (++block_.rows < k_block) return;
  const double count = static_cast<double>(block_.rows), mean = block_.sum / count;
  const double variance = std::max(0.0, block_.squares / count - mean * mean);
  const bool is_white = block_.second_differences / count >= k_white * variance;
  block_ = {};
  if (!is_white || blocks_++ % stride_ != 0) return;
  deviations_.push_back(std::sqrt(variance));
  if (deviations_.size() < 2 * k_kept_blocks) return;
  for (std::size_t i = 0; i < k_kept_blocks; ++i) deviations_[i] = deviations_[2 * i];
  deviations_.resize(k_kept_blocks);
  stride_ *= 2;
}

// Starts an interval without noise at the oldest row that is still in memory.
void NoiseWatch::begin_silence() {
  const std::size_t kept = std::min(rows_, k_kept);
  now_ = {times_[(rows_ - kept) % k_kept],
          0.0,
          value_before(1),
          value_before(1),
          kept - 1,
          static_cast<std::size_t>(repeats_in(history_ >> 1U, k_kept - 1))};
  repeats_before_ = repeats_in(history_ >> k_kept, k_side);
  rows_after_ = 0;
  is_silent_ = true;
}

void NoiseWatch::end_silence(int repeats_after) {
  all_silent_ += now_.rows;
  if (std::max(repeats_before_, repeats_after) <= k_often * k_side && now_.rows > longest_.rows) longest_ = now_;
  is_silent_ = false;
}

void NoiseWatch::finish() {
  if (is_silent_) end_silence(repeats_in(history_, rows_after_));
}

std::optional<NoiseWatch::Silence> NoiseWatch::silence(double step) const {
  if (longest_.rows == 0 || rows_ - longest_.rows < k_many || longest_.to - longest_.from < k_brief) return {};
  if (all_silent_ > 2 * longest_.rows) return {};
  if (deviations_.size() < k_blocks) return {};
  std::vector<double> deviations = deviations_;
  const auto quiet = deviations.begin() + static_cast<std::ptrdiff_t>(k_quiet * static_cast<double>(deviations.size()));
  std::nth_element(deviations.begin(), quiet, deviations.end());
  const double noise = *quiet / step; // standard deviation of the noise, in steps of the converter
  if (!(1.0 - std::exp(-k_density * static_cast<double>(near_) / noise) <= k_fine)) return {};
  const auto outside = static_cast<double>(rows_ - longest_.rows);
  const double share = k_mode * static_cast<double>(repeats_ - std::min(repeats_, longest_.repeats)) / outside;
  const double silent = static_cast<double>(longest_.repeats) / static_cast<double>(longest_.rows);
  if (share > k_often || silent <= share) return {};
  const double chance = bound_of_chance(std::min(silent, 1.0), std::max(share, k_rarely), static_cast<double>(longest_.rows));
  return static_cast<double>(rows_) * chance < k_chance ? std::optional(longest_) : std::nullopt;
}

} // namespace steplap::assess
