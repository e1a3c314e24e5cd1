// Shocks in a signal: where it goes beyond a threshold, with what stands before and after, and what each of them was.
#pragma once

#include "transformer/recorder/conditioner.h"

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace steplap {

struct EventRules {
  double threshold = k_default_threshold;    ///< m/s², of the filtered signal on any axis
  double before = 0.1, after = 0.3;          ///< s kept before the first and after the last sample beyond the threshold
  double merge = 0.3;                        ///< s: what follows sooner belongs to the same event
  std::optional<std::array<double, 3>> each; ///< m/s², thresholds of the axes; none: all have the one above
  double release = 1.0;                      ///< share of its threshold that each axis stays below before an event begins and after it ends
  static constexpr double k_default_threshold = 9.80665;
};

/// A stretch of signal, samples equally spaced.
struct Window {
  double rate = 0.0;                                  ///< Hz
  std::vector<double> times;                          ///< s
  std::array<std::vector<double>, 3> plain, filtered; ///< m/s²
  std::size_t lead = 0, tail = 0;                     ///< samples at its begin and end that stay below the release; none where it is cut
};

/// One axis of an event. All but the two peaks of given classes are of the filtered signal.
struct AxisEvent {
  double peak = 0.0, peak_time = 0.0;                         ///< m/s², with its sign; s
  double duration = 0.0;                                      ///< s around the peak, beyond a tenth of it
  double velocity_change = 0.0;                               ///< m/s in that time
  double frequency = 0.0;                                     ///< Hz, where most of the motion is
  double at_cfc60 = std::numeric_limits<double>::quiet_NaN(); ///< m/s², peak up to 100 Hz; NaN: the rate does not suffice
  double at_cfc10 = std::numeric_limits<double>::quiet_NaN(); ///< m/s², up to 17 Hz
};

struct ShockEvent {
  std::size_t number = 0, segment = 0; ///< from 1
  std::size_t line = 0;                ///< of the file, where its segment begins
  double begin = 0.0, end = 0.0;       ///< s
  std::size_t worst = 0;               ///< axis of the greatest peak
  bool goes_on = false;                ///< longer than a window may be: the next event is its continuation
  std::vector<AxisEvent> axes;
};

/// What an event was, from its window.
[[nodiscard]] ShockEvent describe_event(const Window& window, std::size_t axes);

/// Finds events in a signal as it comes, in bounded memory.
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
  bool is_inside_ = false, is_event_ = false; ///< beyond the release; beyond the threshold as well
  double last_stir_ = 0.0;
  std::size_t used_ = 0, stirred_ = 0; ///< samples of the window that belong to the event; up to the last beyond the release
  Window window_;
};

} // namespace steplap
