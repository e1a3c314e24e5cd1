// The constraint equations: A λ = r with A = J W Jᵀ, W = diag(1/m, 1/m, 1/J) per moving body.
//
// A is symmetric, positive semidefinite and sparse: two rows meet where they share a moving body.
// Pattern, fill-reducing order and elimination tree are found once for a set of rows; a factorisation
// L D Lᵀ then runs over precomputed lists, without allocation; up to eight rows it is dense. A pivot that vanishes against its
// diagonal marks a row as dependent on the earlier ones: its multiplier is set to zero and the row's
// index is reported (redundant constraints; least-norm multipliers are found apart, on demand).
//
// Rows of friction that nearly depend on others (feet of a box that has turned by less than a microradian) would bear
// forces that say nothing: the load over what is independent of a row, with an error of rounding over its square. Which of
// them stay out is decided once for a set of modes, by orthogonalisation in the masses' metric: bilateral rows first, then
// of the friction rows always the one that is farthest from those taken, until what is left is within k_dependent of its length.
// What they are held at is not met then, and has to be watched (LoadSharing::discord).
//
// Near a singular position a pivot is small without being zero. A carries the square of the rows' own
// condition, so elimination alone would lose twice the digits that the problem takes: there the solution is
// refined against J W Jᵀ itself, factor by factor, whose rounding is that of the rows.
#pragma once

#include "mbd/tape/traced.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace steplap {

/// Row in the coordinates of the moving bodies ("clusters") of one layout; S is double, or written down (mbd/tape).
template <class S> struct SchurRowOf {
  int body[2] = {-1, -1};   ///< cluster on either side, −1: the ground
  bool is_constant = false; ///< j and wj are the same in every pose, and zero but for θ
  double w[2][3] = {};      ///< inverse masses of either side, 0 where locked
  S j[2][3] = {};           ///< ∂measure/∂(x, y, θ) of either side
  S wj[2][3] = {};          ///< W times that
};
using SchurRow = SchurRowOf<double>;

/// A pivot that was written down, and what it counts against.
struct TracedPivot {
  Traced pivot, diagonal;
};

/// Further sides of a row that acts on more than two bodies: rows[row], which is none of its own, is a part of rows[of].
struct SchurPart {
  int row = 0, of = 0;
};

struct SchurCoupling; ///< of two rows (schur.cpp)
class HubSolver;

class SchurSolver {
public:
  SchurSolver();
  ~SchurSolver();
  SchurSolver(SchurSolver&&) noexcept;
  SchurSolver& operator=(SchurSolver&&) noexcept;

  /// `apart`: bodies in which many rows meet are solved for beside the others, where that is as exact (hub_solver.h). It takes the
  /// rows' inverse masses.
  enum class Hubs : unsigned char { as_others, apart };
  /// Pattern from the bodies of the first `count` rows, which are all that it solves, and of the parts of some of them that
  /// stand behind. Body −1 couples nothing.
  void analyze(const std::vector<SchurRow>& rows, int count, const std::vector<SchurPart>& parts = {}, Hubs hubs = Hubs::as_others);
  void analyze(const std::vector<SchurRow>& rows) { analyze(rows, static_cast<int>(rows.size())); }
  /// Numbers from the rows' j and wj, the diagonal raised by the fraction `shift` (damping). Allocates nothing, but the first time that
  /// hubs cannot be apart.
  void factor(const std::vector<SchurRow>& rows, double shift = 0.0);
  /// Rows that hold friction: which of them depend on others is decided by the next factorisation, and those stay out
  /// of the later ones too, until asked again. Within a step a row would else come and go by the rounding of a pivot.
  /// Rows that `was_out` when it was last decided stay so up to twice the bound.
  void decide_rank(const std::vector<char>& is_friction, const std::vector<char>& was_out);
  /// Has no factorisation followed decide_rank() yet?
  [[nodiscard]] bool is_rank_open() const { return is_rank_open_; }
  /// What factor() and solve() do for rows that are independent and can_be_traced(), on numbers that are written down: conditions
  /// are that they stay as far from singular positions as `least_pivot`. x = A⁻¹ x. Adds the pivots that smallest_pivot() is one of.
  void trace(const std::vector<SchurRowOf<Traced>>& rows, double least_pivot, Traced* x, std::vector<TracedPivot>& pivots) const;
  /// In place: x = A⁻¹ x. `rows`: those factored.
  void solve(const std::vector<SchurRow>& rows, double* x) const;

  [[nodiscard]] int size() const { return n_; }
  [[nodiscard]] bool is_small() const { return n_ <= k_max_dense; }
  [[nodiscard]] bool can_be_traced() const { return n_ <= k_usual_rows; }
  [[nodiscard]] bool is_singular() const { return dependent_count_ > 0; }
  [[nodiscard]] bool is_dependent(int row) const { return inverse_d_[position_[row]] == 0.0; }
  /// Is it one of friction that was decided to stay out?
  [[nodiscard]] bool is_left_out(int row) const { return !out_.empty() && out_[row] != 0; }
  /// Smallest pivot kept, relative to its diagonal, in the last factorisation: near 0 close to a singularity.
  /// A chain's falls as one over its length wherever it is: beyond k_usual_rows that is allowed for.
  [[nodiscard]] double smallest_pivot() const { return smallest_pivot_ * length_; }
  [[nodiscard]] bool is_near_singular() const { return smallest_pivot() < k_refined_pivot; }

