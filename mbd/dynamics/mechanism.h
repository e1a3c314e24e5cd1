// A small mechanism in joint coordinates: clusters connected by pins, described by their angles.
//
// The members form a forest. Each is attached by one pin to its parent, another member or the ground, or it is free and the root of a tree.
// A distance joint is a massless member with a pin at both ends (a rod). Coordinates s are the angles of the members relative to the ground
// (so that pins transmit no moment); a free member also has the position of its centre, numbered before its angle. With R_k the rotation of
// member k, e its parent, and two constant vectors, d_k from e's pin to its own pin and c_k from its pin to its centre:
//
//   o_k = o_e + R_e d_k,   centre = o_k + R_k c_k
//   v = T(s) ṡ,  a = T s̈ + b,   M s̈ = Tᵀ(Q − m b) + Jᵀλ,  M = Tᵀ m T
//   M_ee = J_e + m_e c_e² + Σ m_below d²      constant
//   M_fe = (R_e d) · (R_f p_f),  e above f, d from e's pin to the pin that carries f, p_f = m_f c_f + Σ m_below d   constant in f
//
// M couples a member only with those above it. M = Lᵀ D L therefore has no fill-in if the outermost members are eliminated first (R.
// Featherstone, Rigid Body Dynamics Algorithms, §6.5).
//
// Joints that close loops and sticking friction are rows, J s̈ = γ − J_c b with J = J_c T and J_c the gradients by the coordinates of the
// clusters. They are solved as in SchurSolver. Pivots are taken relative to the diagonal for free bodies, J_c W J_cᵀ, so that they measure
// the distance from singular positions in the same way as with absolute coordinates and the pins eliminated first.
#pragma once

#include "mbd/dynamics/schur.h"
#include "mbd/system/motion.h"

#include <array>
#include <memory>
#include <vector>

namespace steplap {

/// A cluster or a massless rod of a mechanism, and the pin that attaches it.
struct Member {
  int cluster = -1; ///< −1: rod
  int slot = -1;    ///< slot of its motion and force
  int parent = -1;  ///< parent; −1: the ground, or free
  bool is_free = false;
  int coordinate = 0;      ///< index of its angle; x and y of a free member are the two before
  int block = -1;          ///< row block of the joint to its parent; −1: none (free, or a rod, whose row block is that of its end)
  bool is_rod_end = false; ///< attached by a distance joint to a rod, which is its parent
  double mass = 0.0, inertia = 0.0;
  Pair<double> pin;    ///< from the parent's pin to its own, in the parent's axes; a position if the parent is the ground
  Pair<double> centre; ///< from its pin to its centre, in its axes
};

struct MechanismWork;

/// Kinematics and dynamics of one mechanism. Does not allocate after close().
class Mechanism {
public:
  Mechanism();
  ~Mechanism();
  Mechanism(Mechanism&&) noexcept;
  Mechanism& operator=(Mechanism&&) noexcept;

  static constexpr int k_most = 16; ///< largest number of coordinates and of rows

  // --- set by the layout ----------------------------------------------------------------------------
  std::vector<Member> members; ///< each after its parent
  int first_coordinate = 0;    ///< index in the packed coordinates
  int first_cluster = 0;
  int first_row = 0, row_count = 0; ///< range in the layout's active rows
  /// Computes constants and sizes, after all members are added. Preconditions: members, first_cluster and the row range are set, and the
  /// bodies of `rows` are set.
  void close(int cluster_count, const Vec2& gravity, const SchurRow* rows);

  [[nodiscard]] int size() const { return n_; }
  [[nodiscard]] int cluster_count() const { return static_cast<int>(member_of_.size()); }
  /// Returns the largest distance of anything that coordinate i rotates from the pin of i, m; 0 for a translation.
  [[nodiscard]] double reach(int i) const { return reach_[i]; }
  /// Returns true if coordinate i is a length in m, false if it is an angle in rad.
  [[nodiscard]] bool is_place(int i) const { return is_place_[i] != 0; }
  /// Returns a bit mask of the coordinates that move the cluster: bit i for coordinate i.
  [[nodiscard]] unsigned moved_by(int cluster) const { return path_[member_of_[cluster - first_cluster]]; }

