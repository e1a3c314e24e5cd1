// Friction wrench of one joint for given conditions elsewhere: the mode problem of convex (Gauss-principle) dynamics for a single element.
//
// With the mobility A (J M⁻¹ Jᵀ, symmetric, positive semidefinite, maps the wrench on b to relative acceleration) and the relative
// acceleration b without friction, the wrench W minimises
//
//   ½ WᵀA W + bᵀW   over   {W : W·ν ≤ h(ν) for all ν}.
//
// Either W is inside and A W + b = 0 (sticks), or W is on the boundary and opposite to the relative acceleration η = A W + b: W = −∇h(η)
// (slips). The dual problem is solved,
//
//   min_z ½ zᵀA z + h(b + A z),   z = W at the solution,
//
// by Newton's method with (I + ∇²h A) dz = −(z + ∇h(η)), whose matrix is regular even if A is singular. z and η = b + A z are updated
// separately, so that an η much smaller than b keeps its accuracy.
#pragma once

#include "elements/step_lap/patch/required_pressure.h"

namespace steplap {

struct AdmissibleWrench {
  Vec3 wrench = Vec3::Zero();       ///< W on b about the patch's reference, N, N, N m
  Vec3 acceleration = Vec3::Zero(); ///< η = A W + b, m/s², m/s², rad/s²; zero if the joint sticks
  bool slips = false;
  int evaluations = 0; ///< number of evaluations of h
  double residual = 0; ///< residual of the optimality condition, relative to the capacity
  bool converged = true;
};

/// Solves the problem. `warm`, if not zero, is an initial slip direction. An empty patch gives W = 0, slipping along b. If A is singular
/// several wrenches may cancel b; the sticking W is then the one with the smallest utilisation.
[[nodiscard]] AdmissibleWrench admissible_wrench(const Patch& patch, const Mat3& mobility, const Vec3& free_acceleration,
                                                 const Vec3& warm = Vec3::Zero());

} // namespace steplap
