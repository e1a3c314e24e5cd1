// Pairs the events of two runs of one system.
//
// Two events can be partners if the same kind of event happened to the same element. The shorter list is assigned to the longer one in
// order, with the least sum of time differences; the rest stays without partner. Slip from the start (t = 0) is only paired with slip from
// the start. Events are not partners if they are much further apart than the time to the neighbouring events of the element: each run then
// has an event that the other lacks.
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
  std::vector<std::size_t> only_mine, only_reference; ///< indices of events without partner
};

[[nodiscard]] EventMatch match_events(const std::vector<Event>& mine, const std::vector<Event>& reference);

/// Times between an event and its partner. In them one run is before the event and the other one after it, so quantities that jump at
/// events cannot be compared.
class BetweenEvents {
public:
  BetweenEvents(const EventMatch& match, const std::vector<Event>& mine, const std::vector<Event>& reference);

  /// Returns true if t lies in such an interval or, up to rounding, at an event.
  [[nodiscard]] bool holds(double t) const;

private:
  struct Interval {
    double begin = 0.0, end = 0.0;
  };
  std::vector<Interval> intervals_; ///< sorted, disjoint
};

} // namespace steplap
