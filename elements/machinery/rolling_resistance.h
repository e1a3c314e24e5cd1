// Rolling resistance of what presses with a round thing on another: a couple against the turning of a over b, which holds exactly at
// rest.
//
// The resultant of the pressure of a contact that rolls lies ahead of its middle by `arm`, so that it takes a couple of at most arm·N,
// N the normal force: Coulomb's law of rolling. Beside a coefficient f of rolling resistance, arm = f r. It is friction on the angle of
// a against b (coulomb_friction.h) whose bound follows the normal force.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

struct RollingResistance : Element {
  std::vector<std::string> contacts; ///< one: a tyre, or a contact of something round
  double arm = 0.0;                  ///< m
};

[[nodiscard]] const ElementKind& rolling_resistance_kind();

} // namespace steplap
