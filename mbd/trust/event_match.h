// The events of two runs of one system, paired: what happened in one of them is looked for in the other.
//
// Events pair if the same thing happened to the same element. Of each such list the shorter is laid against the longer
// in order, so that the times differ by the least in total; what is left over has no partner. What slides from the start
// does so in both runs, or in one of them only: no slip that begins later is its partner. Nor are two events partners that lie
// apart by many times what either lasts or was waited for: then each run has another event, and its time is unknown.
#pragma once

#include "mbd/events/event_handler.h"

#include <cstddef>
#include <vector>

namespace steplap {

struct EventPair {
  std::size_t mine = 0, reference = 0; ///< places in the two lists
};

struct EventMatch {
  std::vector<EventPair> pairs;
  std::vector<std::size_t> only_mine, only_reference; ///< without a partner
};

[[nodiscard]] EventMatch match_events(const std::vector<Event>& mine, const std::vector<Event>& reference);

/// The times between an event and its partner, which one run spends before it and the other after it: what jumps at
/// events cannot be compared there.
class BetweenEvents {
public:
  BetweenEvents(const EventMatch& match, const std::vector<Event>& mine, const std::vector<Event>& reference);

  /// Or as good as at an event.
  [[nodiscard]] bool holds(double t) const;

private:
  struct Interval {
    double begin = 0.0, end = 0.0;
  };
  std::vector<Interval> intervals_; ///< in order, apart from each other
};

} // namespace steplap
