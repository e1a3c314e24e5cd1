// Rolling resistance of a round body in contact: a moment against the rotation of a relative to b, which sticks exactly at rest.
//
// The resultant of the contact pressure of a rolling body is ahead of the centre by `arm`, so the moment is at most arm·N with N the normal
// force (Coulomb's law of rolling). For a coefficient f of rolling resistance, arm = f r. It is friction (coulomb_friction.h) on the angle
// of a relative to b with a bound that follows the normal force.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

struct RollingResistance : Element {
  std::vector<std::string> contacts; ///< name of one tyre, or of one contact of a round body
  double arm = 0.0;                  ///< lever of the normal force, m
};

[[nodiscard]] const ElementKind& rolling_resistance_kind();

} // namespace steplap
