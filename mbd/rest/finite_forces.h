// Error for poses in which a force has no direction, because the two ends of a rope, rod or spring coincide. The forces are then not
// numbers, and matrix decompositions may not terminate.
#pragma once

#include "mbd/rest/statics.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/system.h"

#include <cmath>

namespace steplap {

/// Returns the error; its message names the body on which a force, or a derivative of one, is not a number.
[[nodiscard]] inline ElementFailure no_direction(const System& system, const Statics& statics) {
  // The body's forces on other bodies are not numbers either, so its own diagonal entry is checked.
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
