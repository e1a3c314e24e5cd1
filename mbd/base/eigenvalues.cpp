#include "mbd/base/decompositions.h"

#include <Eigen/Eigenvalues>

namespace steplap {

SymmetricEigen symmetric_eigen(const MatX& a) {
  const Eigen::SelfAdjointEigenSolver<MatX> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigenpairs eigenpairs(const MatX& a) {
  const Eigen::EigenSolver<MatX> solver(a);
  const bool is_converged = solver.info() == Eigen::Success;
  if (!is_converged) return {};
  return {solver.eigenvalues(), solver.eigenvectors(), true};
}

Eigen::VectorXcd eigenvalues(const MatX& a) { return Eigen::EigenSolver<MatX>(a, false).eigenvalues(); }

} // namespace steplap
