// Jacobian terms of own states of the model (own_states.h), for implicit methods.
#pragma once

#include "mbd/system/roles.h"

#include <array>
#include <functional>
#include <vector>

namespace steplap {

/// Derivatives as sparse lists, with states in the units of State::inner and all else in SI.
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

class MotionFormula;
/// A formula in the equations of motion, with the values of its names `value` and `rate`; `own` is null if it has no own coordinate.
struct FormulaInMotion {
  const MotionFormula* formula = nullptr; ///< owned by its group
  std::function<std::array<double, 2>(const Evaluation& e)> own = nullptr;
  int unit = -1; ///< index of its mode, the bits of its switches; -1 if it has none
};

/// Additional interface of force groups that read own states. The entries have the same order as long as modes do not change.
class StateReader {
public:
  virtual ~StateReader() = default;
  /// Adds the derivatives of rates of own states, and of forces by own states, to `out`.
  virtual void add_state_jacobian(const Evaluation& e, StateJacobian& out) const = 0;
  /// Appends the formulas that give forces and rates of own states. To be called once all elements are compiled.
  virtual void enter_formulas(std::vector<FormulaInMotion>& /*out*/) const {}
};

} // namespace steplap
