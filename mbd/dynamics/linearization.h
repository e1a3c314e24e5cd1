// Linearisation of the equations of motion at a state, in the coordinates of the present layout.
//
// With generalised forces Q(q, v, t), multipliers λ of the active rows and their gradients J, M a = Q + Jᵀλ, J a = γ (27), a small change
// of state changes the accelerations by
//
//   M δa − Jᵀ δλ = K δq + D δv,   K = ∂(Q + Jᵀλ)/∂q at constant λ,  D = ∂Q/∂v,
//   J δa         = G_q δq + G_v δv,   G = ∂(γ − J a)/∂(q, v) at constant a.
//
// K and D have the sign of the force: K of a spring is negative. They are exact, by dual numbers (dual.h), with one exception: the
// derivatives of slip laws by relative velocity, relative pose and normal forces are central differences. (Coulomb's law is linear in the
// normal forces, so there they are exact up to rounding.)
//
// In mechanisms (mechanism.h) M is not diagonal. There M⁻¹K and M⁻¹D are given instead, with inverse masses 1, and M⁻¹Jᵀ separately. With T
// the Jacobian of cluster velocities by coordinate rates and a = T s̈ + b at constant s̈, they follow from the matrices of the clusters:
//
//   δv = T δṡ + (∂(T ṡ)/∂s) δs,   D_s = Tᵀ(D T − m ∂a/∂ṡ)
//   K_s = Tᵀ(K T + D ∂(T ṡ)/∂s − m ∂a/∂s) + (∂Tᵀ/∂s)(Q + Jᵀλ − m a)
//
// These are closed forms, because a coordinate rotates only the vectors of its own member.
//
// Inner states z of force elements (roles.h) contribute
//
//   δQ += F_z δz,   δż = P δq + V δv + Z δz,
//
// each between two clusters. They are stored as small blocks (InnerBlock), so that methods can eliminate them. Own states of the model can
// depend on any motion and on each other, and are stored as lists (StateParts).
//
// Locked coordinates do not depend on the state: their columns are omitted, their rows have zero inverse mass. The linearisation is valid
// while no event function crosses zero.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/system/state_jacobian.h"

#include <Eigen/SparseCore>

#include <functional>

namespace steplap {

/// Matrices of the linearised equations of motion at one state.
class Linearization {
public:
  using Triplet = Eigen::Triplet<double, int>;

  /// Computes all matrices at time t and packed state y, for the modes set in `dynamics`. The entries always have the same order for one
  /// layout, so that a sparsity pattern can be used again.
  void evaluate(Dynamics& dynamics, double t, const double* y) { evaluate(dynamics, t, y, {}); }
  /// Called with the derivatives of all forces, group by group, and the index of the first of each group; may change them.
  using PartsHook = std::function<void(const Evaluation& e, std::vector<PairJacobian>& parts, const std::vector<std::size_t>& first)>;
  void evaluate(Dynamics& dynamics, double t, const double* y, const PartsHook& change);

  [[nodiscard]] int coordinates() const { return n_; } ///< number of coordinates n of the layout
  [[nodiscard]] int rows() const { return m_; }        ///< number of active constraint rows m
  /// Returns the n inverse masses and inertias, 1/kg and 1/(kg m²); zero for locked coordinates, 1 for coordinates of mechanisms.
  [[nodiscard]] const std::vector<double>& inverse_mass() const { return *inverse_mass_; }

  // Sparse matrices in SI units and rad, as triplets; entries at the same place add up.
  [[nodiscard]] const std::vector<Triplet>& stiffness() const { return stiffness_; } ///< K, n × n
  [[nodiscard]] const std::vector<Triplet>& damping() const { return damping_; }     ///< D, n × n
  [[nodiscard]] const std::vector<Triplet>& gradient() const { return gradient_; }   ///< J, m × n
  /// Returns M⁻¹ Jᵀ, n × m; empty if there are no mechanisms.
  [[nodiscard]] const std::vector<Triplet>& response() const { return response_; }
  [[nodiscard]] const std::vector<Triplet>& bias_by_pose() const { return bias_q_; }     ///< G_q, m × n
  [[nodiscard]] const std::vector<Triplet>& bias_by_velocity() const { return bias_v_; } ///< G_v, m × n

