// Increases a pull in one direction until the machine leaves its equilibrium, and finds the element that gives way and its acceleration.
//
// The pull grows in steps of 10 % to 33 % of its value. The reserve of each watch (static_machine.h) at both ends of a step shows whether
// it reaches its limit within the step; the limit is then located by bisection.
//
// The first limit cannot be missed if springs and contacts are linear. The equilibrium is then linear in the pull, contact forces are
// linear, and the utilisation of friction is convex (the gauge of a convex set, applied to a wrench that is linear in the pull). A watch
// with a reserve at both ends of a step therefore has one everywhere between. Beyond the first limit the system changes (a foot has lifted,
// a floor slides). A limit that is reached and left again within one step could be missed there, so later limits are only those that were
// observed.
#pragma once

#include "tools/assess/static_machine.h"

namespace steplap::assess {

/// A limit that the growing pull reaches.
struct StaticLimit {
  LimitKind kind = LimitKind::ends;
  std::string element;       ///< "" if the kind is `ends`
  std::string text;          ///< "'front joint' slips"; for `ends` the message of the equilibrium search
  double acceleration = 0.0; ///< m/s²
  double error = 0.0;        ///< half the width of the interval that contains it, m/s²
};

/// Limits along one direction of pull.
struct StaticRay {
  std::vector<StaticLimit> limits; ///< ascending in acceleration
  bool is_explained = true;        ///< false if equilibrium is lost although nothing gave way before, or if the search failed without a
                                   ///< reason
  double largest = 0.0;            ///< largest pull with an equilibrium, m/s²
};

/// Increases the pull along `direction` (length 1) up to `most`, m/s².
[[nodiscard]] StaticRay grow_pull(StaticMachine& machine, const Vec2& direction, double most);

} // namespace steplap::assess
