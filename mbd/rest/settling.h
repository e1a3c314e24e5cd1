// Simulates a machine with such strong damping that it creeps, to find where it comes to rest.
//
// Implicit time steps (time_stepping.h), each of which starts from zero velocity:
//   M Δq = h² (Q(q₁) + Jᵀλ + Hᵀw),   w in the admissible sets of friction, at the boundary if it slides.
// Contacts close and open, and friction sticks or slides, as the load requires. Time does not advance: loads, drives and clamping pressures
// are those of the state. Steps grow while bodies move little, and become Newton steps at the end. Gaps are monitored (clearance.h). A
// final rest that friction holds depends on the path; another path would have led to another rest.
#pragma once

#include "mbd/rest/tangent.h"
#include "mbd/system/system.h"

#include <optional>

namespace steplap {

struct Settling {
  std::optional<State> rest; ///< final state; nothing if the machine does not come to rest, or not within the allowed number of steps
  int steps = 0;
  bool is_tried = true; ///< false: the model is too large, and nothing was simulated
};

/// Simulates from `start`, with drives held and velocities zero. The number of steps is limited.
[[nodiscard]] Settling settle_in_time(const System& system, const State& start);

} // namespace steplap