  // --- poses and rates ------------------------------------------------------------------------------
  /// Computes coordinates and rates of the mechanism from those of the clusters (3 numbers for each cluster of the layout).
  void pack(const double* cluster_q, const double* cluster_v, double* q, double* v) const;
  /// Computes coordinates and rates of the clusters from those of the mechanism.
  void unpack(const double* q, const double* v, double* cluster_q, double* cluster_v) const;
  /// Computes the motions of the mechanism's clusters.
  void place(const double* q, const double* v, Motion<double>* motion);
  /// Returns true if q and v were the last arguments of place().
  [[nodiscard]] bool is_at(const double* q, const double* v) const;

  // --- at the last pose given to place() --------------------------------------------------------------
  /// Computes M and its factors Lᵀ D L.
  void factor_mass();
  /// Computes the accelerations s̈ without rows; `force` has one entry per slot.
  void accelerate(const BodyForce* force, double* s) const;
  /// Computes the accelerations (x, y, θ) of all clusters for given s̈, including centripetal terms.
  void expand(const double* s, double* cluster_a) const;
  /// Solves M x = x₀ in place.
  void solve_mass(double* x) const;
  /// Converts the gradient of a row from cluster coordinates to the coordinates s.
  void reduce(const SchurRow& row, double* gradient) const;
  /// Computes the force on every member from its parent. `cluster_a`: accelerations from expand(); `lambda`: multipliers of the mechanism's
  /// rows.
  void pin_forces(const double* cluster_a, const BodyForce* force, const SchurRow* rows, const double* lambda,
                  std::vector<Pair<double>>& on_member) const;
  /// Return the vector from the parent's pin to the member's pin, and that from the member's pin to its centre, ground axes, m.
  [[nodiscard]] Pair<double> arm(int member) const;
  [[nodiscard]] Pair<double> lever(int member) const;
  /// Returns the angular velocity of the member, rad/s.
  [[nodiscard]] double spin(int member) const;
  /// Returns the index of the member that is this cluster of the layout.
  [[nodiscard]] int member_of(int cluster) const { return member_of_[cluster - first_cluster]; }

  // --- rows: as in SchurSolver ------------------------------------------------------------------------
  /// Converts the gradients of the mechanism's rows to the coordinates s. Precondition: the gradients in `rows` are computed.
  void reduce_rows(const SchurRow* rows);
  /// Factorises J M⁻¹ Jᵀ. Preconditions: factor_mass(), reduce_rows().
  void factor_rows(const SchurRow* rows, double shift);
  void solve_rows(double* x) const;
  /// Returns J · change for one row.
  [[nodiscard]] double along(int row, const double* change) const;
  /// Adds M⁻¹ Jᵀ λ to `change`.
  void add_response(const double* lambda, double* change) const;
  void decide_rank(const char* is_friction, const char* was_out);
  [[nodiscard]] bool is_rank_open() const { return is_rank_open_; }
  [[nodiscard]] bool is_singular() const { return dependent_count_ > 0; }
  [[nodiscard]] bool is_dependent(int row) const;
  /// Returns true if the row depends on others and is left out of the equations.
  [[nodiscard]] bool is_left_out(int row) const { return !out_.empty() && out_[row] != 0; }
  [[nodiscard]] double smallest_pivot() const { return smallest_pivot_; }
  /// Returns the gradient of a row by the coordinates s, size() numbers.
  [[nodiscard]] const double* gradient(int row) const;
  /// Returns the mechanism's constants, for recording an evaluation (traced_mechanism.h).
  [[nodiscard]] const MechanismWork& work() const { return *work_; }

private:
  void find_patterns(const SchurRow* rows);
  void factor_as_is(double shift);
  void keep_rank(double shift);

  int n_ = 0;
  std::vector<int> member_of_; ///< member of each of its clusters
  std::vector<unsigned> path_; ///< per member: bit mask of the coordinates that move it
  std::array<double, k_most> reach_{};
  std::array<char, k_most> is_place_{};
  std::vector<char> can_stay_out_, out_, was_dependent_; ///< per row, as in SchurSolver
  bool is_rank_open_ = false;
  int dependent_count_ = 0;
  double smallest_pivot_ = 1.0;
  std::unique_ptr<MechanismWork> work_; ///< variables of an evaluation, next to copies of the constants for faster access
};

} // namespace steplap
