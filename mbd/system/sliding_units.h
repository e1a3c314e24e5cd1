// Units whose modes say of a contact and of its friction at once: where the contact closes, its friction may slide from there.
#pragma once

#include "mbd/base/event_kind.h"
#include "mbd/system/roles.h"

namespace steplap {

/// A role that a ForceGroup may have besides.
class SlidingUnits {
public:
  SlidingUnits() = default;
  SlidingUnits(const SlidingUnits&) = delete;
  SlidingUnits& operator=(const SlidingUnits&) = delete;
  virtual ~SlidingUnits() = default;

  /// How its friction slides in this mode: an event that would begin it; none: it does not.
  [[nodiscard]] virtual EventKind sliding_in(UnitMode mode) const = 0;
};

/// How the friction of a unit of `group` slides in a mode; none: it does not, or has none of its own.
[[nodiscard]] inline EventKind sliding_of(const ForceGroup& group, UnitMode mode) {
  const auto* const sliding = dynamic_cast<const SlidingUnits*>(&group);
  return sliding ? sliding->sliding_in(mode) : EventKind::none;
}

} // namespace steplap
