// Assembly: do the poses that the file gives meet the joints, up to a least motion?
//
// A model may give its poses roughly: a run begins at the poses on the joints that are nearest to the given
// ones, and at the velocities there that are nearest to the given ones, both weighted by mass and moment of
// inertia. Nearest means stationary: that no small motion along the joints leads nearer. With poses so rough
// that several such places exist it is the one reached from the first projection. Joints that no motion can meet are an error of the model, found before anything runs.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/system.h"

namespace steplap {

/// The initial state moved onto the constraints with the least motion, drives begun there.
/// Throws ModelError at the element that stays unmet most; `model` is what `system` was compiled from.
[[nodiscard]] State assemble(const Model& model, const System& system);

/// Where a run begins: the initial state with the poses and velocities of `assembled`.
[[nodiscard]] State assembled_start(const System& system, const State& assembled);

/// How far a body was moved to meet the joints: position, angle, velocity, angular velocity.
struct AssemblyMove {
  int body = 0;
  double shift = 0.0, turn = 0.0;                ///< m, rad
  double velocity = 0.0, angular_velocity = 0.0; ///< m/s, rad/s
};

/// Bodies of which anything changed by more than `threshold` between two states, the one shifted most first.
[[nodiscard]] std::vector<AssemblyMove> assembly_moves(const State& given, const State& assembled, double threshold = 1e-9);

} // namespace steplap
