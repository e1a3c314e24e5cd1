// Releases a machine with such strong damping that it creeps, and finds where it comes to rest.
//
// Implicit time steps (time_stepping.h), each starting from zero velocity:
//   M Δq = h² (Q(q₁) + Jᵀλ + Hᵀw),   w in the admissible sets of friction, at the boundary if it slides.
// The machine follows its forces like a strongly damped one. Contacts close and open, and friction sticks or slides as the load requires.
// Time is constant: loads, drives and clamping pressures are those of the state. Steps grow while bodies move little, and become Newton
// steps at the end. Gaps are monitored (clearance.h). If friction holds the final rest, another path would have led to another rest.
//
// A load that grows slowly moves its machine like that (ramped_rest.h): each of its increments ends where the machine creeps to.
#pragma once

#include "mbd/rest/landscape.h"
#include "mbd/system/system.h"

#include <optional>

namespace steplap {

struct Settling {
  std::optional<State> rest; ///< final state; empty if the machine does not come to rest, or not within the limit of work
  int steps = 0;
  bool is_tried = true;           ///< false: the model is too large
  std::optional<MotionPart> away; ///< largest displacement, if the machine has left the reach of settle_near()
};

/// Runs from `start`, with drives held and zero velocities. The limit of work is a number of steps.
[[nodiscard]] Settling settle_in_time(const System& system, const State& start);
/// The same for a small change of the loads. Ends when a body has moved further than `reach`, in sizes of the model and rad. Friction that
/// slips in `start` or slides on the way keeps its kinetic coefficient until it stops.
[[nodiscard]] Settling settle_near(const System& system, const State& start, double reach);

} // namespace steplap
