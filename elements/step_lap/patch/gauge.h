// The convex problem behind the required pressure, in the patch's own units (scaled_patch.h):
//   max y·w / h(y)   over y in a linear subspace, the whole space by default,
// found as the minimum of φ(y) = ½h² − w·y. At the minimum, W = h∇h agrees with w on the subspace
// and has gauge h: the wrench that uses least of the capacity among all that agree with w there.
#pragma once

#include "elements/step_lap/patch/scaled_patch.h"

namespace steplap {

struct Gauge {
  double value = 0;           ///< max y·w/h
  Vec3 y = Vec3::Zero();      ///< maximiser
  Vec3 wrench = Vec3::Zero(); ///< h∇h
  int evaluations = 0;
  double residual = 0; ///< |h∇h − w| on the subspace; the value is good to its square
  bool converged = false;
};

/// For |w| = 1. `warm`: a direction to start from, or zero; with a `subspace` (orthogonal
/// projector) both must lie in it. `tolerance` is on the projection of h∇h − w.
[[nodiscard]] Gauge find_gauge(const ScaledPatch& patch, const Vec3& w, const Vec3& warm, double tolerance,
                               const Mat3& subspace = Mat3::Identity());

/// Line search: sufficient decrease of a convex function along a step, or, where rounding hides
/// it, a slope that has become small without the value rising beyond rounding (the approximate
/// Wolfe condition of Hager and Zhang).
[[nodiscard]] bool is_acceptable(double value0, double slope0, double value, double slope, double step);

} // namespace steplap
