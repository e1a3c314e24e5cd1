// From samples as they were read to a signal at a constant rate: offset, resampling that keeps its shape, high-pass and low-pass without
// phase shift.
//
// The high-pass is what a Butterworth low-pass of two poles, run forwards and backwards, leaves out: 1 − 1/(1 + r⁴) = r⁴/(1 + r⁴) is the
// gain of the high-pass of the same kind, r the ratio of (warped) frequencies.
//
// Works in blocks, in bounded memory. Samples that lie on the grid of the rate are taken as they are, time and value; between others the
// signal is the monotone cubic of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5 (1984) 300), which has no peak that the samples
// do not have.
#pragma once

#include "transformer/recorder/filter.h"
#include "transformer/recorder/reader.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace steplap {

/// Takes the conditioned signal.
class SignalSink {
public:
  virtual ~SignalSink() = default;
  virtual void begin(const RecordLayout& layout, double rate) = 0;
  virtual void begin_segment(std::size_t line) = 0;
  /// t in s; m/s² for each axis, before and after the filter (the same without one).
  virtual void put(double t, const double* plain, const double* filtered) = 0;
  virtual void end_segment() = 0;
};

struct Conditioning {
  std::array<double, 3> offset{};                     ///< m/s², subtracted from the axes
  std::optional<double> frequency_class;              ///< CFC in Hz; none: no filter
  std::optional<double> rate;                         ///< Hz of the result; none: that of the record
  std::optional<double> high_pass;                    ///< Hz, where its gain is 1/√2; none: none
  std::vector<std::array<double, 3>> segment_offsets; ///< m/s², subtracted from one segment each; none: nothing is
};

/// What the conditioned acceleration, integrated by itself from rest, would have made of a segment.
struct Drift {
  double duration = 0.0;                ///< s, of the longest segment
  std::array<double, 3> velocity{};     ///< m/s at its end
  std::array<double, 3> displacement{}; ///< m
};

class Conditioner : public SampleSink {
public:
  Conditioner(const Conditioning& conditioning, SignalSink& sink) : conditioning_(conditioning), sink_(sink) {}

  /// Throws RecordError if the rate does not suffice for the class, or is too high for the high-pass.
  void begin(const RecordLayout& layout) override;
  void begin_segment(std::size_t line) override;
  void put(double t, const double* a) override;
  void end_segment() override;

  [[nodiscard]] double rate() const { return rate_; }
  /// Hz up to which the signal is meant: the filter's, else half of the rate.
  [[nodiscard]] double bandwidth() const { return filter_ ? filter_->bandwidth() : 0.5 * rate_; }
  /// Samples of the result that lie between those of the record.
  [[nodiscard]] std::size_t interpolated() const { return interpolated_; }
  [[nodiscard]] const Drift& drift() const { return drift_; }
  /// Of each segment the constant acceleration, m/s², without which its velocity ends where it began.
  [[nodiscard]] const std::vector<std::array<double, 3>>& segment_means() const { return means_; }

private:
  struct Row {
    double t = 0.0;
    std::array<double, 3> a{};
  };
  void fill(bool is_end);
  void add(double t, const std::array<double, 3>& a);
  void flush(bool is_end);
  void integrate(double t, const double* a);
  [[nodiscard]] double slope(std::size_t i, std::size_t axis) const;

  Conditioning conditioning_;
  SignalSink& sink_;
  void set_high_pass(const RecordLayout& layout);
  std::optional<ChannelFilter> filter_, low_; ///< low_: what the high-pass takes away
  std::size_t axes_ = 0, margin_ = 0, lead_ = 0, interpolated_ = 0, segment_ = 0;
  double rate_ = 0.0;
  std::vector<Row> rows_; ///< of the record, few
  std::size_t next_ = 0;  ///< of the grid
  double start_ = 0.0;
  std::vector<double> times_; ///< of the grid, waiting for the filter
  std::array<std::vector<double>, 3> plain_, filtered_;
  Drift drift_, now_;
  std::vector<std::array<double, 3>> means_;
  std::optional<Row> before_;
  double began_ = 0.0;
};

} // namespace steplap
