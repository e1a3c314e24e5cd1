// Decides whether contact forces at the start are in balance, or push bodies apart because the initial penetration is wrong.
//
// Let a(F) be the acceleration of the machine, at rest and without friction, under forces F with its joint constraints, and g the gradient
// of a gap. All forces Q open the gap with g·a(Q), and the forces Q₀ without contacts with g·a(Q₀). If contacts merely settle under loads,
// both are of similar magnitude; if a contact penetrates too deeply, the first is many times larger. Opposing contacts (a clamp) balance
// each other in a(Q).
#pragma once

#include "mbd/rest/tangent.h"
#include "mbd/system/system.h"

namespace steplap {

/// Forces and accelerations at the start of a run, computed once for all contacts.
class StartBalance {
public:
  /// Computes the forces in the pose of `state` with all velocities zero.
  StartBalance(const System& system, const State& state);

  /// Initial acceleration of a gap or coordinate.
  struct Opening {
    double acceleration = 0.0; ///< acceleration due to all forces, m/s² or rad/s²
    double by_loads = 0.0;     ///< magnitude of the acceleration due to forces other than contact forces
  };
  /// Returns the opening acceleration of a coordinate with this gradient (three numbers per body without the ground). `own` is the force of
  /// a stop along the coordinate, which is excluded from the loads.
  [[nodiscard]] Opening opening(const VecX& gradient, double own = 0.0) const;

  /// Returns the gradient of the gap of a pressed contact, given by the index of its force; empty if the contact is not pressed.
  [[nodiscard]] VecX gap_gradient(int contact) const;
  /// Returns the gradient of the coordinate that a row constrains: three numbers per body without the ground.
  [[nodiscard]] VecX gradient(const RowSpec& row) const;

private:
  [[nodiscard]] VecX acceleration(const VecX& force) const;
  [[nodiscard]] VecX contact_forces(const System& system) const;

  State state_;
  Statics statics_;
  VecX scale_, mass_;               ///< scales of the coordinates; masses of the scaled coordinates
  MatX free_;                       ///< basis of the scaled motions that the joints permit; empty: all motions
  MatX inverse_;                    ///< inverse of the mass matrix in the basis free_
  VecX all_, loads_;                ///< accelerations under all forces, and under the forces other than contact forces
  std::vector<PairJacobian> parts_; ///< of all force elements; empty without contacts
};

} // namespace steplap
