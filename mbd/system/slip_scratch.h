// Tolerance of the run, for slip laws that depend on it.
//
// The onset and end of slip in a step-lap joint are resolved only as accurately as the tolerance requires. A run with a finer tolerance
// neglects less, so error estimates by finer runs include the neglected part.
#pragma once

#include "mbd/system/roles.h"

#include <cstddef>

namespace steplap {

/// Base class of the scratch memory of such friction elements.
struct SlipScratch : FrictionScratch {
  /// Sets the relative tolerance. Not called for methods without a tolerance.
  virtual void follow(double tolerance) = 0;
};

/// Sets the tolerance of all friction elements of an evaluation.
inline void tell_slip_laws(const Evaluation& e, double tolerance, std::size_t frictions) {
  for (std::size_t f = 0; f < frictions; ++f)
    if (auto* scratch = dynamic_cast<SlipScratch*>(e.scratch[f])) scratch->follow(tolerance);
}

} // namespace steplap