  /// A pivot below this fraction of its diagonal counts as zero.
  static constexpr double k_pivot_tolerance = 1e-13;
  /// Below this one a solution is refined: the square root of what elimination can lose.
  static constexpr double k_refined_pivot = 1e-4;
  static constexpr double k_usual_rows = 50.0;
  /// A row of friction depends on others if what it is beyond them is below this fraction of its length.
  static constexpr double k_dependent = 1e-6;

private:
  void factor_as_is(const std::vector<SchurRow>& rows, double shift);
  void eliminate(double* x) const;
  void refine(const std::vector<SchurRow>& rows, const double* right, double* x) const;
  template <int N> void factor_dense(const std::vector<SchurRow>& rows);
  struct Columns;
  void list_dense_products(const std::vector<SchurRow>& rows, const std::vector<SchurCoupling>& coupled, const std::vector<int>& of);
  [[nodiscard]] Columns columns_of(const std::vector<SchurCoupling>& coupled, const std::vector<int>& of, bool has_parts) const;
  void list_products(const Columns& columns);
  void find_pattern(const std::vector<SchurRow>& rows);
  void find_pattern_of_factors(const Columns& columns);
  void factor_sparse(const std::vector<SchurRow>& rows);
  void eliminate_sparse(double* x) const;
  void trace_sparse(const std::vector<SchurRowOf<Traced>>& rows, double least_pivot, Traced* x, std::vector<TracedPivot>& pivots) const;
  template <class S> void add_part_products(const std::vector<SchurRowOf<S>>& rows, int k, S* y) const;
  template <class S, class Raise, class Invert>
  void eliminate_pattern(const std::vector<SchurRowOf<S>>& rows, int* fill, S* y, S* l, S* inverse_d, const Raise& raise,
                         const Invert& invert) const;
  template <class S> void substitute_pattern(const S* l, const S* inverse_d, S* y, S* x) const;
  template <class F> void for_parts(const F& f, const std::vector<SchurRow>& rows) const;
  template <int N> void solve_dense(double* x) const;

  static constexpr int k_max_dense = 8;
  /// wj of one row times j of another, which share a body, makes part of one entry of A.
  struct DenseProduct {
    std::uint16_t entry, wj, j; ///< wj, j: as doubles from the first row's start
  };
  std::vector<DenseProduct> dense_products_, dense_turns_;         ///< three terms; that of θ alone
  std::array<double, k_max_dense * k_max_dense> dense_constant_{}; ///< from constant rows
  std::array<double, k_max_dense * k_max_dense> dense_{};

  struct Product {
    int row;      ///< the earlier row in elimination order
    int position; ///< its position in elimination order
    unsigned char side_k, side_i;
  };
  /// The same of a part of the later row, which is not the row itself.
  struct PartProduct {
    int part;
    Product product;
  };
  std::vector<SchurPart> parts_;
  std::vector<PartProduct> part_products_; ///< none without parts
  std::vector<int> part_begin_;
  int n_ = 0;
  int body_count_ = 0;
  double shift_ = 0.0;
  /// Is the row, whose pivot is `d` of `diagonal`, to be left out?
  [[nodiscard]] bool leaves_out(int row, double d, double diagonal) { return is_left_out(row) || !(d > k_pivot_tolerance * diagonal); }
  void keep_rank(const std::vector<SchurRow>& rows, double shift);
  [[nodiscard]] bool is_in_doubt(const std::vector<SchurRow>& rows) const;
  [[nodiscard]] std::vector<char> dependent_friction(const std::vector<SchurRow>& rows) const;

  std::vector<char> can_stay_out_, out_, was_out_; ///< per row; empty: none
  bool is_rank_open_ = false;
  int dependent_count_ = 0;
  double smallest_pivot_ = 1.0;
  double length_ = 1.0;       ///< rows over k_usual_rows, at least 1
  std::vector<int> order_;    ///< order_[k]: row eliminated as k-th
  std::vector<int> position_; ///< inverse of order_
  std::vector<int> product_begin_;
  std::vector<Product> products_;
  std::vector<int> pattern_begin_, pattern_; ///< columns of row k of L, ascending
  std::vector<int> column_begin_, column_row_;
  std::vector<int> column_fill_;
  std::vector<double> l_, inverse_d_, work_;
  mutable std::vector<double> permuted_;
  mutable std::vector<double> right_, correction_, response_; ///< of refine
  std::unique_ptr<HubSolver> hubs_;                           ///< null: none is apart
  bool is_by_hubs_ = false;                                   ///< the last factors are theirs
  bool is_pattern_known_ = false;                             ///< of what is solved without them
};

} // namespace steplap
