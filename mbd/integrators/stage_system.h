// Linear system for the stages of a linearly implicit method with constraints (a KKT matrix).
//
// A Rosenbrock method for y' = F(t, y), y = (q, v), solves (1/(γh) − ∂F/∂y) u = r in each stage. With q' = v and the linearised
// accelerations (linearization.h), positions can be eliminated. With W = M⁻¹, g = γh and w the multipliers:
//
//   ⎡ I − g W D − g² W K     −W Jᵀ ⎤ ⎡u_v⎤   ⎡ g (r_v + g W K r_q)       ⎤
//   ⎣ J − g G_v − g² G_q       0   ⎦ ⎣ w ⎦ = ⎣ g (J r_v + g G_q r_q)     ⎦,   u_q = g (r_q + u_v).
//
// Inner states z of force elements are eliminated, each from its own small block (linearization.h):
//
//   u_z = A (r_z + P u_q + V u_v), A = (1/g − Z)⁻¹, which adds F_z A (g P + V) to D and F_z A (r_z + g P r_q) to the forces.
//
// Own states are further state variables of the model. They may depend on all coordinates and on each other, so they are eliminated
// together in the same way. Locked coordinates have W = 0, so that u_v = g r_v. Rows that the Schur complement has found redundant are
// omitted.
//
// The rates in r must satisfy the constraints. An additional force f (friction in time stepping) causes only constraint reactions, with
//
//   r = (0, W f), the lower right side 0:   J u_v − g G_v u_v − g² G_q u_v = 0.
//
// The rate along row i by a force along row j, h_i S⁻¹ g W h_jᵀ, is the scalar product of one vector for each row (sparse_lu.h). In
// small systems the vector of the force contains the whole solution.
//
// Small systems are solved densely, large ones by sparse factors (sparse_lu.h) whose pattern is reused. After the first solution of a
// given size nothing is allocated.
#pragma once

#include "mbd/base/decompositions.h"
#include "mbd/dynamics/linearization.h"
#include "mbd/integrators/sparse_lu.h"

#include <Eigen/LU> // factors of matrices of order 3, and of the order of the number of own states

namespace steplap {

/// A row along which an additional force acts: its gradient g in at most six coordinates, none of them locked.
struct ForceRow {
  int count = 0;
  int coordinate[6] = {};
  double gradient[6] = {};
};

/// Assembles, factorises and solves the system for one linearisation.
class StageSystem {
public:
  /// Sets the linearisation; factor() must follow. Redundant rows of `layout` are omitted.
  void set(const Linearization& linearization, const Layout& layout);
  /// Sets for each coordinate the share s of its change of velocity that moves it: u_q = g (r_q + s u_v). Empty: 1 for all. Applies until the
  /// next call; to be called after set(). Precondition: a share below 1 only without inner states.
  void set_position_shares(const std::vector<double>& shares) { position_shares_ = shares; }
  /// Factorises for g = γh, s. Returns false if the matrix is singular.
  [[nodiscard]] bool factor(double g);
  /// Solves u = (1/g − ∂F/∂y)⁻¹ r; both consist of q, v (n each) and inner states.
  void solve(const double* r, double* u);

  // The velocity along one row by a unit force along another is a scalar product of two sparse vectors: append_force() gives that of the
  // force, append_rate() that of the velocity. append_force() includes the reactions of constraint rows and locks.
  void append_force(const ForceRow& row, SparseVectors& out);
  /// Appends the vector for the velocity along `row`. Its product with the vector of a force is the velocity along `row` by that force,
  /// m/s per N.
  void append_rate(const ForceRow& row, SparseVectors& out);
  /// Returns the dimension of these vectors.
  [[nodiscard]] int places() const { return n_ + m_; }
  /// Computes the change u of q and v (n numbers each) from a weighted sum of vectors of append_force().
  void finish_forces(const double* sum, double* u);

  /// Factorises H u + e w = r for forces w along the held rows, whose rates r are prescribed; other rows have no force. `softness`: e of
  /// each row, positive. Returns false if the matrix is singular.
  [[nodiscard]] bool factor_held(const std::vector<ForceRow>& rows, const std::vector<char>& is_held, const std::vector<double>& softness);
  /// Computes the forces w from the rates r of the rows; the result replaces the rates.
  void solve_held(std::vector<double>& rates);

private:
  template <class Put> void assemble(double g, const Put& put) const;
  void factor_inner();
  void add_inner_forces(const double* r);
  void solve_inner(const double* r, double* u);
  void solve_unknowns();

  static constexpr int k_max_dense = 48; ///< largest dense system; sparse factors are cheaper for more unknowns
  const Linearization* linearization_ = nullptr;
  [[nodiscard]] double position_share(int i) const { return position_shares_.empty() ? 1.0 : position_shares_[i]; }

  std::vector<char> is_redundant_;
  std::vector<double> position_shares_;
  int n_ = 0, m_ = 0;
  double g_ = 0.0;
  bool is_dense_ = true;
  MatX matrix_;
  DenseLu dense_;
  SparseLu sparse_;
  SparseLu held_; ///< factors of factor_held()
  VecX held_right_;
  VecX right_, solution_, moved_;
  struct Inner {
    Mat3 answer;                         ///< A of the inner block
    Eigen::Matrix<double, 6, 6> damping; ///< F_z A (g P + V)
  };
  std::vector<Inner> inner_;
  // Own states: u_z = A (r_z + P u_q + V u_v), restricted to the coordinates on which own states depend or act.
  void set_states();
  void factor_states();
  void add_state_forces(const double* r);
  void solve_states(const double* r, double* u);
  std::vector<int> states_;                            ///< indices of own states among the inner states
  std::vector<int> state_columns_;                     ///< coordinates on which own states depend
  std::vector<int> state_rows_;                        ///< coordinates on which own states act
  MatX state_pose_, state_velocity_, state_force_;     ///< P, V, F_z
  MatX state_by_state_, state_answer_, state_damping_; ///< Z, A, F_z A (g P + V)
  VecX state_right_, state_solution_, state_moved_;
  // Scratch memory.
  MatX state_matrix_, state_way_, state_reply_;
  Eigen::PartialPivLU<MatX> state_factors_;
};

} // namespace steplap
