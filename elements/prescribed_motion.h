// Prescribed motion: a coordinate of a against b follows a signal, exactly.
//
// The signal gives the coordinate's acceleration, velocity or position; the others are its exact
// integrals and derivatives (signal.h), starting from the initial pose (acceleration: and velocity). A position is the
// coordinate itself, or what it is beyond its value in the reference pose; where the reference pose is not where the
// signal begins, the body would have to jump there: refuse_initial_jumps().
// The multiplier is the force or couple on a that it takes (the brake force, say).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct PrescribedMotion : Element {
  std::string a, b = "ground";
  std::string coordinate = "x"; ///< x, y (marker b's axes), angle, distance
  std::string signal;
  std::string as = "acceleration";
  std::string zero = "origin"; ///< of a position: the coordinate's own, or "reference", its value in the reference pose
};

[[nodiscard]] const ElementKind& prescribed_motion_kind();

class System;
/// Throws ModelError where a position's signal begins elsewhere than the reference pose has the body: it would have to
/// jump. For whoever reads a model; assembly alone moves bodies to where their drives are.
void refuse_initial_jumps(const Model& model, const System& system);

} // namespace steplap
