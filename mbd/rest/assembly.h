// Assembly: moves the given poses onto the joints with the least motion.
//
// A model may give its poses roughly. A run starts from the poses nearest to the given ones that satisfy the joints, and from the
// velocities nearest to the given ones that are compatible with them, both weighted by mass and moment of inertia. "Nearest" means
// stationary: no small motion along the joints reduces the distance. If the given poses are so rough that several such poses exist, the one
// that is reached from the first projection is used. Joints that no pose can satisfy are an error of the model, reported before the run.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/system.h"

namespace steplap {

/// Returns the initial state, projected onto the constraints, with drives at their initial values. `model` is the source of `system`.
/// Throws ModelError at the element with the largest remaining error.
[[nodiscard]] State assemble(const Model& model, const System& system);

/// Returns the initial state of a run with the poses and velocities of `assembled`, and with the modes that follow from them.
[[nodiscard]] State assembled_start(const System& system, const State& assembled);

/// Change of a body's pose and velocity by the assembly.
struct AssemblyMove {
  int body = 0;
  double shift = 0.0, turn = 0.0;                ///< m, rad
  double velocity = 0.0, angular_velocity = 0.0; ///< m/s, rad/s
};

/// Returns the changes of all bodies for which some number changed by more than `threshold`, the largest shift first.
[[nodiscard]] std::vector<AssemblyMove> assembly_moves(const State& given, const State& assembled, double threshold = 1e-9);

} // namespace steplap
