// Small vibrations in a few coordinates without constraints: a dense eigenvalue problem.
//
//   η'' = A η + B η',   δq = basis η,   basisᵀ M basis = 1
// Motions without stiffness (A η = 0) are separated first, with the rounding of their own terms. The state matrix of the rest is balanced,
// and each eigenvalue is refined on (λ² − λ B − A) x = 0. So slow modes stay accurate next to fast or strongly damped ones.
#pragma once

#include "mbd/base/types.h"

#include <complex>
#include <functional>
#include <vector>

namespace steplap {

struct FreeVibration {
  MatX a, b, basis;
  MatX held;  ///< orthonormal basis of motions with stiffness
  MatX loose; ///< orthonormal basis of motions without: null vectors of A

  /// Determines `held` and `loose`. `sizes_of` returns |K| |x| for each column x of displacements of the whole model, with K its stiffness.
  void part_loose(const std::function<MatX(const MatX&)>& sizes_of);
};

struct FreeMode {
  std::complex<double> eigenvalue; ///< 1/s; of a conjugate pair the one with positive imaginary part
  Eigen::VectorXcd x;              ///< η, length 1
};
/// Returns the modes in no order; none has eigenvalue zero. Throws NumericalFailure if the eigenvalues do not converge.
[[nodiscard]] std::vector<FreeMode> modes_of(const FreeVibration& v);

} // namespace steplap
