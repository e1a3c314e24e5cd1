// Small vibrations in a few coordinates that nothing binds: a dense problem, and its modes.
//
//   η'' = A η + B η',   δq = basis η,   basisᵀ M basis = 1
// Motions that nothing holds (A η = 0) are parted off before any eigenvalue is asked for, with rounding that is theirs;
// the state matrix of the others is balanced, and each eigenvalue refined on (λ² − λ B − A) x = 0, so that slow modes
// keep their digits beside fast or strongly damped ones.
#pragma once

#include "mbd/base/types.h"

#include <complex>
#include <functional>
#include <vector>

namespace steplap {

struct FreeVibration {
  MatX a, b, basis;
  MatX held;  ///< orthonormal: motions that something holds
  MatX loose; ///< and those that nothing holds: null vectors of A

  /// Finds held and loose. `sizes_of`: |K| |x| of each column x of motions of the whole scene, K its stiffness.
  void part_loose(const std::function<MatX(const MatX&)>& sizes_of);
};

struct FreeMode {
  std::complex<double> eigenvalue; ///< 1/s; of a pair the one with the positive imaginary part
  Eigen::VectorXcd x;              ///< η, length 1
};
/// In no order; no eigenvalue is zero. Throws NumericalFailure where they do not converge.
[[nodiscard]] std::vector<FreeMode> modes_of(const FreeVibration& v);

} // namespace steplap
