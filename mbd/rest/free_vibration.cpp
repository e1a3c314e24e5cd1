#include "mbd/rest/free_vibration.h"

#include "mbd/base/decompositions.h"
#include "mbd/rest/modes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
constexpr double k_rounded_terms = 64.0;
// Largest number of free coordinates for which eigenvalues are refined; each refinement costs a factorisation.
constexpr Eigen::Index k_refined = 60;
constexpr double k_motionless = 1e-9; // share of a state vector, up to which its velocities are rounding errors
constexpr double k_near = 1e-3;       // relative change; a refinement that changes an eigenvalue by more has converged to another one

using Complex = std::complex<double>;
using ComplexMatrix = Eigen::MatrixXcd;
using ComplexVector = Eigen::VectorXcd;

// Returns the singular values of A with right vectors; for symmetric A from its eigenvectors.
std::pair<VecX, MatX> singular_vectors(const MatX& a) {
  if ((a - a.transpose()).cwiseAbs().sum() <= 1e-9 * a.cwiseAbs().sum()) {
    const auto [values, vectors] = symmetric_eigen(0.5 * (a + a.transpose()));
    return {values.cwiseAbs(), vectors};
  }
  const auto [values, v] = right_singular(a);
  return {values, v};
}

// Returns an orthonormal basis of the vectors orthogonal to the columns.
MatX complement(const MatX& columns) {
  const Eigen::Index n = columns.rows();
  if (columns.cols() == 0) return MatX::Identity(n, n);
  return orthonormal(columns, n).rightCols(n - columns.cols());
}

// Returns the motions at constant velocity that nothing damps, as columns (β, η', s): Vᵀη' = 0, A V β + B η' + R s = 0 and Q η' + S s = 0,
// where V is v.held.
MatX steady_motions(const FreeVibration& v) {
  const Eigen::Index r = v.a.cols(), k = v.held.cols(), m = v.inner_decay.size();
  if (v.loose.cols() == 0) return MatX(k + r + m, 0);
  MatX b = v.b, follow(m, r); // s = follow η'
  if (m > 0) {
    follow = -(v.inner_decay.cwiseInverse().asDiagonal() * v.inner_drive);
    b += v.inner_force * follow;
  }
  const MatX av = v.a * v.held, bl = b * v.loose;
  MatX beyond = bl;
  if (k > 0) {
    const MatX q = orthonormal(av, k);
    beyond -= q * (q.transpose() * bl);
  }
  const double size = (b.cwiseAbs() * v.loose.cwiseAbs()).norm();
  const RightSingular singular = right_singular(beyond);
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < v.loose.cols(); ++i)
    if (i >= singular.values.size() || singular.values[i] <= k_rounded_terms * k_epsilon * size) free.push_back(i);
  MatX motions(k + r + m, static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) {
    const VecX rate = v.loose * singular.v.col(free[i]);
    const auto at = static_cast<Eigen::Index>(i);
    if (k > 0) motions.col(at).head(k) = -least_squares(av, b * rate);
    motions.col(at).segment(k, r) = rate;
    if (m > 0) motions.col(at).tail(m) = follow * rate;
  }
  return motions;
}

// Balances m: replaces it by D⁻¹ m D, with D of powers of two, such that rows and columns have similar size (B. N. Parlett, C. Reinsch,
// Numer. Math. 13 (1969) 293). This keeps slow modes accurate next to fast ones. Returns D.
VecX balance(MatX& m) {
  const Eigen::Index n = m.rows();
  VecX d = VecX::Ones(n);
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      double column = m.col(i).cwiseAbs().sum() - std::abs(m(i, i)), row = m.row(i).cwiseAbs().sum() - std::abs(m(i, i));
      if (column == 0.0 || row == 0.0) continue;
      const double before = column + row;
      double f = 1.0;
      for (; column < 0.5 * row; column *= 4.0) f *= 2.0;
      for (; column >= 2.0 * row; column *= 0.25) f *= 0.5;
      if ((column + row) / f >= 0.95 * before) continue;
      is_changed = true;
      d[i] *= f;
      m.col(i) *= f;
      m.row(i) /= f;
    }
  }
  return d;
}

