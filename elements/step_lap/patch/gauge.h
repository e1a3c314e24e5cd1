// Convex problem for the required pressure, in the patch's own units (scaled_patch.h):
//
//   max y·w / h(y)   over y in a linear subspace, by default the whole space,
//
// found as the minimum of φ(y) = ½h² − w·y. At the minimum W = h∇h agrees with w on the subspace and has the gauge h: it is the wrench with
// the smallest utilisation among all that agree with w there.
#pragma once

#include "elements/step_lap/patch/scaled_patch.h"

namespace steplap {

/// Solution of the problem.
struct Gauge {
  double value = 0;           ///< max y·w/h
  Vec3 y = Vec3::Zero();      ///< vector at which the maximum is reached
  Vec3 wrench = Vec3::Zero(); ///< h∇h at y: the wrench with the smallest utilisation
  int evaluations = 0;
  double residual = 0; ///< |h∇h − w| on the subspace; the error of `value` is of the order of its square
  bool converged = false;
};

/// Solves the problem for |w| = 1. `warm`: initial direction, or zero. With a `subspace` (an orthogonal projector) w and `warm` must lie in
/// it. `tolerance`: largest length of the projection of h∇h − w.
[[nodiscard]] Gauge find_gauge(const ScaledPatch& patch, const Vec3& w, const Vec3& warm, double tolerance,
                               const Mat3& subspace = Mat3::Identity());

/// Acceptance test of a line search: sufficient decrease of a convex function. If rounding hides the decrease, a sufficiently small slope
/// without an increase beyond rounding is accepted (approximate Wolfe condition of Hager and Zhang).
[[nodiscard]] bool is_acceptable(double value0, double slope0, double value, double slope, double step);

} // namespace steplap
