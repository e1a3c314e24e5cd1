// The forces of small vibrations of a large scene, and their response at one point of the complex plane.
#pragma once

#include "mbd/rest/bordered_system.h"
#include "mbd/rest/sparse_rows.h"
#include "mbd/rest/statics.h"

#include <Eigen/SparseLU>

#include <complex>
#include <vector>

namespace steplap {

/// λ² M + λ D̂ + K̂ along the rows, of scaled coordinates (tangent.h), all over one size so that entries of K̂ are of order 1.
class SparseVibration {
public:
  using Sparse = BorderedSystem::Sparse;

  /// At the poses of `state`, which are at rest.
  SparseVibration(const System& system, State& state);

  [[nodiscard]] Eigen::Index coordinates() const { return n_; }
  [[nodiscard]] const VecX& scale() const { return scale_; }
  [[nodiscard]] const VecX& mass() const { return mass_; }             ///< kg over the size
  [[nodiscard]] const Sparse& stiffness() const { return stiffness_; } ///< K̂
  [[nodiscard]] const Sparse& damping() const { return damping_; }     ///< D̂
  [[nodiscard]] const std::vector<SparseRow>& rows() const { return rows_.rows(); }
  [[nodiscard]] bool is_symmetric() const { return is_symmetric_; } ///< K̂
  [[nodiscard]] bool is_damped() const { return is_damped_; }
  /// Coordinates that no force and no row has to do with.
  [[nodiscard]] const std::vector<char>& bare() const { return bare_; }
  [[nodiscard]] int bare_count() const { return bare_count_; }
  [[nodiscard]] int free_count() const; ///< coordinates less independent rows
  /// Squares of frequencies, 1/s²: below the first what is found may be rounding; the last is beyond all.
  [[nodiscard]] double loose() const { return loose_; }
  [[nodiscard]] double stiffest() const { return stiffest_; }
  [[nodiscard]] double fastest_decay() const { return fastest_decay_; } ///< 1/s, beyond all that damping alone makes

  /// Directions along the rows in which the symmetric part of K̂ − s M is negative, s > 0, bare ones left out.
  [[nodiscard]] int count_below(double s);
  /// M⁻¹ f along the rows.
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

/// Factors of σ² M + σ D̂ + K̂ bordered by the rows; of a complex σ as real equations of real and imaginary parts.
class ShiftedResponse {
public:
  /// False where they are singular.
  bool factor(const SparseVibration& scene, std::complex<double> sigma);
  /// a of (σ² M + σ D̂ + K̂) a + Jᵀ y = f, J a = 0.
  [[nodiscard]] Eigen::VectorXcd solve(const Eigen::VectorXcd& f) const;

private:
  [[nodiscard]] VecX solve_real(const VecX& right) const;

  Eigen::Index n_ = 0, m_ = 0;
  bool is_complex_ = false;
  SparseVibration::Sparse matrix_;
  Eigen::SparseLU<SparseVibration::Sparse> factors_;
};

} // namespace steplap