  /// Derivatives for the inner states of one element between two clusters. Rows and columns for coordinates refer to those of the first
  /// cluster, then of the second; entries for the ground and for locked coordinates are zero.
  struct InnerBlock {
    int cluster[2] = {-1, -1};
    int first = 0, count = 0;
    Eigen::Matrix<double, 6, 3> force;
    Eigen::Matrix<double, 3, 6> by_pose, by_velocity;
    Mat3 by_inner;
  };
  [[nodiscard]] const std::vector<InnerBlock>& inner() const { return inner_; }
  /// Derivatives for [[state]] variables (own_states.h). In by_pose, by_velocity and by_state rows are inner states; columns are
  /// coordinates, or inner states in by_state. In `forces` rows are coordinates and columns inner states. Columns of locked coordinates are
  /// omitted.
  struct StateParts {
    std::vector<Triplet> by_pose, by_velocity, by_state, forces;
  };
  [[nodiscard]] const StateParts& states() const { return states_; }
  [[nodiscard]] int inner_count() const { return dynamics_->inner_count(); }

  /// Returns a list of triplets as a dense matrix with n columns and the given number of rows.
  [[nodiscard]] MatX dense(const std::vector<Triplet>& entries, int rows) const;
  /// Computes ∂a/∂q and ∂a/∂v (n × n each) for the free coordinates, with the constraints eliminated, by dense algebra.
  void acceleration_by_state(MatX& by_pose, MatX& by_velocity) const;

private:
  void add_forces(const PairJacobian& part);
  void add_inner(const InnerJacobian& part);
  void add_states();
  void add_transport();
  void add_row(std::size_t r);
  void add_part(std::size_t r, const RowSpec& part);
  void reduce();
  void find_levers();
  void reduce_forces(const Mechanism& m);
  void start_columns();
  void add_inertia(const Mechanism& m, const Member& member);
  void reduce_rows();
  struct Sliding;
  void add_sliding(int friction);
  void differentiate_by_rate(Sliding& sliding) const;
  void differentiate_by_pose(Sliding& sliding);
  void differentiate_by_value(Sliding& sliding);
  void put_along(const Sliding& sliding, int k, int cluster, int coordinate, double by_pose, double by_velocity);
  void add_sliding_rows(const Sliding& sliding);
  void take_out_transport(const Sliding& sliding);
  void add_normal_forces(Sliding& sliding);
  void add_normal_force(const Sliding& sliding, const PairJacobian& contact, int k, double along);
  void add_body_block(int row_body, int column_body, const Mat3& by_pose, const Mat3& by_velocity);
  void put(std::vector<Triplet>& entries, int row, int column, double value);

  Dynamics* dynamics_ = nullptr;
  const Layout* layout_ = nullptr;
  int n_ = 0, m_ = 0;
  const double* acceleration_ = nullptr; ///< 3 per cluster
  const std::vector<double>* inverse_mass_ = nullptr;
  std::vector<double> dy_;
  std::vector<PairJacobian> parts_;
  std::vector<std::size_t> first_part_; ///< per group: index of its first entry in parts_
  std::vector<InnerJacobian> inner_parts_;
  std::vector<InnerBlock> inner_;
  StateJacobian state_jacobian_;
  StateParts states_;
  std::vector<Triplet> stiffness_, damping_, gradient_, bias_q_, bias_v_, response_;
  /// Motion of a cluster by one coordinate of its mechanism.
  struct Lever {
    int coordinate = 0;
    int axis = -1;       ///< direction of a translation: 0 x, 1 y; −1: rotation
    bool is_own = false; ///< the coordinate is the angle of the cluster itself
    double omega = 0.0, alpha = 0.0;
    Pair<double> arm; ///< vector that it rotates: from its pin to the cluster's centre
  };
  /// Derivatives of the velocity ċ and acceleration c̈ of a cluster coordinate c by a coordinate s of the mechanism: ∂ċ/∂ṡ, ∂ċ/∂s, ∂c̈/∂s,
  /// ∂c̈/∂ṡ.
  struct LeverRates {
    double rate, rate_by_pose, acceleration_by_pose, acceleration_by_rate;
  };
  [[nodiscard]] static Lever place_lever(int coordinate, int axis);
  [[nodiscard]] static LeverRates rates_of(const Lever& lever, int c);
  template <class F> void for_levers(int at, const F& f) const;
  std::vector<std::vector<Lever>> levers_;                     ///< per cluster; empty if in absolute coordinates
  std::vector<Triplet> kept_gradient_, kept_pose_, kept_rate_; ///< scratch of reduce()
  MatX by_pose_, by_rate_;                                     ///< matrices of one mechanism
  std::vector<char> is_touched_;                               ///< for each coordinate: by_pose_ and by_rate_ have entries there
  std::vector<Motion<double>> motion_;                         ///< scratch for the differences of slip laws
  std::vector<double> normal_;
};

} // namespace steplap
