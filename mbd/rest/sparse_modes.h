// Some of the small vibrations of a large scene: the slowest, or those near a frequency.
//
// With M, K̂ = −K, D̂ = −∂Q/∂v of the scaled coordinates and rows J (statics.h), modes are (λ² M + λ D̂ + K̂) x + Jᵀ y = 0, J x = 0.
// About a point σ of the complex plane, 0 or 2π i f, the Krylov space of
//   (q, v) → (a, q + σ a),   (σ² M + σ D̂ + K̂) a + Jᵀ y = −(M v + (D̂ + σ M) q),   J a = 0
// holds the modes next to σ first: 1/(λ − σ) is what their part grows by. Its displacements q and v lie in one real space W
// of half as many directions, M-orthonormal, and the vectors are kept by what they are made of in it (D. Lu, Y. Su, Z. Bai, SIAM
// J. Matrix Anal. Appl. 37 (2016) 195: TOAR). It begins with several vectors, so that modes of one frequency are found beside each
// other. The scene's forces along W are a small dense problem (free_vibration.h), whose modes are the scene's where the residual says
// so: W grows until it does, of every mode wanted.
//
// Is one missing? By Sylvester's law the pivots of K̂ − s M count the scene's directions softer than s (bordered_system.h). Along
// any W there are as many or fewer; W is full up to the last mode wanted if there are as many. Near a frequency an undamped scene
// is counted on both sides. Where σ = 0 is itself a motion that nothing holds, σ is real and well below the first mode.
#pragma once

#include "mbd/rest/modes.h"

#include <Eigen/Core>

#include <complex>
#include <vector>

namespace steplap {

struct SparseModes {
  struct Mode {
    std::complex<double> eigenvalue;
    Eigen::VectorXcd q;    ///< of the coordinates of all bodies but the ground, m and rad
    double residual = 0.0; ///< VibrationMode::residual
  };
  std::vector<Mode> modes;
  int rigid_motions = 0;
  bool is_all = false;     ///< the space was the whole scene's
  bool is_counted = false; ///< no mode wanted is missing
};

/// `wanted.count` is given. Throws NumericalFailure where the modes do not converge.
[[nodiscard]] SparseModes sparse_modes(const System& system, State state, const WantedModes& wanted);

} // namespace steplap
