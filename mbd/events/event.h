// Entries of the event list of a run.
#pragma once

#include "mbd/base/event_kind.h"

#include <string>

namespace steplap {

/// One entry of the event list.
struct Event {
  double t = 0.0;
  std::string element;
  EventKind kind = EventKind::none;
  std::string detail = {};     ///< additional text after the words of the kind; mostly empty
  double located_within = 0.0; ///< uncertainty of t, s: the event happened at most this long before t; 0 for events located by root finding

  /// Returns the text of the event for output, such as "slips forward". Not for comparisons.
  [[nodiscard]] std::string words() const { return words_of(kind) + (detail.empty() ? std::string() : " " + detail); }
  /// Returns true for an event at t = 0. Such an event has no error in time, and differs from a slip that begins later.
  [[nodiscard]] bool is_at_start() const { return t == 0.0; }
};

/// Rigid impact in which an element took part. Its impulse is known; a force does not exist.
struct RigidImpact {
  double t = 0.0; ///< time, s
  std::string element;
};

/// Two elements that reach their friction bounds at almost the same time: one began to slip, the other stuck close to its bound. Rounding
/// decides which one slips first.
struct SimultaneousSlip {
  double t = 0.0;     ///< time at which `slips` began to slip, s
  std::string slips;  ///< element that began to slip
  std::string sticks; ///< element that sticks before and after the event
  double share = 0.0; ///< utilisation of `sticks` just before the event
  double rate = 0.0;  ///< rate of change of that utilisation, 1/s, mean over the step before
};

} // namespace steplap
