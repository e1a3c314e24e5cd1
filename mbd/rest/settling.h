// Where a machine comes to rest that is let go and damped until it creeps.
//
// Implicit time steps (time_stepping.h), each begun with nothing moving:
//   M Δq = h² (Q(q₁) + Jᵀλ + Hᵀw),   w in the friction's sets and at their borders where it slides.
// So the machine gives way along its forces as a strongly damped one does, contacts close and open, and friction holds or
// slides as the load comes. Time stands still: loads, drives and clamping pressures are those of the state. Steps grow as long as they move bodies
// a little, and become Newton's towards the end. A step passes no gap unseen (clearance.h).
//
// Where friction holds at the end, other ways there would have ended in other rests.
#pragma once

#include "mbd/rest/tangent.h"
#include "mbd/system/system.h"

#include <optional>

namespace steplap {

struct Settling {
  std::optional<State> rest; ///< nothing where the machine goes on, or the work was too much
  int steps = 0;
  bool is_tried = true; ///< false: too large a scene
};

/// From `start`, in which drives are held and nothing moves. The work is bounded by counted steps.
[[nodiscard]] Settling settle_in_time(const System& system, const State& start);

} // namespace steplap
