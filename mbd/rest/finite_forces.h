// Poses in which a force has no direction: the ends of a rope, a rod or a spring meet. Nothing that follows from such
// forces is a number, and a decomposition of what is none may go on for ever.
#pragma once

#include "mbd/rest/statics.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/system.h"

#include <cmath>

namespace steplap {

/// A failure that names the body on which a force is no number, or the change of one with the pose.
[[nodiscard]] inline ElementFailure no_direction(const System& system, const Statics& statics) {
  // What a body does to others is no number either: its own share tells.
  const MatX stiffness = statics.stiffness(VecX::Zero(static_cast<Eigen::Index>(statics.rows().size())));
  Eigen::Index worst = 0;
  while (worst + 1 < stiffness.rows() && std::isfinite(statics.force()[worst]) && std::isfinite(stiffness(worst, worst))) ++worst;
  const std::string& name = system.bodies[static_cast<std::size_t>(worst / 3 + 1)].name;
  return {"no static equilibrium found: the search came to a pose in which the force on '" + name +
              "' has no direction, since two points that a rope, a spring or a contact lies between meet there (a load that is "
              "pulled up to its pulley: give it a stop before)",
          {name}};
}

} // namespace steplap
