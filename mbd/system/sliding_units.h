// Units whose mode describes both a contact and its friction, so that the friction may start to slide when the contact closes.
#pragma once

#include "mbd/base/event_kind.h"
#include "mbd/system/roles.h"

namespace steplap {

/// Additional interface of a ForceGroup whose modes include friction.
class SlidingUnits {
public:
  SlidingUnits() = default;
  SlidingUnits(const SlidingUnits&) = delete;
  SlidingUnits& operator=(const SlidingUnits&) = delete;
  virtual ~SlidingUnits() = default;

  /// Returns the event that is reported when sliding begins in this mode, such as `slips_forward`; `none` if the mode does not slide.
  [[nodiscard]] virtual EventKind sliding_in(UnitMode mode) const = 0;
};

/// Returns SlidingUnits::sliding_in() for a unit of any group; `none` if its modes do not include friction.
[[nodiscard]] inline EventKind sliding_of(const ForceGroup& group, UnitMode mode) {
  const auto* const sliding = dynamic_cast<const SlidingUnits*>(&group);
  return sliding ? sliding->sliding_in(mode) : EventKind::none;
}

} // namespace steplap
