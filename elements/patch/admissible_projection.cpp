#include "elements/patch/admissible_projection.h"

#include "elements/patch/scaled_patch.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>

namespace steplap {

namespace {

constexpr int k_max_newton = 100;
constexpr double k_tolerance = 1e-11; // on z + ∇h(η), in units of the capacity
constexpr double k_rank = 1e-12;      // eigenvalues of A below this share of the largest: zero
constexpr double k_no_slip = 1e-15;   // η below this share of b is rounding of b + A z

/// Pseudo-inverse and range of a symmetric positive semidefinite matrix.
struct Inverse {
  Mat3 inverse = Mat3::Zero();
  Mat3 range = Mat3::Zero(); ///< projector
  explicit Inverse(const Mat3& a) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(a);
    for (int i = 0; i < 3; ++i) {
      const double value = eigen.eigenvalues()[i];
      if (!(value > k_rank * eigen.eigenvalues()[2]))
        continue;
      const Mat3 axis = eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose();
      inverse += axis / value;
      range += axis;
    }
  }
};

/// A point of the dual problem, all in the patch's own units.
struct Point {
  Vec3 z, eta;
  Dissipation d;
  [[nodiscard]] double value(const Mat3& a) const { return 0.5 * z.dot(a * z) + d.h; }
  [[nodiscard]] Vec3 residual() const { return z + d.gradient; }
};

Point point_at(const ScaledPatch& patch, const Vec3& z, const Vec3& eta, int& evaluations) {
  ++evaluations;
  return {z, eta, patch.evaluate(eta)};
}

/// Full friction against the free acceleration.
Point start_opposed(const ScaledPatch& patch, const Mat3& a, const Vec3& b, const Vec3& along,
                    int& evaluations) {
  const Vec3 z = -patch.evaluate(along).gradient;
  ++evaluations;
  return point_at(patch, z, b + a * z, evaluations);
}

/// On the ray η = −λn, n the normal at which the unlimited wrench z0 leaves the set: there the
/// dual has its minimum at λ = (n·z0 − h(n))/(n·A⁻¹n). Good when z0 is only just outside.
Point start_on_ray(const ScaledPatch& patch, const Inverse& inverse, const Vec3& z0, const Vec3& n,
                   int& evaluations) {
  const Dissipation d = patch.evaluate(n);
  ++evaluations;
  const Vec3 along = inverse.inverse * n;
  const double lambda = (n.dot(z0) - d.h) / n.dot(along);
  return point_at(patch, z0 - lambda * along, -lambda * (inverse.range * n), evaluations);
}

bool acceptable(double value0, double slope0, double value, double slope, double step) {
  const double rounding = 1e-14 * (1 + std::abs(value0));
  return value <= value0 + 1e-4 * step * slope0 ||
         (std::abs(slope) <= 0.5 * std::abs(slope0) && value <= value0 + rounding);
}

/// Newton on the dual; true when the residual is within tolerance.
bool minimise(const ScaledPatch& patch, const Mat3& a, Point& p, int& evaluations) {
  for (int i = 0; i < k_max_newton; ++i) {
    const Vec3 residual = p.residual();
    if (residual.norm() <= k_tolerance)
      return true;
    const Mat3 matrix = Mat3::Identity() + p.d.hessian * a;
    const Vec3 dz = -matrix.partialPivLu().solve(residual);
    const Vec3 d_eta = a * dz;
    const double value0 = p.value(a), slope0 = d_eta.dot(residual);
    Point next = p;
    for (double s = 1; s > 1e-9; s *= 0.5) {
      next = point_at(patch, p.z + s * dz, p.eta + s * d_eta, evaluations);
      if (acceptable(value0, slope0, next.value(a), next.residual().dot(d_eta), s))
        break;
    }
    p = next;
  }
  return p.residual().norm() <= k_tolerance;
}

} // namespace

AdmissibleWrench admissible_wrench(const Patch& patch, const Mat3& mobility,
                                   const Vec3& free_acceleration, const Vec3& warm) {
  AdmissibleWrench out;
  if (patch.empty()) {
    out.acceleration = free_acceleration;
    out.slips = !free_acceleration.isZero(0);
    return out;
  }
  const ScaledPatch scaled(patch);
  const Mat3 a = scaled.scaled_mobility(mobility);
  const Vec3 b = scaled.scaled_twist(free_acceleration);
  const Inverse inverse(a);
  const Vec3 z0 = -inverse.inverse * b;
  const bool reachable = (b - inverse.range * b).norm() <= 1e-9 * b.norm();

  const RequiredPressure need = required_pressure(patch, scaled.wrench(z0), -warm);
  out.evaluations = need.evaluations;
  if (reachable && need.u <= 1) {
    out.wrench = scaled.wrench(z0);
    return out;
  }
  Point p = start_opposed(scaled, a, b, warm.isZero(0) ? b : scaled.scaled_twist(warm),
                          out.evaluations);
  if (reachable) {
    const Point q = start_on_ray(scaled, inverse, z0, scaled.scaled_twist(need.direction),
                                 out.evaluations);
    if (q.value(a) < p.value(a))
      p = q;
  }
  out.converged = minimise(scaled, a, p, out.evaluations);
  out.slips = p.eta.norm() > k_no_slip * b.norm();
  out.wrench = scaled.wrench(out.slips ? Vec3(-p.d.gradient) : p.z);
  if (out.slips)
    out.acceleration = scaled.twist(p.eta);
  return out;
}

} // namespace steplap
