// The linear system of a linearly implicit method's stages, with constraints (a KKT matrix).
//
// A Rosenbrock method for y' = F(t, y), y = (q, v), solves (1/(γh) − ∂F/∂y) u = r in each stage. With
// q' = v and the linearised accelerations (linearization.h) the poses and the multipliers' share follow
// from the velocities' part; with W = M⁻¹, g = γh:
//   ⎡ I − g W D − g² W K     −W Jᵀ ⎤ ⎡u_v⎤   ⎡ g (r_v + g W K r_q)       ⎤
//   ⎣ J − g G_v − g² G_q       0   ⎦ ⎣ w ⎦ = ⎣ g (J r_v + g G_q r_q)     ⎦,   u_q = g (r_q + u_v).
// Inner states z of force elements are eliminated, each from its own small block (linearization.h):
//   u_z = A (r_z + P u_q + V u_v), A = (1/g − Z)⁻¹, which adds F_z A (g P + V) to D and F_z A (r_z + g P r_q) to the forces.
// Own states of the model, which may hang on all coordinates and on each other, are eliminated together in the same way.
// Locked coordinates have W = 0: their rows say u_v = g r_v. Rows of redundant constraints, as the
// Schur complement's factorisation has found them, are left out.
//
// That r is one of rates that meet the constraints: what of it does not is left standing. A force that is added
// (friction, in time stepping) brings the constraints' answer only with
//   r = (0, W f), the lower right side 0:   J u_v − g G_v u_v − g² G_q u_v = 0.
//
// Small systems are dense; large ones sparse (sparse_lu.h), with the pattern analysed once while it stays the same.
// Once a system of its size has been solved nothing is allocated.
#pragma once

#include "mbd/base/decompositions.h"
#include "mbd/dynamics/linearization.h"
#include "mbd/integrators/sparse_lu.h"

#include <Eigen/LU> // of three rows, and of as many as there are own states

namespace steplap {

class StageSystem {
public:
  /// Takes over the linearisation; factor() must follow. `layout`: whose redundant rows are left out.
  void set(const Linearization& linearization, const Layout& layout);
  /// For g = γh, s. False if singular.
  [[nodiscard]] bool factor(double g);
  /// u = (1/g − ∂F/∂y)⁻¹ r; both (q, v, z), of length 2n and that of the inner states.
  void solve(const double* r, double* u);
  /// The same for forces: `pull` has the n velocities' parts W f of r; rows and locks answer.
  void respond(const double* pull, double* u);

private:
  template <class Put> void assemble(double g, const Put& put) const;
  void factor_inner();
  void add_inner_forces(const double* r);
  void solve_inner(const double* r, double* u);
  void solve_unknowns();

  static constexpr int k_max_dense = 48; ///< unknowns: beyond, sparse factors are cheaper
  const Linearization* linearization_ = nullptr;
  std::vector<char> is_redundant_;
  int n_ = 0, m_ = 0;
  double g_ = 0.0;
  bool is_dense_ = true;
  MatX matrix_;
  DenseLu dense_;
  SparseLu sparse_;
  VecX right_, solution_, moved_;
  struct Inner {
    Mat3 answer;                         ///< A
    Eigen::Matrix<double, 6, 6> damping; ///< F_z A (g P + V)
  };
  std::vector<Inner> inner_;
  // Own states: u_z = A (r_z + P u_q + V u_v), of those coordinates alone that they hang on or act at.
  void set_states();
  void factor_states();
  void add_state_forces(const double* r);
  void solve_states(const double* r, double* u);
  std::vector<int> states_;                            ///< as inner states
  std::vector<int> state_columns_;                     ///< coordinates that they follow
  std::vector<int> state_rows_;                        ///< coordinates that they act at
  MatX state_pose_, state_velocity_, state_force_;     ///< P, V, F_z
  MatX state_by_state_, state_answer_, state_damping_; ///< Z, A, F_z A (g P + V)
  VecX state_right_, state_solution_, state_moved_;
  // What is worked with, so that nothing is allocated once it is as large as needed.
  MatX state_matrix_, state_way_, state_reply_;
  Eigen::PartialPivLU<MatX> state_factors_;
};

} // namespace steplap
