// Settings of integration methods, and what they report of a run.
#pragma once

#include "mbd/base/types.h"

#include <limits>

namespace steplap {

/// Settings of a method.
struct IntegratorSettings {
  double tolerance = 1e-8; ///< relative local error of adaptive methods
  double step = 0.0;       ///< length of fixed steps, s; first step of adaptive methods
  double max_step = 0.0;   ///< largest step, s; 0: no limit
  double projection_tolerance = 1e-12;
  /// Number of parts into which each step is divided in a finer run. All limits of the step length (breakpoints, harmonics, forces after
  /// an event, end of a slip) apply to the undivided step. Fixed steps are planned with length division × step and then divided.
  int division = 1;
};

/// Statistics of fixed steps that were divided because bodies turned too far.
struct DividedSteps {
  long count = 0;
  double shortest = std::numeric_limits<double>::infinity(); ///< shortest of these steps, s
  int a = k_ground, b = k_ground;                            ///< pair of bodies with the fastest relative rotation
};

} // namespace steplap
