// Inspects the conditioned signal of a record before the search for shocks: largest value of each axis, and whether the record begins or
// ends during a shock.
#pragma once

#include "transformer/recorder/conditioner.h"
#include "transformer/recorder/running_mean.h"

#include <array>
#include <cstddef>
#include <vector>

namespace steplap::assess {

/// Receives the conditioned signal.
class SignalWatch : public SignalSink {
public:
  /// A record begins or ends during a shock if the first or last 50 ms of a segment exceed `level`, m/s², or are at least five times as
  /// large as the half second next to them, unless their outermost 20 ms are at rest.
  explicit SignalWatch(double level) : level_(level) {}

  /// A begin or end of a segment during a shock.
  struct End {
    bool is_begin = true;
    double t = 0.0, value = 0.0; ///< time of the end, s; largest value near it, m/s²
    char axis = 'x';
    std::size_t count = 0; ///< number of such ends in the record; 0: none
  };
  /// Returns the first begin or end during a shock, with their number.
  [[nodiscard]] const End& first_end() const { return end_; }
  /// Returns the largest magnitude of each axis, filtered, m/s².
  [[nodiscard]] const std::array<double, 3>& greatest() const { return greatest_; }
  /// Returns the largest magnitude of each axis in the mean over about 0.2 s (RunningMean), m/s².
  [[nodiscard]] const std::array<double, 3>& sustained() const { return sustained_; }

  void begin(const RecordLayout& layout, double rate) override;
  void begin_segment(std::size_t line) override;
  void put(double t, const double* plain, const double* filtered) override;
  void end_segment() override;

private:
  [[nodiscard]] double largest(std::size_t axis, std::size_t from, std::size_t to) const;
  void inspect(bool is_begin);
  double level_;
  std::size_t axes_ = 0;
  std::size_t edge_ = 0, near_ = 0; ///< lengths in samples: of an end; of an end and the interval next to it
  std::array<char, 3> letters_{};
  std::array<double, 3> greatest_{}, sustained_{};
  std::array<RunningMean, 3> means_;
  double rate_ = 0.0;
  std::vector<std::array<double, 3>> last_; ///< ring buffer of the last `near_` samples of the segment
  std::size_t samples_ = 0;
  double begin_ = 0.0, t_ = 0.0;
  End end_;
};

} // namespace steplap::assess
