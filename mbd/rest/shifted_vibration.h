// Matrices for small vibrations of a large model, and solutions of their equations shifted by a complex number σ.
#pragma once

#include "mbd/rest/bordered_system.h"
#include "mbd/rest/sparse_rows.h"
#include "mbd/rest/statics.h"

#include <Eigen/SparseLU>

#include <complex>
#include <vector>

namespace steplap {

/// The matrices of (λ² M + λ D̂ + K̂) x along the rows, in scaled coordinates (tangent.h), divided by a common factor such that entries of
/// K̂ are of order 1.
class SparseVibration {
public:
  using Sparse = BorderedSystem::Sparse;

  /// Linearises at the poses of `state`, an equilibrium.
  SparseVibration(const System& system, State& state);

  [[nodiscard]] Eigen::Index coordinates() const { return n_; }
  [[nodiscard]] const VecX& scale() const { return scale_; }
  [[nodiscard]] const VecX& mass() const { return mass_; }             ///< kg/size
  [[nodiscard]] const Sparse& stiffness() const { return stiffness_; } ///< K̂
  [[nodiscard]] const Sparse& damping() const { return damping_; }     ///< D̂
  [[nodiscard]] const std::vector<SparseRow>& rows() const { return rows_.rows(); }
  [[nodiscard]] bool is_symmetric() const { return is_symmetric_; } ///< K̂ is symmetric
  [[nodiscard]] bool is_damped() const { return is_damped_; }
  /// Returns flags of the coordinates on which no force and no row acts.
  [[nodiscard]] const std::vector<char>& bare() const { return bare_; }
  [[nodiscard]] int bare_count() const { return bare_count_; }
  [[nodiscard]] int free_count() const; ///< coordinates minus independent rows
  /// Bounds of squared frequencies, 1/s². Values below loose() may be rounding errors; no value exceeds stiffest().
  [[nodiscard]] double loose() const { return loose_; }
  [[nodiscard]] double stiffest() const { return stiffest_; }
  [[nodiscard]] double fastest_decay() const { return fastest_decay_; } ///< upper bound of decay rates by damping alone, 1/s

  /// Returns the number of directions along the rows in which the symmetric part of K̂ − s M is negative; bare coordinates are not counted.
  /// Precondition: s > 0.
  [[nodiscard]] int count_below(double s);
  /// Returns M⁻¹ f, projected onto the motions that the rows allow.
  [[nodiscard]] VecX acceleration(const VecX& f) const;

private:
  void find_forces(const Statics& statics);
  void find_bare();
  void find_bounds();

  Eigen::Index n_ = 0;
  VecX scale_, mass_;
  SparseRows rows_;
  Sparse stiffness_, damping_, symmetric_;
  std::vector<char> bare_;
  int bare_count_ = 0;
  bool is_symmetric_ = true, is_damped_ = false;
  double size_ = 1.0, unit_mass_ = 1.0, loose_ = 0.0, stiffest_ = 0.0, fastest_decay_ = 0.0;
  BorderedSystem by_mass_, counting_;
};

/// Factors of σ² M + σ D̂ + K̂, bordered by the rows. For complex σ, real and imaginary parts are separate unknowns.
class ShiftedResponse {
public:
  /// Factorises the matrix for the shift `sigma`. Returns false if it is singular.
  bool factor(const SparseVibration& scene, std::complex<double> sigma);
  /// Returns the solution a of (σ² M + σ D̂ + K̂) a + Jᵀ y = f, J a = 0.
  [[nodiscard]] Eigen::VectorXcd solve(const Eigen::VectorXcd& f) const;

private:
  [[nodiscard]] VecX solve_real(const VecX& right) const;

  Eigen::Index n_ = 0, m_ = 0;
  bool is_complex_ = false;
  SparseVibration::Sparse matrix_;
  Eigen::SparseLU<SparseVibration::Sparse> factors_;
};

} // namespace steplap
