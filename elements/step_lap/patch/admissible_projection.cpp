#include "elements/step_lap/patch/admissible_projection.h"

#include "elements/step_lap/patch/gauge.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>

namespace steplap {

namespace {

constexpr int k_max_newton = 100;
constexpr double k_tolerance = 1e-11;       // tolerance of |z + ∇h(η)|, in units of the capacity
constexpr double k_gauge_tolerance = 1e-10; // tolerance of the direction; the error of u is of the order of its square
constexpr double k_rank = 1e-12;            // eigenvalues of A below this fraction of the largest count as zero
constexpr double k_touches = 1e-12;         // relative excess of a load over the bound that counts as none
constexpr double k_no_slip = 1e-15;         // η below this fraction of b is the rounding error of b + A z

/// Pseudo-inverse of a symmetric positive semidefinite matrix, and the projector onto its range.
struct Inverse {
  Mat3 inverse = Mat3::Zero();
  Mat3 range = Mat3::Zero(); ///< projector onto the range
  bool full = true;
  explicit Inverse(const Mat3& a) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(a);
    for (int i = 0; i < 3; ++i) {
      const double value = eigen.eigenvalues()[i];
      if (!(value > k_rank * eigen.eigenvalues()[2])) {
        full = false;
        continue;
      }
      const Mat3 axis = eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose();
      inverse += axis / value;
      range += axis;
    }
  }
};

/// A point of the dual problem, in the patch's own units.
struct Point {
  Vec3 z, eta;
  Dissipation d;
  /// Returns ½ zᵀA z + h, with A z computed as η − b, because for a large A the product would be mostly rounding.
  [[nodiscard]] double value(const Vec3& b) const { return 0.5 * z.dot(eta - b) + d.h; }
  [[nodiscard]] Vec3 residual() const { return z + d.gradient; }
};

Point point_at(const ScaledPatch& patch, const Vec3& z, const Vec3& eta, int& evaluations) {
  ++evaluations;
  return {z, eta, patch.evaluate(eta)};
}

/// Initial point: full friction against the free acceleration.
Point start_opposed(const ScaledPatch& patch, const Mat3& a, const Vec3& b, const Vec3& along, int& evaluations) {
  const Vec3 z = -patch.evaluate(along).gradient;
  ++evaluations;
  return point_at(patch, z, b + a * z, evaluations);
}

/// Initial point on the ray η = −λn, with n the normal where the line from 0 to the unlimited wrench z0 leaves the set. The dual has its
/// minimum on the ray at λ = (n·z0 − h(n))/(n·A⁻¹n). Accurate if z0 is only slightly outside.
Point start_on_ray(const ScaledPatch& patch, const Mat3& a, const Vec3& b, const Inverse& inverse, const Vec3& z0, const Gauge& exit,
                   int& evaluations) {
  const Vec3 n = exit.y, along = inverse.inverse * n;
  const double used = z0.norm() * exit.value; // n·z0 / h(n) > 1
  const double lambda = n.dot(z0) * (1 - 1 / used) / n.dot(along);
  // Starts from the wrench with the smallest utilisation among those that cancel b.
  Vec3 z = z0.norm() * exit.wrench - lambda * along;
  const Vec3 eta = -lambda * n;
  for (int i = 0; i < 2; ++i)
    z += inverse.inverse * (eta - b - a * z); // corrects z so that b + A z = η up to rounding, although η is small compared with b
  return point_at(patch, z, eta, evaluations);
}

/// Newton's method for the dual. Returns true if the residual is within the tolerance.
bool minimise(const ScaledPatch& patch, const Mat3& a, const Vec3& b, Point& p, int& evaluations) {
  for (int i = 0; i < k_max_newton; ++i) {
    const Vec3 residual = p.residual();
    if (residual.norm() <= k_tolerance) return true;
    const Mat3 matrix = Mat3::Identity() + p.d.hessian * a;
    const Vec3 dz = -matrix.partialPivLu().solve(residual);
    const Vec3 d_eta = a * dz;
    const double value0 = p.value(b), slope0 = d_eta.dot(residual);
    Point next = p;
    for (double s = 1; s > 1e-9; s *= 0.5) {
      next = point_at(patch, p.z + s * dz, p.eta + s * d_eta, evaluations);
      if (is_acceptable(value0, slope0, next.value(b), next.residual().dot(d_eta), s)) break;
    }
    p = next;
  }
  return p.residual().norm() <= k_tolerance;
}

} // namespace

AdmissibleWrench admissible_wrench(const Patch& patch, const Mat3& mobility, const Vec3& free_acceleration, const Vec3& warm) {
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
  Vec3 z0 = -inverse.inverse * b; // wrench that cancels b as far as possible
  z0 -= inverse.inverse * (b + a * z0);
  const bool holdable = (b - inverse.range * b).norm() <= k_rank * (b.norm() + a.norm() * z0.norm());
  const double size = z0.norm();
  if (holdable && size == 0) return out;

  Gauge need;
  if (holdable) {
    // Finds the wrench with the smallest utilisation among those that cancel b.
    need = find_gauge(scaled, z0 / size, Vec3::Zero(), k_gauge_tolerance, inverse.range);
    out.evaluations = need.evaluations;
    out.residual = need.residual;
    out.converged = need.converged;
    if (size * need.value <= 1) {
      out.wrench = scaled.wrench(inverse.full ? z0 : Vec3(size * need.wrench));
      return out;
    }
  }
  // If the load is at the bound, η is the rounding error of b + A z and has no direction for Newton's method. The result is then the wrench
  // on the bound, with this relative error, and a slip along the normal there.
  if (holdable && size * need.value - 1 <= k_touches) {
    out.slips = true;
    out.wrench = scaled.wrench(need.wrench / need.value);
    out.acceleration = scaled.twist(start_on_ray(scaled, a, b, inverse, z0, need, out.evaluations).eta);
    return out;
  }
  Point p = start_opposed(scaled, a, b, warm.isZero(0) ? b : scaled.scaled_twist(warm), out.evaluations);
  Point other = p;
  if (holdable) {
    const Point q = start_on_ray(scaled, a, b, inverse, z0, need, out.evaluations);
    // At the bound the values differ only by rounding, but the point on the ray is the solution.
    const bool is_solved = q.residual().norm() <= k_tolerance;
    (is_solved || q.value(b) < p.value(b) ? p : other) = q;
  }
  out.converged = minimise(scaled, a, b, p, out.evaluations);
  if (!out.converged) { // second start: the dual is convex, so every start leads to the same point
    out.converged = minimise(scaled, a, b, other, out.evaluations);
    if (out.converged || other.residual().norm() < p.residual().norm()) p = other;
  }
  out.residual = p.residual().norm();
  // If the bound is exceeded only by rounding, η cannot be determined from b + A z; sticking at the bound is then more accurate than any
  // slip found.
  if (!out.converged && holdable && size * need.value - 1.0 < out.residual) {
    out.residual = size * need.value - 1.0;
    out.wrench = scaled.wrench(Vec3(need.wrench / need.value));
    return out;
  }
  out.slips = p.eta.norm() > k_no_slip * b.norm();
  out.wrench = scaled.wrench(out.slips ? Vec3(-p.d.gradient) : p.z);
  if (out.slips) out.acceleration = scaled.twist(p.eta);
  return out;
}

} // namespace steplap
