// Utilisation of the friction capacity of a patch by a wrench, and the centre about which it would start to rotate: the inverse of Eqs.
// (11)-(15), as the gauge of the convex set of admissible wrenches,
//
//   u(W) = max_ν W·ν / h(ν).
//
// u is proportional to 1/pressure: the required pressure is u·p, the margin 1/u, and b starts to slide at u = 1 along −ν, where W is the
// wrench that holds b. Wrenches and twists as in limit_surface.h.
//
// The maximum is found as the minimum of ½h(ν)² − W·ν, which is smooth and strictly convex except at ν = 0, and quadratic if h is an
// ellipsoid. Newton's method with a line search converges from any start, also for pure translation, where a search for the centre of
// rotation would be singular.
#pragma once

#include "elements/step_lap/patch/limit_surface.h"

#include <optional>

namespace steplap {

/// Result for one wrench.
struct RequiredPressure {
  double u = 0;                  ///< utilisation of the capacity; infinite for an empty patch
  Vec3 direction = Vec3::Zero(); ///< maximiser ν, scaled to |(v at the centroid, gyration·ω)| = 1
  std::optional<Vec2> centre;    ///< centre of rotation in a's axes [m]; nothing if at infinity, or for W = 0
  int evaluations = 0;           ///< number of evaluations of h
  double residual = 0;           ///< |h∇h/u − W| relative to |W|, in scaled units (ScaledPatch)
  bool converged = true;

  [[nodiscard]] double margin() const { return 1.0 / u; }
};

/// Returns u(W) for the wrench W = (F_x, F_y, M) about the patch's reference. `warm`, if not zero, is an initial direction (of a previous
/// result). W = 0 gives u = 0 without direction; an empty patch and W ≠ 0 give u = ∞. Several evaluations are needed, so prepare() the
/// patch first. `tolerance`: largest |h∇h/u − W| relative to |W|; the error of u is of the order of its square.
[[nodiscard]] RequiredPressure required_pressure(const Patch& patch, const Vec3& wrench, const Vec3& warm = Vec3::Zero(),
                                                 double tolerance = 1e-10);

/// Capacity of a patch for pure force and pure moment about its centroid, for cheap bounds of u.
struct Capacity {
  Vec2 arm{0, 0};    ///< from the patch's reference to the centroid of its traction [m]
  double force = 0;  ///< largest force in pure translation, equal in all directions [N]
  double couple = 0; ///< largest pure moment; rounded down [N m]
  double polar = 0;  ///< force × radius of gyration: upper bound of the moment [N m]
};

/// Returns the capacity, by solving the problem for one moment. To be computed once per patch.
[[nodiscard]] Capacity capacity(const Patch& patch);

/// Rigorous bounds lower ≤ u(W) ≤ upper, in a few nanoseconds. The lower one is from the ellipsoid that contains the set (h² ≤ force ·
/// ∬w|v|², Cauchy–Schwarz), the upper one from the triangle inequality u(F, M) ≤ u(F, 0) + u(0, M). They are equal for a pure force through
/// the centroid. The upper one is at most √2·polar/couple times the lower.
struct UsageBounds {
  double lower = 0, upper = 0;
};
/// Returns the bounds of u for `wrench`.
[[nodiscard]] UsageBounds usage_bounds(const Capacity& capacity, const Vec3& wrench);

/// Returns the centre of rotation of a twist about `reference`, or nothing if it is farther than 1e12 m or ν = 0.
[[nodiscard]] std::optional<Vec2> centre_of_rotation(const Vec2& reference, const Vec3& nu);

} // namespace steplap
