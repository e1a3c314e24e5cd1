#include "elements/patch/required_pressure.h"

#include "elements/patch/scaled_patch.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr int k_max_newton = 60;

/// φ(y) = ½h² − w·y with |w| = 1, its gradient h∇h − w, and the curvature ∇h∇hᵀ + h∇²h.
struct Trial {
  Vec3 y;
  Dissipation d;
  [[nodiscard]] double value(const Vec3& w) const { return 0.5 * d.h * d.h - w.dot(y); }
  [[nodiscard]] Vec3 residual(const Vec3& w) const { return d.h * d.gradient - w; }
  [[nodiscard]] Mat3 curvature() const {
    return d.gradient * d.gradient.transpose() + d.h * d.hessian;
  }
};

/// The multiple of y that minimises φ along it: scale w·y/h².
void rescale(Trial& t, const Vec3& w) {
  const double scale = w.dot(t.y) / (t.d.h * t.d.h);
  t.y *= scale;
  t.d.h *= scale;
  t.d.hessian /= scale; // homogeneous of degree −1; the gradient of degree 0
}

/// Starts along `warm` if it points the right way and is better than w itself (exact for discs of
/// pure translation), else along w.
Trial start(const ScaledPatch& patch, const Vec3& w, const Vec3& warm, int& evaluations) {
  Trial t;
  const double length = warm.norm();
  if (length > 0 && std::isfinite(length)) {
    t.y = warm / length;
    t.d = patch.evaluate(t.y);
    ++evaluations;
    // |w| = 1 is a lower bound of u: a start well below it has lost its way.
    if (w.dot(t.y) > 0.7 * t.d.h)
      return rescale(t, w), t;
  }
  t.y = w;
  t.d = patch.evaluate(t.y);
  ++evaluations;
  return rescale(t, w), t;
}

/// Sufficient decrease, or, where rounding hides it, a slope that has become small without the
/// value rising beyond rounding (Hager and Zhang's approximate Wolfe condition).
bool acceptable(double value0, double slope0, double value, double slope, double step) {
  const double rounding = 1e-14 * (1 + std::abs(value0));
  return value <= value0 + 1e-4 * step * slope0 ||
         (std::abs(slope) <= 0.5 * std::abs(slope0) && value <= value0 + rounding);
}

} // namespace

std::optional<Vec2> centre_of_rotation(const Vec2& reference, const Vec3& nu) {
  constexpr double infinite = 1e12; // [m]
  if (std::hypot(nu[0], nu[1]) >= infinite * std::abs(nu[2]))
    return std::nullopt;
  return reference + Vec2(-nu[1], nu[0]) / nu[2];
}

RequiredPressure required_pressure(const Patch& patch, const Vec3& wrench, const Vec3& warm,
                                   double tolerance) {
  RequiredPressure out;
  if (wrench.isZero(0))
    return out;
  if (patch.empty()) {
    out.u = std::numeric_limits<double>::infinity();
    return out;
  }
  const ScaledPatch scaled(patch);
  const Vec3 all = scaled.scaled_wrench(wrench);
  const double size = all.norm();
  const Vec3 w = all / size;

  Trial t = start(scaled, w, warm.isZero(0) ? warm : scaled.scaled_twist(warm), out.evaluations);
  Vec3 residual = t.residual(w);
  out.converged = residual.norm() <= tolerance;
  for (int i = 0; i < k_max_newton && !out.converged; ++i) {
    const Vec3 step = -t.curvature().inverse() * residual;
    const double value0 = t.value(w), slope0 = residual.dot(step);
    Trial next;
    for (double s = 1; s > 1e-6; s *= 0.5) {
      next.y = t.y + s * step;
      next.d = scaled.evaluate(next.y);
      ++out.evaluations;
      if (acceptable(value0, slope0, next.value(w), next.residual(w).dot(step), s))
        break;
    }
    t = next;
    residual = t.residual(w);
    out.converged = residual.norm() <= tolerance;
  }
  out.u = size * w.dot(t.y) / t.d.h;
  out.direction = scaled.twist(t.y.normalized());
  out.centre = centre_of_rotation(patch.reference(), out.direction);
  return out;
}

Capacity capacity(const Patch& patch) {
  Capacity out;
  if (patch.empty())
    return out;
  out.arm = patch.centroid() - patch.reference();
  out.force = patch.force();
  out.polar = patch.force() * patch.gyration();
  // A couple is a couple about every point. The gradient at the solution is in the set, so that
  // 1/u is good to the square of the tolerance; 1e-9 covers it and all rounding.
  out.couple = (1 - 1e-9) / required_pressure(patch, {0, 0, 1}).u;
  return out;
}

UsageBounds usage_bounds(const Capacity& c, const Vec3& wrench) {
  const double force = std::hypot(wrench[0], wrench[1]);
  const double couple = std::abs(wrench[2] - (c.arm.x() * wrench[1] - c.arm.y() * wrench[0]));
  if (force == 0 && couple == 0)
    return {};
  if (!(c.force > 0)) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    return {infinite, infinite};
  }
  return {std::hypot(force / c.force, couple / c.polar), force / c.force + couple / c.couple};
}

} // namespace steplap
