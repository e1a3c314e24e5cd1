// A small mechanism in joint coordinates: clusters pinned to one another or to the ground, described by the angles
// that pins leave them.
//
// Its *members* hang on each other as a forest: each on one pin of another member or of the ground, or it is free and
// the root of its tree. A distance joint is a member without mass, pinned at both its ends. Coordinates s are the
// members' angles against the ground (so a pin passes no couple on), of a free member the place of its centre before
// it. With R_k the turn of member k, e the member that k hangs on, d_k its pin there and c_k its own centre, both from
// pins and fixed:
//   o_k = o_e + R_e d_k,   centre = o_k + R_k c_k
//   v = T(s) ṡ,  a = T s̈ + b,   M s̈ = Tᵀ(Q − m b) + Jᵀλ,  M = Tᵀ m T
//   M_ee = J_e + m_e c_e² + Σ m_below d²      constant
//   M_fe = (R_e d) · (R_f p_f),  e above f, d the pin on e by which f hangs, p_f = m_f c_f + Σ m_below d   fixed in f
// M couples a member with those above it alone: M = Lᵀ D L has no fill if the outermost are eliminated first
// (R. Featherstone, Rigid Body Dynamics Algorithms, §6.5).
//
// What closes loops, and friction that sticks, are rows in these coordinates: J s̈ = γ − J_c b with the rows' gradients
// J_c by the clusters' coordinates, J = J_c T. They are solved as SchurSolver does it, and mean the same: pivots count
// against the diagonal of the bodies on their own, J_c W J_cᵀ, so that they tell of the distance from singular
// positions in the same measure, with the pins eliminated before all other rows.
#pragma once

#include "mbd/dynamics/schur.h"
#include "mbd/system/motion.h"

#include <array>
#include <memory>
#include <vector>

namespace steplap {

/// A cluster, or a rod without mass, and what it hangs on.
struct Member {
  int cluster = -1; ///< −1: a rod
  int slot = -1;    ///< of its motion and force
  int parent = -1;  ///< member that it hangs on, −1: the ground or nothing
  bool is_free = false;
  int coordinate = 0;      ///< of its angle; of a free one x and y are the two before
  int block = -1;          ///< rows of the joint by which it hangs, −1: none (free, or a rod, which leaves them to its end)
  bool is_rod_end = false; ///< that is a distance, its parent the rod
  double mass = 0.0, inertia = 0.0;
  Pair<double> pin;    ///< from its parent's pin, in the parent's axes; a place of the ground
  Pair<double> centre; ///< from its pin, in its axes
};

struct MechanismWork;

class Mechanism {
public:
  Mechanism();
  ~Mechanism();
  Mechanism(Mechanism&&) noexcept;
  Mechanism& operator=(Mechanism&&) noexcept;

  static constexpr int k_most = 16; ///< coordinates, and rows

  // --- made by the layout ---------------------------------------------------------------------------
  std::vector<Member> members; ///< after those that they hang on
  int first_coordinate = 0;    ///< in the packed coordinates
  int first_cluster = 0;
  int first_row = 0, row_count = 0; ///< of the layout's active rows
  /// Constants of the members, coordinates, sizes. Members, first_cluster and its rows, of which the bodies are filled
  /// in, must be known.
  void close(int cluster_count, const Vec2& gravity, const SchurRow* rows);

  [[nodiscard]] int size() const { return n_; }
  [[nodiscard]] int cluster_count() const { return static_cast<int>(member_of_.size()); }
  /// How far at most anything that coordinate i turns is from its pin, m; 0 for a place.
  [[nodiscard]] double reach(int i) const { return reach_[i]; }
  [[nodiscard]] bool is_place(int i) const { return is_place_[i] != 0; }
  /// Bit i: coordinate i moves the cluster.
  [[nodiscard]] unsigned moved_by(int cluster) const { return path_[member_of_[cluster - first_cluster]]; }

  // --- poses and rates ------------------------------------------------------------------------------
  /// From the clusters' (3 numbers each, all clusters of the layout).
  void pack(const double* cluster_q, const double* cluster_v, double* q, double* v) const;
  /// To its clusters'.
  void unpack(const double* q, const double* v, double* cluster_q, double* cluster_v) const;
  /// Places its clusters.
  void place(const double* q, const double* v, Motion<double>* motion);
  [[nodiscard]] bool is_at(const double* q, const double* v) const;

  // --- at the pose last placed ----------------------------------------------------------------------
  /// M = Lᵀ D L.
  void factor_mass();
  /// s̈ without rows, `force` per slot.
  void accelerate(const BodyForce* force, double* s) const;
  /// The clusters' accelerations, 3 each, that belong to s̈.
  void expand(const double* s, double* cluster_a) const;
  /// In place: x = M⁻¹ x.
  void solve_mass(double* x) const;
  /// Gradient by the coordinates.
  void reduce(const SchurRow& row, double* gradient) const;
  /// Force on every member from what it hangs on: `cluster_a` expanded, `lambda` of its rows.
  void pin_forces(const double* cluster_a, const BodyForce* force, const SchurRow* rows, const double* lambda,
                  std::vector<Pair<double>>& on_member) const;
  /// From the pin of the member that it hangs on to its own, and from there to its centre, ground axes.
  [[nodiscard]] Pair<double> arm(int member) const;
  [[nodiscard]] Pair<double> lever(int member) const;
  [[nodiscard]] double spin(int member) const;
  [[nodiscard]] int member_of(int cluster) const { return member_of_[cluster - first_cluster]; }

  // --- rows: as of SchurSolver ----------------------------------------------------------------------
  /// Gradients of the rows, whose numbers are filled in.
  void reduce_rows(const SchurRow* rows);
  /// Factors of J M⁻¹ Jᵀ; mass and rows must be.
  void factor_rows(const SchurRow* rows, double shift);
  void solve_rows(double* x) const;
  /// Σ J change.
  [[nodiscard]] double along(int row, const double* change) const;
  /// change += M⁻¹ Jᵀ λ.
  void add_response(const double* lambda, double* change) const;
  void decide_rank(const char* is_friction, const char* was_out);
  [[nodiscard]] bool is_rank_open() const { return is_rank_open_; }
  [[nodiscard]] bool is_singular() const { return dependent_count_ > 0; }
  [[nodiscard]] bool is_dependent(int row) const;
  [[nodiscard]] bool is_left_out(int row) const { return !out_.empty() && out_[row] != 0; }
  [[nodiscard]] double smallest_pivot() const { return smallest_pivot_; }
  [[nodiscard]] const double* gradient(int row) const;
  /// Its constants, for who writes an evaluation down (traced_mechanism.h).
  [[nodiscard]] const MechanismWork& work() const { return *work_; }

private:
  void find_patterns(const SchurRow* rows);
  void factor_as_is(double shift);
  void keep_rank(double shift);

  int n_ = 0;
  std::vector<int> member_of_; ///< of its clusters
  std::vector<unsigned> path_; ///< per member: coordinates that move it, by bits
  std::array<double, k_most> reach_{};
  std::array<char, k_most> is_place_{};
  std::vector<char> can_stay_out_, out_, was_out_; ///< per row, as in SchurSolver
  bool is_rank_open_ = false;
  int dependent_count_ = 0;
  double smallest_pivot_ = 1.0;
  std::unique_ptr<MechanismWork> work_; ///< what an evaluation changes, and its constants side by side
};

} // namespace steplap
