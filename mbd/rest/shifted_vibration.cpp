#include "mbd/rest/shifted_vibration.h"

#include "mbd/rest/tangent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

using Sparse = SparseVibration::Sparse;
using MatrixEntry = Statics::MatrixEntry;

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
// Multiple of the largest eigenvalue below which eigenvalues may be rounding errors of the stiffness and its factors.
constexpr double k_loose = 1000.0 * k_epsilon;
constexpr double k_skew = 1e-9;

Sparse sparse(const std::vector<MatrixEntry>& entries, Eigen::Index n) {
  Sparse matrix(static_cast<int>(n), static_cast<int>(n));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Sparse diagonal(const VecX& values) {
  std::vector<MatrixEntry> entries;
  for (int i = 0; i < static_cast<int>(values.size()); ++i) entries.emplace_back(i, i, values[i]);
  return sparse(entries, values.size());
}

// Returns an upper bound of eigenvalues: the largest row sum of |a| in the mass metric.
double bound_of(const Sparse& a, const VecX& mass) {
  VecX sum = VecX::Zero(mass.size());
  for (int c = 0; c < a.outerSize(); ++c)
    for (Sparse::InnerIterator it(a, c); it; ++it) sum[c] += std::abs(it.value()) / std::sqrt(mass[it.row()] * mass[c]);
  return sum.size() > 0 ? sum.maxCoeff() : 0.0;
}

} // namespace

SparseVibration::SparseVibration(const System& system, State& state) {
  Statics statics(system);
  statics.evaluate(state);
  statics.collect_rows(state);
  n_ = statics.coordinates();
  scale_ = scale_of(system, state).scale;
  mass_.resize(n_);
  for (int k = 0; k < static_cast<int>(n_); ++k) {
    const BodyData& body = system.bodies[static_cast<std::size_t>(k / 3 + 1)];
    mass_[k] = (k % 3 < 2 ? body.mass : body.inertia) * scale_[k] * scale_[k];
  }
  rows_.measure_and_rank(statics, scale_);
  find_forces(statics);
  find_bare();
  find_bounds();
  unit_mass_ = mass_.maxCoeff();
  by_mass_.set(diagonal(mass_ / unit_mass_), rows(), VecX::Zero(n_));
  (void)by_mass_.factor(0.0);
  counting_.set(symmetric_, rows(), mass_);
}

void SparseVibration::find_forces(const Statics& statics) {
  VecX lambda = VecX::Zero(static_cast<Eigen::Index>(rows().size()));
  if (!rows().empty()) {
    BorderedSystem onto;
    VecX reaction, left;
    onto.set(diagonal(VecX::Ones(n_)), rows(), VecX::Zero(n_));
    if (!onto.factor(0.0) || !onto.solve(scale_.cwiseProduct(statics.force()), left, &reaction))
      throw NumericalFailure("the reactions at rest, about which vibrations are looked for, cannot be found");
    lambda = -reaction.cwiseQuotient(rows_.size());
  }
  std::vector<MatrixEntry> k, d, both;
  statics.stiffness(lambda, k);
  statics.damping(d);
  size_ = std::numeric_limits<double>::min();
  for (MatrixEntry& e : k) {
    e = MatrixEntry(e.row(), e.col(), -e.value() * scale_[e.row()] * scale_[e.col()]);
    size_ = std::max(size_, std::abs(e.value()));
  }
  for (MatrixEntry& e : k) {
    e = MatrixEntry(e.row(), e.col(), e.value() / size_);
    both.emplace_back(e.row(), e.col(), 0.5 * e.value());
    both.emplace_back(e.col(), e.row(), 0.5 * e.value());
  }
  for (MatrixEntry& e : d) e = MatrixEntry(e.row(), e.col(), -e.value() * scale_[e.row()] * scale_[e.col()] / size_);
  for (int i = 0; i < static_cast<int>(n_); ++i) both.emplace_back(i, i, 0.0);
  mass_ /= size_;
  stiffness_ = sparse(k, n_);
  damping_ = sparse(d, n_);
  symmetric_ = sparse(both, n_);
  is_symmetric_ = Sparse(stiffness_ - symmetric_).cwiseAbs().sum() <= k_skew * stiffness_.cwiseAbs().sum();
  is_damped_ = damping_.cwiseAbs().sum() > 0.0;
}

void SparseVibration::find_bare() {
  bare_.assign(static_cast<std::size_t>(n_), 1);
  for (const Sparse* part : {&stiffness_, &damping_})
    for (int c = 0; c < part->outerSize(); ++c)
      for (Sparse::InnerIterator it(*part, c); it; ++it)
        if (it.value() != 0.0) bare_[static_cast<std::size_t>(it.row())] = bare_[static_cast<std::size_t>(c)] = 0;
  for (const SparseRow& row : rows())
    for (int k = 0; k < row.count; ++k)
      if (row.j[k] != 0.0) bare_[static_cast<std::size_t>(row.at[k])] = 0;
  bare_count_ = static_cast<int>(std::count(bare_.begin(), bare_.end(), char{1}));
}

