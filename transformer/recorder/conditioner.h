// Converts samples as read to a signal with constant rate: offset, shape-preserving resampling, and high-pass and low-pass filters without
// phase shift.
//
// The high-pass is the signal minus a two-pole Butterworth low-pass that is applied forwards and backwards: its gain is 1 − 1/(1 + r⁴) =
// r⁴/(1 + r⁴), which is that of a Butterworth high-pass applied in the same way, with r the ratio of the (warped) frequencies.
//
// Works in blocks with bounded memory. Samples on the time grid of the result are kept unchanged. Between samples the signal is the
// monotone cubic interpolant of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5 (1984) 300), which adds no peaks.
#pragma once

#include "transformer/recorder/filter.h"
#include "transformer/recorder/reader.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace steplap {

/// Receives the conditioned signal.
class SignalSink {
public:
  virtual ~SignalSink() = default;
  virtual void begin(const RecordLayout& layout, double rate) = 0;
  virtual void begin_segment(std::size_t line) = 0;
  /// Receives a sample: t, s; acceleration of each axis, m/s², before and after the filter (equal without a filter).
  virtual void put(double t, const double* plain, const double* filtered) = 0;
  virtual void end_segment() = 0;
};

/// Parameters of the conditioning.
struct Conditioning {
  std::array<double, 3> offset{};                     ///< offsets that are subtracted from the axes, m/s²
  std::optional<double> frequency_class;              ///< channel frequency class (CFC), Hz; none: no filter
  std::optional<double> rate;                         ///< sampling rate of the result, Hz; none: that of the record
  std::optional<double> high_pass;                    ///< frequency at which the gain of the high-pass is 1/√2, Hz; none: no high-pass
  std::vector<std::array<double, 3>> segment_offsets; ///< offsets that are subtracted from each segment, m/s²; empty: none
};

/// Velocity and displacement from integrating the conditioned acceleration of a segment, starting at rest.
struct Drift {
  double duration = 0.0;                ///< duration of the longest segment, s
  std::array<double, 3> velocity{};     ///< velocity at the end of the segment, m/s
  std::array<double, 3> displacement{}; ///< displacement at the end of the segment, m
};

/// Receives samples as read and passes the conditioned signal to a sink.
class Conditioner : public SampleSink {
public:
  Conditioner(const Conditioning& conditioning, SignalSink& sink) : conditioning_(conditioning), sink_(sink) {}

  /// Throws RecordError if the sampling rate is too low for the frequency class or too high for the high-pass.
  void begin(const RecordLayout& layout) override;
  void begin_segment(std::size_t line) override;
  void put(double t, const double* a) override;
  void end_segment() override;

  /// Returns the sampling rate of the result, Hz.
  [[nodiscard]] double rate() const { return rate_; }
  /// Returns the highest frequency that the signal represents, Hz: that of the filter, otherwise half the sampling rate.
  [[nodiscard]] double bandwidth() const { return filter_ ? filter_->bandwidth() : 0.5 * rate_; }
  /// Returns the number of samples of the result that are interpolated.
  [[nodiscard]] std::size_t interpolated() const { return interpolated_; }
  [[nodiscard]] const Drift& drift() const { return drift_; }
  /// Returns the mean acceleration of each segment, m/s². If it is subtracted, the velocity at the end of the segment equals that at its
  /// begin.
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
  std::optional<ChannelFilter> filter_, low_; ///< `low_`: low-pass whose output is subtracted by the high-pass
  std::size_t axes_ = 0, margin_ = 0, lead_ = 0, interpolated_ = 0, segment_ = 0;
  double rate_ = 0.0;
  std::vector<Row> rows_; ///< rows of the record that interpolation still needs
  std::size_t next_ = 0;  ///< index of the next sample on the time grid of the result
  double start_ = 0.0;
  std::vector<double> times_; ///< grid times of samples that the filter still needs
  std::array<std::vector<double>, 3> plain_, filtered_;
  Drift drift_, now_;
  std::vector<std::array<double, 3>> means_;
  std::optional<Row> before_;
  double began_ = 0.0;
};

} // namespace steplap
