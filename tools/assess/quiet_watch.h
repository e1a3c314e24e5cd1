// The greatest of what stays below the threshold of events: that it did nothing to the machine is shown by a run, not taken for granted.
#pragma once

#include "transformer/recorder/events.h"

#include <array>
#include <cstddef>
#include <vector>

namespace steplap::assess {

/// Of each axis the stretch around the greatest sample that belongs to no event, as long as an event's shortest window. In bounded memory.
class QuietWatch : public SignalSink {
public:
  explicit QuietWatch(const EventRules& rules) : rules_(rules) {}

  void begin(const RecordLayout& layout, double rate) override;
  void begin_segment(std::size_t line) override;
  void put(double t, const double* plain, const double* filtered) override;
  void end_segment() override;

  /// A stretch and its greatest sample.
  struct Stretch {
    double peak = -1.0; ///< m/s², without sign; below 0: there is none
    Window window;
    std::size_t segment = 0, line = 0;
  };
  /// In order of time, none of which overlaps another; the greatest first to be kept. Only those of `least` m/s² or more.
  [[nodiscard]] std::vector<Stretch> greatest(double least) const;

private:
  void look_at(std::size_t index);

  EventRules rules_;
  std::size_t axes_ = 0, before_ = 0, after_ = 0, segment_ = 0, line_ = 0;
  Window window_;           ///< the latest samples of the segment
  std::size_t dropped_ = 0; ///< samples of the segment before those
  std::size_t next_ = 0;    ///< of the segment: to be looked at
  std::array<Stretch, 3> best_;
};

} // namespace steplap::assess
