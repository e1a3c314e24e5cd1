// The friction wrench of one joint when everything else is given: the one-element form of the
// mode problem of convex (Gauss-principle) dynamics.
//
// With A the mobility (J M⁻¹ Jᵀ, symmetric, positive semidefinite; wrench on b → relative
// acceleration) and b the relative acceleration without friction, the wrench W minimises
//   ½ WᵀA W + bᵀW   over   {W : W·ν ≤ h(ν) for all ν}.
// Then either W is inside and A W + b = 0 (sticks), or W is on the boundary and the relative
// acceleration η = A W + b is opposed to it: W = −∇h(η) (slips). The dual is solved,
//   min_z ½ zᵀA z + h(b + A z),   z = W at the solution,
// by Newton with (I + ∇²h A) dz = −(z + ∇h(η)), a matrix that no singular A can make singular.
// z and η = b + A z are carried side by side, so that an η much smaller than b keeps its digits.
#pragma once

#include "elements/step_lap/patch/required_pressure.h"

namespace steplap {

struct AdmissibleWrench {
  Vec3 wrench = Vec3::Zero();       ///< W on b, about the patch's reference [N, N, N m]
  Vec3 acceleration = Vec3::Zero(); ///< η = A W + b [m/s², m/s², rad/s²]; zero when it sticks
  bool slips = false;
  int evaluations = 0; ///< of h
  double residual = 0; ///< of the optimality condition, in shares of the capacity
  bool converged = true;
};

/// Solves the problem above. `warm`, if not zero, is a slip direction to start from. An empty
/// patch gives W = 0, slipping at b. Where A is singular many wrenches may hold b; then the
/// sticking W is the one that uses least of the capacity.
[[nodiscard]] AdmissibleWrench admissible_wrench(const Patch& patch, const Mat3& mobility, const Vec3& free_acceleration,
                                                 const Vec3& warm = Vec3::Zero());

} // namespace steplap
