// Finds some modes of small vibration of a large model: the slowest ones, or those near a frequency.
//
// With M, K̂ = −K, D̂ = −∂Q/∂v in scaled coordinates and rows J (statics.h), modes satisfy (λ² M + λ D̂ + K̂) x + Jᵀ y = 0, J x = 0. For a
// shift σ, 0 or 2π i f, the operator
//   (q, v) → (a, q + σ a),   (σ² M + σ D̂ + K̂) a + Jᵀ y = −(M v + (D̂ + σ M) q),   J a = 0
// multiplies a mode by 1/(λ − σ), so its Krylov space approximates the modes nearest to σ first. Displacements q and v are stored in one
// real M-orthonormal basis W of half the dimension, and vectors by their components in it (TOAR: D. Lu, Y. Su, Z. Bai, SIAM J. Matrix Anal.
// Appl. 37 (2016) 195). The space starts with several vectors, so that modes of equal frequency are all found. The forces along W form a
// small dense problem (free_vibration.h). W grows until the residuals show that all wanted modes are modes of the model.
//
// Completeness: by Sylvester's law, the pivots of K̂ − s M give the number of directions of the model softer than s (bordered_system.h). W
// never has more of them. If it has the same number up to the last wanted mode, none is missing. Near a frequency, modes of an undamped
// model are counted on both sides. If the model has rigid motions, σ = 0 would be an eigenvalue; then σ is real and well below the first
// mode.
#pragma once

#include "mbd/rest/modes.h"

#include <Eigen/Core>

#include <complex>
#include <vector>

namespace steplap {

struct SparseModes {
  struct Mode {
    std::complex<double> eigenvalue;
    Eigen::VectorXcd q;    ///< coordinates of all bodies except the ground, m and rad
    double residual = 0.0; ///< VibrationMode::residual
  };
  std::vector<Mode> modes;
  int rigid_motions = 0;
  bool is_all = false;     ///< W spans all motions of the model
  bool is_counted = false; ///< it was checked by a count that no wanted mode is missing
};

/// Returns the modes. Precondition: `wanted.count` > 0. Throws NumericalFailure if they do not converge.
[[nodiscard]] SparseModes sparse_modes(const System& system, State state, const WantedModes& wanted);

} // namespace steplap
