// Derivatives of the rates of [[state]] variables (own_states.h), and of forces by them, for implicit methods.
#pragma once

#include "mbd/system/roles.h"

#include <vector>

namespace steplap {

/// Derivatives as sparse lists. Variables z are in the units of State::inner, all other quantities in SI.
struct StateJacobian {
  struct ByMotion { ///< ∂ż/∂(pose of a body), ∂ż/∂(its velocity)
    int inner = 0, body = k_ground;
    Vec3 pose = Vec3::Zero(), velocity = Vec3::Zero();
  };
  struct ByState { ///< ∂ż/∂(another state)
    int inner = 0, by = 0;
    double value = 0.0;
  };
  struct Force { ///< ∂(force on a body)/∂z
    int body = k_ground, inner = 0;
    Vec3 value = Vec3::Zero();
  };
  std::vector<ByMotion> by_motion;
  std::vector<ByState> by_state;
  std::vector<Force> forces;

  void clear() {
    by_motion.clear();
    by_state.clear();
    forces.clear();
  }
};

} // namespace steplap
