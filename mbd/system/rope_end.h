// A straight part of a rope over pulleys has vanished: what hung on it has met its pulley. Where it would go on from
// there the rope's points do not say, for a pulley has no size, and a part of no length no direction.
#pragma once

#include "mbd/base/shown_text.h"
#include "mbd/system/element_failure.h"

#include <string>

namespace steplap {

/// `one`, `next`: the points that have met.
[[nodiscard]] inline ElementFailure rope_has_run_in(double t, const std::string& rope, const std::string& one, const std::string& next) {
  return {"at t = " + rounded_text(t, 12) + " s '" + one + "' and '" + next + "' have met: nothing is left of rope '" + rope +
              "' between them, what it pulled has run onto its pulley. End the run before, or keep it away by a 'limit'",
          {rope}};
}

} // namespace steplap
