// Pairs the events of two runs of one system.
//
// Two events can be paired if the same kind of event happened to the same element. The events of the run with fewer of them are assigned to
// those of the other, in order and with the least sum of time differences; the others stay unpaired. Slip from the start (t = 0) is paired
// only with slip from the start. Two events are not paired if their time difference is much larger than the times to neighbouring events of
// the element: each run then has an event that the other lacks.
#pragma once

#include "mbd/events/event.h"

#include <cstddef>
#include <vector>

namespace steplap {

struct EventPair {
  std::size_t mine = 0, reference = 0; ///< indices in the two lists
};

struct EventMatch {
  std::vector<EventPair> pairs;
  std::vector<std::size_t> only_mine, only_reference; ///< indices of unpaired events
};

[[nodiscard]] EventMatch match_events(const std::vector<Event>& mine, const std::vector<Event>& reference);

/// The intervals between paired events. Within them one run is before the event and the other one after it, so quantities that jump at
/// events cannot be compared.
class BetweenEvents {
public:
  BetweenEvents(const EventMatch& match, const std::vector<Event>& mine, const std::vector<Event>& reference);

  /// Returns true if t lies between two paired events, or at an event up to rounding.
  [[nodiscard]] bool holds(double t) const;

private:
  struct Interval {
    double begin = 0.0, end = 0.0;
  };
  std::vector<Interval> intervals_; ///< sorted, disjoint
};

} // namespace steplap
