// Simulates a machine with such strong damping that it creeps, to find where it comes to rest.
//
// Implicit time steps (time_stepping.h), each of which starts from zero velocity:
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
  std::optional<State> rest; ///< final state; nothing if the machine does not come to rest, or not within the allowed number of steps
  int steps = 0;
  bool is_tried = true;           ///< false: the model is too large, and nothing was simulated
  std::optional<MotionPart> away; ///< largest displacement, if the machine has left the reach of settle_near()
};

/// Simulates from `start`, with drives held and velocities zero. The number of steps is limited.
[[nodiscard]] Settling settle_in_time(const System& system, const State& start);
/// The same for a small change of the loads. Ends when a body has moved further than `reach`, in sizes of the model and rad. Friction that
/// slips in `start` or slides on the way keeps its kinetic coefficient until it stops.
[[nodiscard]] Settling settle_near(const System& system, const State& start, double reach);

} // namespace steplap
