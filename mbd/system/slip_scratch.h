// What laws of slip are told by the run that they are in.
//
// A law whose beginning and end are followed only as closely as a run asks for (a step-lap joint's) hangs on the tolerance. A run
// at a finer one leaves out less, so that estimates by finer runs see what is left out.
#pragma once

#include "mbd/system/roles.h"

#include <cstddef>

namespace steplap {

/// Scratch of elements whose slip law hangs on the tolerance.
struct SlipScratch : FrictionScratch {
  /// Of a method that chooses its steps by it. Not called where it does not.
  virtual void follow(double tolerance) = 0;
};

/// Tells all of an evaluation's friction elements.
inline void tell_slip_laws(const Evaluation& e, double tolerance, std::size_t frictions) {
  for (std::size_t f = 0; f < frictions; ++f)
    if (auto* scratch = dynamic_cast<SlipScratch*>(e.scratch[f])) scratch->follow(tolerance);
}

} // namespace steplap
