// Finds shocks in a signal: intervals above a threshold, with some time before and after. Computes their characteristics.
#pragma once

#include "transformer/recorder/conditioner.h"
#include "transformer/recorder/running_mean.h"

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace steplap {

/// Rules by which events are found.
struct EventRules {
  double threshold = k_default_threshold;    ///< threshold for the filtered signal on any axis, m/s²
  double before = 0.1, after = 0.3;          ///< time kept before the first and after the last sample above the threshold, s
  double merge = 0.3;                        ///< time, s, within which a new exceedance belongs to the same event
  std::optional<std::array<double, 3>> each; ///< thresholds of single axes, m/s²; none: `threshold` for all
  double release = 1.0; ///< fraction of its threshold below which each axis must be before an event begins and after it ends
  /// Level of an axis's mean (RunningMean) that is an event as well, m/s²: braking that pushes for seconds moves more than a short peak.
  std::array<double, 3> sustained{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<double>::infinity()};
  static constexpr double k_default_threshold = 9.80665;
};

/// An interval of the signal with equidistant samples.
struct Window {
  double rate = 0.0;                                  ///< sampling rate, Hz
  std::vector<double> times;                          ///< times of the samples, s
  std::array<std::vector<double>, 3> plain, filtered; ///< acceleration before and after the filter, m/s²
  std::size_t lead = 0, tail = 0; ///< number of samples below the release level at the begin and at the end; 0 where the window was cut
};

/// One axis of an event. Values refer to the filtered signal, except the two peaks with given frequency class.
struct AxisEvent {
  double peak = 0.0, peak_time = 0.0; ///< largest magnitude with its sign, m/s²; its time, s
  double duration = 0.0;              ///< duration of the interval around the peak above a tenth of it, s
  double velocity_change = 0.0;       ///< integral of the acceleration over that interval, m/s
  double largest_change = 0.0;        ///< largest change of the velocity within any second of the event, m/s; at least that of the peak
  double frequency = 0.0;             ///< frequency of the swings around the peak, Hz (dominant_frequency.h)
  /// Peak with CFC 60 (up to 100 Hz), m/s²; NaN if the sampling rate is too low.
  double at_cfc60 = std::numeric_limits<double>::quiet_NaN();
  double at_cfc10 = std::numeric_limits<double>::quiet_NaN(); ///< peak with CFC 10 (up to 17 Hz), m/s²
};

/// A shock.
struct ShockEvent {
  std::size_t number = 0, segment = 0; ///< counted from 1
  std::size_t line = 0;                ///< line of the file at which the segment begins
  double begin = 0.0, end = 0.0;       ///< begin and end, s
  std::size_t worst = 0;               ///< index of the axis with the largest peak
  bool goes_on = false;                ///< the event was cut at the longest window; the next event continues it
  std::vector<AxisEvent> axes;
};

/// Computes the characteristics of an event from its window.
[[nodiscard]] ShockEvent describe_event(const Window& window, std::size_t axes);

/// Finds events in a signal that arrives sample by sample, with bounded memory.
class ShockFinder : public SignalSink {
public:
  using Found = std::function<void(const ShockEvent& event, const Window& window)>;
  ShockFinder(const EventRules& rules, Found found) : rules_(rules), found_(std::move(found)) {}

  void begin(const RecordLayout& layout, double rate) override;
  void begin_segment(std::size_t line) override;
  void put(double t, const double* plain, const double* filtered) override;
  void end_segment() override;
  [[nodiscard]] std::size_t count() const { return count_; }

private:
  void close(bool goes_on);
  void forget_all_but(std::size_t kept);

  EventRules rules_;
  Found found_;
  std::size_t axes_ = 0, kept_ = 0, count_ = 0, segment_ = 0, line_ = 0;
  std::array<double, 3> thresholds_{};
  std::array<RunningMean, 3> means_;
  bool is_inside_ = false, is_event_ = false; ///< is_inside_: above the release level; is_event_: also above the threshold
  double last_stir_ = 0.0;
  /// Number of samples of the window that belong to the event; number up to the last one above the release level.
  std::size_t used_ = 0, stirred_ = 0;
  Window window_;
};

} // namespace steplap