// Refines an eigenvalue by Newton's method for (λ² − λ (B + R (λ − S)⁻¹ Q) − A) x = 0, that is, inverse iteration with a moving shift. The
// remaining error is the rounding of the mode's own terms.
void refine(const FreeVibration& v, Complex& value, ComplexVector& x) {
  const Eigen::Index r = v.a.cols();
  Complex at = value;
  ComplexVector shape = x;
  double last = k_near;
  for (int i = 0; i < 6; ++i) {
    ComplexMatrix q = -at * v.b.cast<Complex>() - v.a.cast<Complex>();
    q.diagonal().array() += at * at;
    ComplexVector right = Complex(2.0) * at * shape - v.b.cast<Complex>() * shape;
    if (v.inner_decay.size() > 0) {
      const ComplexMatrix relaxation = v.relaxation(at);
      q -= at * relaxation;
      right -= relaxation * shape - at * (v.relaxation(at, 2) * shape);
    }
    for (Eigen::Index k = 0; k < r; ++k) { // scales rows to equal size, so that pivots do not depend on the stiffest rows
      double size = 0.0;
      for (Eigen::Index j = 0; j < r; ++j) size = std::max(size, std::abs(q(k, j).real()) + std::abs(q(k, j).imag()));
      if (!(size > 0.0)) return;
      q.row(k) /= size;
      right[k] /= size;
    }
    const ComplexVector next = solve_complex(q, right);
    const Complex ratio = shape.dot(next);
    if (!next.allFinite() || size_of(ratio) == 0.0) break; // `value` is an eigenvalue to the last digit
    const Complex change = Complex(shape.squaredNorm()) / ratio;
    const double moved = size_of(change) / size_of(at);
    if (!(moved < last)) break;
    at -= change;
    shape = next / next.norm();
    last = moved;
  }
  if (last >= k_near) return;
  value = at;
  x = shape;
}

} // namespace

Eigen::MatrixXcd FreeVibration::relaxation(const Complex& lambda, int power) const {
  ComplexVector gain = (lambda - inner_decay.cast<Complex>().array()).inverse();
  if (power == 2) gain = gain.array().square();
  return inner_force.cast<Complex>() * gain.asDiagonal() * inner_drive.cast<Complex>();
}

void FreeVibration::separate_null_motions(const std::function<MatX(const MatX&)>& sizes_of) {
  // Motions without stiffness are the singular vectors of A whose singular value is a rounding error of the stiffness. Each value is
  // compared with the rounding of its own terms, not with that of the stiffest motion.
  const auto [sizes, vectors] = singular_vectors(a);
  const MatX shapes = basis * vectors;
  const MatX size = sizes_of(shapes);
  std::vector<Eigen::Index> firm, free;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const double terms = shapes.col(i).cwiseAbs().dot(size.col(i));
    const double rounding = k_epsilon * (k_rounded_terms * terms + 4.0 * sizes.maxCoeff());
    (sizes[i] <= rounding ? free : firm).push_back(i);
  }
  const auto columns = [this, &all = vectors](const std::vector<Eigen::Index>& which) { // clang 14 accepts no binding here without a name
    MatX out(a.cols(), static_cast<Eigen::Index>(which.size()));
    for (std::size_t i = 0; i < which.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = all.col(which[i]);
    return out;
  };
  held = columns(firm);
  loose = columns(free);
}

std::vector<FreeMode> modes_of(const FreeVibration& v) {
  std::vector<FreeMode> found;
  const Eigen::Index r = v.a.cols(), k = v.held.cols(), m = v.inner_decay.size();
  // State (β, η', s): positions along motions with stiffness, velocities, and inner states. Velocities that nothing resists are removed, so
  // that no eigenvalue is zero.
  MatX whole = MatX::Zero(k + r + m, k + r + m);
  whole.block(0, k, k, r) = v.held.transpose();
  whole.block(k, 0, r, k) = v.a * v.held;
  whole.block(k, k, r, r) = v.b;
  if (m > 0) {
    whole.block(k, k + r, r, m) = v.inner_force;
    whole.block(k + r, k, m, r) = v.inner_drive;
    whole.bottomRightCorner(m, m).diagonal() = v.inner_decay;
  }
  const MatX moving = complement(steady_motions(v));
  if (moving.cols() == 0) return found;
  MatX companion = moving.transpose() * whole * moving;
  const VecX scale = balance(companion);
  const auto [values, vectors, is_converged] = eigenpairs(companion);
  if (!is_converged) throw NumericalFailure("the eigenvalues of the small vibrations do not converge");
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (values[i].imag() < 0.0) continue;
    const ComplexVector state_vector = moving * scale.asDiagonal() * vectors.col(i);
    ComplexVector x = state_vector.segment(k, r);
    if (m > 0 && x.norm() <= k_motionless * state_vector.norm()) continue; // inner states relax against each other
    x /= x.norm();
    FreeMode mode{values[i], std::move(x)};
    if (r <= k_refined) refine(v, mode.eigenvalue, mode.x);
    found.push_back(std::move(mode));
  }
  return found;
}

} // namespace steplap
