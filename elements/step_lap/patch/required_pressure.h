// How much of its friction capacity a patch uses to carry a wrench, and where it would start to
// turn: the inverse of Eqs. (11)-(15), posed as the gauge of the convex set of bearable wrenches,
//   u(W) = max_ν W·ν / h(ν).
// u scales with 1/pressure: the required pressure is u·p, the margin 1/u, and sliding of b starts
// at u = 1 along −ν for W the wrench that holds b. Wrenches and twists as in limit_surface.h.
//
// The maximum is found as the minimum of ½h(ν)² − W·ν, smooth and strictly convex away from
// ν = 0, quadratic if h were an ellipsoid: Newton with a line search converges from anywhere, also
// for pure translation, where a search for the centre of rotation itself is singular.
#pragma once

#include "elements/step_lap/patch/limit_surface.h"

#include <optional>

namespace steplap {

/// What it takes to bear a wrench.
struct RequiredPressure {
  double u = 0;                  ///< share of the capacity; infinite for an empty patch
  Vec3 direction = Vec3::Zero(); ///< maximiser ν, scaled to |(v at the centroid, gyration·ω)| = 1
  std::optional<Vec2> centre;    ///< of rotation in a's axes [m]; none at infinity or if W = 0
  int evaluations = 0;           ///< of h
  double residual = 0;           ///< |h∇h/u − W| relative to |W|, in the patch's own units
  bool converged = true;

  [[nodiscard]] double margin() const { return 1.0 / u; }
};

/// u(W) for the wrench W = (F_x, F_y, M) about the patch's reference. `warm`, if not zero, is a
/// direction to start from (a previous result's). W = 0 gives u = 0 without direction; an empty
/// patch and W ≠ 0 give u = ∞. Several evaluations: prepare() the patch first. `tolerance` bounds
/// |h∇h/u − W| relative to |W|; the error of u is of the order of its square.
[[nodiscard]] RequiredPressure required_pressure(const Patch& patch, const Vec3& wrench, const Vec3& warm = Vec3::Zero(),
                                                 double tolerance = 1e-10);

/// What a patch can bear along each axis about its centroid: all that cheap bounds on u need.
struct Capacity {
  Vec2 arm{0, 0};    ///< from the patch's reference to the centroid of its traction [m]
  double force = 0;  ///< in pure translation, the same in every direction [N]
  double couple = 0; ///< pure couple; rounded down [N m]
  double polar = 0;  ///< force × radius of gyration: upper bound of the couple [N m]
};

/// One couple to solve; done once per patch.
[[nodiscard]] Capacity capacity(const Patch& patch);

/// Certified bounds lower ≤ u(W) ≤ upper, for a few nanoseconds. Lower from the ellipsoid that
/// contains the set (h² ≤ force · ∬w|v|², Cauchy-Schwarz), upper from the triangle inequality
/// u(F, M) ≤ u(F, 0) + u(0, M); equal for a pure force through the centroid. The upper is at
/// most √2·polar/couple times the lower.
struct UsageBounds {
  double lower = 0, upper = 0;
};
[[nodiscard]] UsageBounds usage_bounds(const Capacity& capacity, const Vec3& wrench);

/// Centre of rotation of a twist about `reference`; none when it is farther than 1e12 m or ν = 0.
[[nodiscard]] std::optional<Vec2> centre_of_rotation(const Vec2& reference, const Vec3& nu);

} // namespace steplap
