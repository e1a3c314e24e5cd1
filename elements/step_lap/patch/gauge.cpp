#include "elements/step_lap/patch/gauge.h"

#include <Eigen/LU>

#include <cmath>

namespace steplap {

namespace {

constexpr int k_max_newton = 60;
constexpr double k_shortest_step = 1e-6;

/// A point y with the data of φ: its gradient h∇h − w, and its curvature ∇h∇hᵀ + h∇²h.
struct Trial {
  Vec3 y;
  Dissipation d;
  [[nodiscard]] double value(const Vec3& w) const { return 0.5 * d.h * d.h - w.dot(y); }
  [[nodiscard]] Vec3 residual(const Vec3& w) const { return d.h * d.gradient - w; }
  [[nodiscard]] Mat3 curvature() const { return d.gradient * d.gradient.transpose() + d.h * d.hessian; }
};

/// Scales y to the minimum of φ along the ray through y.
void rescale(Trial& t, const Vec3& w) {
  const double scale = w.dot(t.y) / (t.d.h * t.d.h);
  t.y *= scale;
  t.d.h *= scale;
  t.d.hessian /= scale; // homogeneous of degree −1; the gradient is of degree 0
}

/// Returns the initial point: `warm` if its direction is suitable, otherwise w, which would be exact if the set were a ball, and is exact
/// for translation.
Trial start(const ScaledPatch& patch, const Vec3& w, const Vec3& warm, int& evaluations) {
  Trial t;
  const double length = warm.norm();
  if (length > 0 && std::isfinite(length)) {
    t.y = warm / length;
    t.d = patch.evaluate(t.y);
    ++evaluations;
    // Since h ≤ |y|, the maximum is at least |w| = 1; an initial direction with a value well below is unsuitable.
    if (w.dot(t.y) > 0.7 * t.d.h) {
      rescale(t, w);
      return t;
    }
  }
  t.y = w;
  t.d = patch.evaluate(t.y);
  ++evaluations;
  rescale(t, w);
  return t;
}

} // namespace

bool is_acceptable(double value0, double slope0, double value, double slope, double step) {
  const double rounding = 1e-13 * (1 + std::abs(value0));
  return value <= value0 + 1e-4 * step * slope0 ||
         (std::abs(slope) <= 0.5 * std::abs(slope0) && (value <= value0 + rounding || std::abs(slope0) <= rounding));
}

Gauge find_gauge(const ScaledPatch& patch, const Vec3& w, const Vec3& warm, double tolerance, const Mat3& subspace) {
  Gauge out;
  const bool whole = subspace.isIdentity(0);
  const Mat3 across = Mat3::Identity() - subspace;
  const auto reduced = [&](const Vec3& v) { return whole ? v : Vec3(subspace * v); };

  Trial t = start(patch, w, warm, out.evaluations);
  Vec3 residual = reduced(t.residual(w));
  out.converged = residual.norm() <= tolerance;
  for (int i = 0; i < k_max_newton && !out.converged; ++i) {
    // Newton's method squares the error, so the curvature is omitted in the step that is expected to be the last.
    const bool is_likely_last = residual.squaredNorm() <= tolerance;
    Mat3 curvature = t.curvature();
    if (!whole) curvature = subspace * curvature * subspace + across;
    const Vec3 step = reduced(-(curvature.inverse() * residual));
    const double value0 = t.value(w), slope0 = residual.dot(step);
    Trial next;
    for (double s = 1; s > k_shortest_step; s *= 0.5) {
      next.y = t.y + s * step;
      next.d = is_likely_last ? patch.evaluate_gradient(next.y) : patch.evaluate(next.y);
      ++out.evaluations;
      if (is_acceptable(value0, slope0, next.value(w), reduced(next.residual(w)).dot(step), s)) break;
    }
    t = next;
    residual = reduced(t.residual(w));
    out.converged = residual.norm() <= tolerance;
    if (is_likely_last && !out.converged) { // not converged: further iterations need the curvature at y
      t.d = patch.evaluate(t.y);
      ++out.evaluations;
    }
  }
  out.residual = residual.norm();
  out.value = w.dot(t.y) / t.d.h;
  out.y = t.y;
  out.wrench = t.d.h * t.d.gradient;
  return out;
}

} // namespace steplap
