// The linear system of a linearly implicit method's stages, with constraints (a KKT matrix).
//
// A Rosenbrock method for y' = F(t, y), y = (q, v), solves (1/(γh) − ∂F/∂y) u = r in each stage. With
// q' = v and the linearised accelerations (linearization.h) the poses and the multipliers' share follow
// from the velocities' part; with W = M⁻¹, g = γh:
//   ⎡ I − g W D − g² W K     −W Jᵀ ⎤ ⎡u_v⎤   ⎡ g (r_v + g W K r_q)       ⎤
//   ⎣ J − g G_v − g² G_q       0   ⎦ ⎣ w ⎦ = ⎣ g (J r_v + g G_q r_q)     ⎦,   u_q = g (r_q + u_v).
// Locked coordinates have W = 0: their rows say u_v = g r_v. Rows of redundant constraints, as the
// Schur complement's factorisation has found them, are left out.
//
// Small systems are dense; large ones sparse, with the pattern analysed once while it stays the same.
#pragma once

#include "mbd/linearization.h"

#include <Eigen/LU>
#include <Eigen/SparseLU>

namespace steplap {

class StageSystem {
public:
  /// Takes over the linearisation; factor() must follow. `layout`: whose redundant rows are left out.
  void set(const Linearization& linearization, const Layout& layout);
  /// For g = γh, s. False if singular.
  [[nodiscard]] bool factor(double g);
  /// u = (1/g − ∂F/∂y)⁻¹ r; both of length 2n, (q, v).
  void solve(const double* r, double* u);

private:
  using Sparse = Eigen::SparseMatrix<double>;
  template <class Put> void assemble(double g, const Put& put) const;

  static constexpr int k_max_dense = 48; ///< unknowns: beyond, sparse factors are cheaper
  const Linearization* linearization_ = nullptr;
  std::vector<char> is_redundant_;
  int n_ = 0, m_ = 0;
  double g_ = 0.0;
  bool is_dense_ = true;
  MatX matrix_;
  Eigen::PartialPivLU<MatX> dense_;
  Sparse sparse_matrix_;
  Eigen::SparseLU<Sparse> sparse_;
  std::vector<Linearization::Triplet> entries_;
  std::vector<int> pattern_;
  VecX right_, solution_, moved_;
};

} // namespace steplap
