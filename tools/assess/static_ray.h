// Increases a pull in one direction until the machine leaves its equilibrium. Finds the element that slips, slides or lifts first, and the
// acceleration.
//
// The pull grows in steps of 10 % to 33 % of its value. The reserves of the monitored limits (static_machine.h) at both ends of a step show
// which limits are reached within it; these are then located by bisection.
//
// If springs and contacts are linear, the first limit cannot be missed. The equilibrium and the contact forces are then linear in the pull,
// and the utilisation of friction is convex (the gauge of a convex set, applied to a wrench that is linear in the pull). A limit with a
// reserve at both ends of a step therefore has one everywhere between. Beyond the first limit the system is different (a foot has lifted, a
// floor slides). A limit that is reached and left within one step could then be missed, so the list of later limits may be incomplete.
#pragma once

#include "tools/assess/static_machine.h"

namespace steplap::assess {

/// A limit that is reached while the pull grows.
struct StaticLimit {
  LimitKind kind = LimitKind::ends;
  std::string element;       ///< name of the element; "" for the kind `ends`
  std::string text;          ///< "'front joint' slips"; for `ends` the message of the equilibrium search
  double acceleration = 0.0; ///< pull at which the limit is reached, m/s²
  double error = 0.0;        ///< half the width of the interval that contains `acceleration`, m/s²
};

/// All limits reached along one direction of pull.
struct StaticRay {
  std::vector<StaticLimit> limits; ///< limits in ascending order of acceleration
  /// false if the search ended without a rest and without proof that there is none
  bool is_explained = true;
  double largest = 0.0; ///< largest pull with an equilibrium, m/s²
};

/// Increases the pull along `direction` (length 1) up to `most`, m/s².
[[nodiscard]] StaticRay grow_pull(StaticMachine& machine, const Vec2& direction, double most);

} // namespace steplap::assess
