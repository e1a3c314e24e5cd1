// Error for a straight part of a rope over pulleys whose length becomes zero, because the load has run onto the pulley. Pulleys are points
// in the model, and a part of zero length has no direction, so the motion afterwards is undefined.
#pragma once

#include "mbd/base/shown_text.h"
#include "mbd/system/element_failure.h"

#include <string>

namespace steplap {

/// Returns the error; `one` and `next` are the points that met, at time t, s.
[[nodiscard]] inline ElementFailure rope_has_run_in(double t, const std::string& rope, const std::string& one, const std::string& next) {
  return {"at t = " + rounded_text(t, 12) + " s '" + one + "' and '" + next + "' have met: nothing is left of rope '" + rope +
              "' between them, what it pulled has run onto its pulley. End the run before, or keep it away by a 'limit'",
          {rope}};
}

} // namespace steplap
