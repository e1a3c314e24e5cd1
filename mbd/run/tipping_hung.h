// Finds freely hanging loads. The weight of such a load acts at its suspension point for every direction of gravity.
//
// A load at rest that touches nothing else and hangs by one pin, rod, spring or rope swings until its centre of gravity is below the
// suspension point. It then exerts its weight and no couple, like a point mass at that point, for every tilt of the machine that carries
// it. A rope that continues from the suspension to a winch has the weight as its tension.
#pragma once

#include "mbd/run/loaded_model.h"
#include "mbd/system/link.h"

namespace steplap {

/// A hanging load, as point mass on the body that carries it.
struct HangingLoad {
  int carrier = k_ground;    ///< index of the carrying body in the system
  Vec2 point = Vec2::Zero(); ///< suspension point in ground axes, m
  double mass = 0.0;         ///< mass of the load, kg
  int bodies = 0;            ///< number of bodies of the load
};

/// All hanging loads of a pose, and their effect on the bodies that carry them.
struct HangingLoads {
  std::vector<HangingLoad> loads; ///< one for each hanging load
  std::vector<char> is_hung;      ///< per body: belongs to a hanging load
  /// Per body: correction of the element forces on bodies that carry loads, from the present motion to loads at rest.
  std::vector<BodyForce> correction;
  std::vector<std::string> by; ///< names of the suspending elements
};

/// Finds the hanging loads. `force`: force on each body, in `state`, of elements that are neither contacts nor joints.
[[nodiscard]] HangingLoads hanging_loads(const LoadedModel& loaded, const State& state, const std::vector<std::string>& touching,
                                         const std::vector<BodyForce>& force);

} // namespace steplap