void SparseVibration::find_bounds() {
  stiffest_ = bound_of(symmetric_, mass_);
  fastest_decay_ = bound_of(damping_, mass_);
  loose_ = k_loose * std::max(stiffest_, 1e-290);
}

int SparseVibration::free_count() const {
  int count = static_cast<int>(n_);
  for (std::size_t r = 0; r < rows().size(); ++r) count -= rows_.is_dependent(r) ? 0 : 1;
  return count;
}

int SparseVibration::count_below(double s) {
  for (int i = 0; i < 4; ++i, s *= 1.0 + 1e-9) // if a pivot vanishes, s is increased slightly
    if (counting_.factor(-s)) return counting_.negative() - bare_count_;
  throw NumericalFailure("the motions that are softer than others cannot be counted: a pivot vanishes");
}

VecX SparseVibration::acceleration(const VecX& f) const {
  VecX x;
  if (!by_mass_.solve(f / unit_mass_, x)) throw NumericalFailure("the masses of a scene at rest cannot be inverted along its rows");
  return x;
}

bool ShiftedResponse::factor(const SparseVibration& scene, std::complex<double> sigma) {
  n_ = scene.coordinates();
  m_ = static_cast<Eigen::Index>(scene.rows().size());
  is_complex_ = sigma.imag() != 0.0;
  const int parts = is_complex_ ? 2 : 1;
  std::vector<MatrixEntry> entries;
  // Real and imaginary part of an unknown are neighbours in the vector of unknowns.
  const auto put = [&](int row, int column, std::complex<double> value) {
    entries.emplace_back(parts * row, parts * column, value.real());
    if (!is_complex_) return;
    entries.emplace_back(parts * row + 1, parts * column + 1, value.real());
    if (value.imag() == 0.0) return;
    entries.emplace_back(parts * row, parts * column + 1, -value.imag());
    entries.emplace_back(parts * row + 1, parts * column, value.imag());
  };
  for (int c = 0; c < static_cast<int>(n_); ++c) {
    for (Sparse::InnerIterator it(scene.stiffness(), c); it; ++it) put(static_cast<int>(it.row()), c, it.value());
    for (Sparse::InnerIterator it(scene.damping(), c); it; ++it) put(static_cast<int>(it.row()), c, sigma * it.value());
    put(c, c, scene.bare()[static_cast<std::size_t>(c)] != 0 ? 1.0 : sigma * sigma * scene.mass()[c]);
  }
  const int n = static_cast<int>(n_);
  for (int r = 0; r < static_cast<int>(m_); ++r) {
    const SparseRow& row = scene.rows()[static_cast<std::size_t>(r)];
    if (row.count == 0) put(n + r, n + r, 1.0); // a dependent row, which is empty
    for (int k = 0; k < row.count; ++k) {
      put(n + r, row.at[k], row.j[k]);
      put(row.at[k], n + r, row.j[k]);
    }
  }
  matrix_ = sparse(entries, parts * (n_ + m_));
  factors_.compute(matrix_);
  return factors_.info() == Eigen::Success;
}

// Solves with one refinement, because pivots are chosen for sparsity rather than size.
VecX ShiftedResponse::solve_real(const VecX& right) const {
  VecX x = factors_.solve(right);
  x += factors_.solve(VecX(right - matrix_ * x));
  return x;
}

Eigen::VectorXcd ShiftedResponse::solve(const Eigen::VectorXcd& f) const {
  Eigen::VectorXcd a(n_);
  if (is_complex_) {
    VecX right = VecX::Zero(2 * (n_ + m_));
    for (Eigen::Index i = 0; i < n_; ++i) {
      right[2 * i] = f[i].real();
      right[2 * i + 1] = f[i].imag();
    }
    const VecX x = solve_real(right);
    for (Eigen::Index i = 0; i < n_; ++i) a[i] = {x[2 * i], x[2 * i + 1]};
    return a;
  }
  VecX right = VecX::Zero(n_ + m_), imaginary = VecX::Zero(n_);
  right.head(n_) = f.real();
  const VecX real = solve_real(right).head(n_);
  if (f.imag().cwiseAbs().maxCoeff() > 0.0) {
    right.head(n_) = f.imag();
    imaginary = solve_real(right).head(n_);
  }
  for (Eigen::Index i = 0; i < n_; ++i) a[i] = {real[i], imaginary[i]};
  return a;
}

} // namespace steplap
