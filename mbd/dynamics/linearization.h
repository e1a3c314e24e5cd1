// The equations of motion linearised at a state, in the coordinates of the present layout.
//
// With the generalised forces Q(q, v, t), the multipliers λ of the layout's active rows and J their
// gradients, M a = Q + Jᵀλ, J a = γ (27), a small change of state changes the accelerations by
//   M δa − Jᵀ δλ = K δq + D δv,   K = ∂(Q + Jᵀλ)/∂q at constant λ,  D = ∂Q/∂v,
//   J δa         = G_q δq + G_v δv,   G = ∂(γ − J a)/∂(q, v) at constant a.
// K and D have the sign of the force: a spring's K is negative. They are exact: elements and rows are
// differentiated by dual numbers (dual.h). The one exception is the slip law of friction, whose wrench
// along its rows is differenced by the relative velocity, the relative pose and the normal forces of its
// own pair of bodies, one at a time; all that follows from geometry is exact there too. (Coulomb's law
// depends on the normal forces alone, linearly: exact up to rounding.)
//
// In mechanisms (mechanism.h) M is not diagonal: there K and D are given as M⁻¹K and M⁻¹D, with inverse masses of 1,
// and M⁻¹Jᵀ apart. They follow from those of the clusters, T being their velocities by the coordinates' rates, by
//   δv = T δṡ + (∂(T ṡ)/∂s) δs,   D_s = Tᵀ(D T − m ∂a/∂ṡ)
//   K_s = Tᵀ(K T + D ∂(T ṡ)/∂s − m ∂a/∂s) + (∂Tᵀ/∂s)(Q + Jᵀλ − m a)
// with a = T s̈ + b at constant s̈: all in closed form, since a coordinate turns but its own member's vectors.
//
// Inner states of force elements (roles.h) bring forces of their own and follow rates of their own,
//   δQ += F_z δz,   δż = P δq + V δv + Z δz,
// each between one pair of clusters: kept as small blocks (InnerBlock), for methods that eliminate them. Own states of the model may
// follow any motion and each other, and act anywhere: kept as lists (StateParts).
//
// Locked coordinates (drives) do not follow the state: their columns are left out, their rows have zero
// inverse mass. Modes are those of the state; the linearisation holds while no watch value crosses zero.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/system/state_jacobian.h"

#include <Eigen/SparseCore>

namespace steplap {

class Linearization {
public:
  using Triplet = Eigen::Triplet<double, int>;

  /// At (t, y) packed; evaluates the rates there. The modes are those last given to `dynamics`. Entries
  /// come in the same order for every state of one layout, so that a sparse pattern can be kept.
  void evaluate(Dynamics& dynamics, double t, const double* y);

  [[nodiscard]] int coordinates() const { return n_; } ///< of the layout
  [[nodiscard]] int rows() const { return m_; }        ///< active constraint rows
  /// Inverse masses and inertias, 1/kg and 1/(kg m²); zero where locked, 1 in mechanisms. n entries.
  [[nodiscard]] const std::vector<double>& inverse_mass() const { return *inverse_mass_; }

  // Sparse: duplicates add up. SI units, rad.
  [[nodiscard]] const std::vector<Triplet>& stiffness() const { return stiffness_; } ///< K, n × n
  [[nodiscard]] const std::vector<Triplet>& damping() const { return damping_; }     ///< D, n × n
  [[nodiscard]] const std::vector<Triplet>& gradient() const { return gradient_; }   ///< J, m × n
  /// M⁻¹ Jᵀ, n × m; empty where all clusters are in absolute coordinates.
  [[nodiscard]] const std::vector<Triplet>& response() const { return response_; }
  [[nodiscard]] const std::vector<Triplet>& bias_by_pose() const { return bias_q_; }     ///< G_q, m × n
  [[nodiscard]] const std::vector<Triplet>& bias_by_velocity() const { return bias_v_; } ///< G_v, m × n

  /// An inner state between two clusters: columns and rows of either side in turn, zero for the ground and locked columns.
  struct InnerBlock {
    int cluster[2] = {-1, -1};
    int first = 0, count = 0;
    Eigen::Matrix<double, 6, 3> force;
    Eigen::Matrix<double, 3, 6> by_pose, by_velocity;
    Mat3 by_inner;
  };
  [[nodiscard]] const std::vector<InnerBlock>& inner() const { return inner_; }
  /// Own states (own_states.h), which are no part of such blocks: columns are coordinates or, by_state, inner states; rows are inner
  /// states or, forces, coordinates. Locked columns are left out.
  struct StateParts {
    std::vector<Triplet> by_pose, by_velocity, by_state, forces;
  };
  [[nodiscard]] const StateParts& states() const { return states_; }
  [[nodiscard]] int inner_count() const { return dynamics_->inner_count(); }

  /// Any of them as a dense matrix of `rows` rows.
  [[nodiscard]] MatX dense(const std::vector<Triplet>& entries, int rows) const;
  /// ∂a/∂q and ∂a/∂v (n × n each) of free coordinates, constraints eliminated: for small scenes.
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
  std::vector<InnerJacobian> inner_parts_;
  std::vector<InnerBlock> inner_;
  StateJacobian state_jacobian_;
  StateParts states_;
  std::vector<Triplet> stiffness_, damping_, gradient_, bias_q_, bias_v_, response_;
  /// A coordinate of a mechanism that moves a cluster.
  struct Lever {
    int coordinate = 0;
    int axis = -1;       ///< of a place: 0 x, 1 y
    bool is_own = false; ///< it is the cluster's angle
    double omega = 0.0, alpha = 0.0;
    Pair<double> arm; ///< what it turns
  };
  /// By what a cluster's coordinate changes: its rate by that of a lever's coordinate, its rate and its acceleration by
  /// the coordinate, its acceleration by the rate.
  struct LeverRates {
    double rate, rate_by_pose, acceleration_by_pose, acceleration_by_rate;
  };
  [[nodiscard]] static Lever place_lever(int coordinate, int axis);
  [[nodiscard]] static LeverRates rates_of(const Lever& lever, int c);
  template <class F> void for_levers(int at, const F& f) const;
  std::vector<std::vector<Lever>> levers_;                     ///< per cluster; empty: absolute
  std::vector<Triplet> kept_gradient_, kept_pose_, kept_rate_; ///< scratch of reduce
  MatX by_pose_, by_rate_;                                     ///< of one mechanism
  std::vector<char> is_touched_;                               ///< per coordinate: they have entries there
  std::vector<Motion<double>> motion_;                         ///< scratch of the slip law's differences
  std::vector<double> normal_;
};

} // namespace steplap
