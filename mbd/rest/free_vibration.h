// Small vibrations in a few coordinates η without constraints: a dense eigenvalue problem.
//
//   η'' = A η + B η' + R s,   s' = Q η' + diag(S) s,   δq = basis η,   basisᵀ M basis = 1
// The inner states s relax: S < 0. There may be none.
// Motions without stiffness (A η = 0) are separated first, with the rounding error of their own terms as tolerance. The state matrix of the
// others is balanced, and each eigenvalue is refined on (λ² − λ B − A) x = 0. Slow modes are therefore accurate next to fast or strongly
// damped ones.
#pragma once

#include "mbd/base/types.h"

#include <complex>
#include <functional>
#include <vector>

namespace steplap {

struct FreeVibration {
  MatX a, b, basis;
  MatX held;                     ///< orthonormal basis of motions with stiffness, as columns
  MatX loose;                    ///< orthonormal basis of motions without stiffness: null vectors of A
  MatX inner_force = MatX(0, 0); ///< R; without columns if there are no inner states
  MatX inner_drive = MatX(0, 0); ///< Q
  VecX inner_decay = VecX(0);    ///< S, 1/s

  /// Returns R (λ − S)⁻ᵖ Q with p = `power`. For p = 1 this is the damping by inner states in a motion that grows as exp(λ t).
  [[nodiscard]] Eigen::MatrixXcd relaxation(const std::complex<double>& lambda, int power = 1) const;

  /// Determines `held` and `loose`. For columns x of displacements of the whole model, sizes_of returns |K| |x|, with K the stiffness of
  /// the model.
  void separate_null_motions(const std::function<MatX(const MatX&)>& sizes_of);
};

struct FreeMode {
  std::complex<double> eigenvalue; ///< 1/s; of a conjugate pair the one with positive imaginary part
  Eigen::VectorXcd x;              ///< η, length 1
};
/// Returns the modes in no order; none has eigenvalue zero. Throws NumericalFailure if the eigenvalues do not converge.
[[nodiscard]] std::vector<FreeMode> modes_of(const FreeVibration& v);

} // namespace steplap
