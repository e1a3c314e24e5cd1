// Passes the tolerance of the run to slip laws.
//
// The onset and end of slip in a step-lap joint are resolved only as accurately as the tolerance requires. A run with a finer tolerance
// neglects less, so that error estimates by finer runs include what is neglected.
#pragma once

#include "mbd/system/roles.h"

namespace steplap {

/// Base class for the caches of friction elements whose slip law depends on the tolerance.
struct SlipScratch : FrictionScratch {
  /// Sets the relative tolerance of the run. Not called for methods without a tolerance.
  virtual void follow(double tolerance) = 0;
};

} // namespace steplap
