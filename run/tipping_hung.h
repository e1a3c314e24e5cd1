// What hangs on something: its whole weight pulls at the point that it hangs from, whichever way down is.
//
// A load at rest that touches nothing else and hangs by one pin, rod, spring or rope swings until its centre of gravity
// lies below the point that it hangs from. So it acts there with its weight and with no couple, as if all its mass were
// in that point, however the machine that carries it is tilted. A rope that runs on from there to a winch has that
// weight for its tension.
#pragma once

#include "mbd/system/link.h"
#include "run/loaded_model.h"

namespace steplap {

/// A load at the body that carries it.
struct HungLoad {
  int carrier = k_ground;    ///< body of the system
  Vec2 point = Vec2::Zero(); ///< it hangs from, in the ground's axes
  double mass = 0.0;         ///< kg
  int bodies = 0;            ///< of which it is made
};

/// What hangs in a pose, and what is left for whatever carries it.
struct Hanging {
  std::vector<HungLoad> loads;       ///< one for each load that hangs
  std::vector<char> is_hung;         ///< per body
  std::vector<BodyForce> correction; ///< per body, of those that carry: what forces of elements are more, with loads at rest
  std::vector<std::string> by;       ///< names of the elements that they hang by
};

/// `force`: on each body, of elements that are neither contacts nor joints, in `state`.
[[nodiscard]] Hanging hanging_loads(const LoadedModel& loaded, const State& state, const std::vector<std::string>& touching,
                                    const std::vector<BodyForce>& force);

} // namespace steplap
