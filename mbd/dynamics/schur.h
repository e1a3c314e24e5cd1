// Solver for the constraint equations A λ = r with A = J W Jᵀ, W = diag(1/m, 1/m, 1/J) of each moving body.
//
// A is symmetric, positive semidefinite and sparse: two rows are coupled if they act on the same moving body. Pattern, fill-reducing order
// and elimination tree are computed once for a set of rows. The factorisation L D Lᵀ then runs over precomputed lists without allocation;
// for up to eight rows it is dense. If a pivot vanishes relative to its diagonal, the row depends on earlier ones: its multiplier is set to
// zero, and is_dependent() returns true for it (LoadSharing computes the distribution of loads when needed).
//
// Friction rows that nearly depend on others (feet of a box rotated by less than 1e-6 rad) would get meaningless multipliers: the load
// divided by the tiny independent part of the row, with a relative error of rounding over its square. Such rows are left out. They are
// selected once for a set of modes, by orthogonalisation in the metric of W: bilateral rows are taken first, then always the friction row
// farthest from the span of those taken, until the remaining distance is below k_dependent of its length. The constraints of rows left out
// are not enforced and have to be monitored (LoadSharing::discord).
//
// Near a singular position a pivot is small but not zero. The condition number of A is the square of that of J, so elimination alone would
// lose twice as many digits as necessary. Near such positions the solution is refined iteratively, with J W Jᵀ evaluated factor by factor.
#pragma once

#include "mbd/tape/traced.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace steplap {

/// A row in the coordinates of the clusters of one layout. S is double, or a recorded number (mbd/tape).
template <class S> struct SchurRowOf {
  int body[2] = {-1, -1};   ///< cluster on either side; −1: the ground
  bool is_constant = false; ///< j and wj are the same in every pose, and nonzero for θ only
  double w[2][3] = {};      ///< inverse masses on either side; 0 for locked coordinates
  S j[2][3] = {};           ///< J: ∂measure/∂(x, y, θ) on either side
  S wj[2][3] = {};          ///< W J
};
using SchurRow = SchurRowOf<double>;

/// A recorded pivot, and the diagonal element that it is compared with.
struct TracedPivot {
  TapeNumber pivot, diagonal;
};

/// A further part of a row over more than two bodies: rows[row] is a part of the row rows[of].
struct SchurPart {
  int row = 0, of = 0;
};

struct SchurCoupling; ///< coupling of two rows (schur.cpp)
class HubSolver;

/// Solver for one set of rows.
class SchurSolver {
public:
  SchurSolver();
  ~SchurSolver();
  SchurSolver(SchurSolver&&) noexcept;
  SchurSolver& operator=(SchurSolver&&) noexcept;

  /// `apart`: bodies on which many rows act are eliminated separately, if this is accurate (hub_solver.h). This requires the inverse masses
  /// of the rows.
  enum class HubElimination : unsigned char { as_others, apart };
  /// Computes the pattern for the first `count` rows, whose multipliers are the unknowns, and for their further `parts`, which follow in
  /// `rows`. Body −1 (the ground) couples nothing.
  void analyze(const std::vector<SchurRow>& rows, int count, const std::vector<SchurPart>& parts = {},
               HubElimination hubs = HubElimination::as_others);
  void analyze(const std::vector<SchurRow>& rows) { analyze(rows, static_cast<int>(rows.size())); }
  /// Factorises A for the present j and wj, with its diagonal increased by the fraction `shift` (damping). Does not allocate, except the
  /// first time that HubSolver refuses the numbers.
  void factor(const std::vector<SchurRow>& rows, double shift = 0.0);
  /// Requests that the next factorisation decides which friction rows are left out. The decision remains until the next call of
  /// decide_rank(): otherwise rounding of a pivot could change it within a step. Rows that were left out before (`was_out`) stay out up to
  /// twice the bound.
  void decide_rank(const std::vector<char>& is_friction, const std::vector<char>& was_out);
  /// Returns true between decide_rank() and the next factorisation: the rows to be left out are not decided yet.
  [[nodiscard]] bool is_rank_open() const { return is_rank_open_; }
  /// Records factor() and solve() on a tape, x = A⁻¹ x, for independent rows with can_be_traced(). The tape is valid while all relative
  /// pivots are above `least_pivot`. Appends the pivots from which smallest_pivot() is computed to `pivots`.
  void trace(const std::vector<SchurRowOf<TapeNumber>>& rows, double least_pivot, TapeNumber* x, std::vector<TracedPivot>& pivots) const;
  /// Solves A x = x₀ in place. `rows` must be those of the last factor().
  void solve(const std::vector<SchurRow>& rows, double* x) const;

  [[nodiscard]] int size() const { return n_; }
  [[nodiscard]] bool is_small() const { return n_ <= k_max_dense; }
  [[nodiscard]] bool can_be_traced() const { return n_ <= k_usual_rows; }
  [[nodiscard]] bool is_singular() const { return dependent_count_ > 0; }
  [[nodiscard]] bool is_dependent(int row) const { return inverse_d_[position_[row]] == 0.0; }
  /// Returns true if the friction row is left out.
  [[nodiscard]] bool is_left_out(int row) const { return !out_.empty() && out_[row] != 0; }
  /// Returns the smallest pivot that was kept, relative to its diagonal, at the last factorisation; it approaches 0 at a singular position.
  /// The pivots of a long chain decrease as 1/length in any position; beyond k_usual_rows the result is corrected for this.
  [[nodiscard]] double smallest_pivot() const { return smallest_pivot_ * length_; }
  [[nodiscard]] bool is_near_singular() const { return smallest_pivot() < k_refined_pivot; }

  /// Relative pivot below which a pivot counts as zero.
  static constexpr double k_pivot_tolerance = 1e-13;
  /// Relative pivot below which solutions are refined, chosen where elimination has lost about half of the digits.
  static constexpr double k_refined_pivot = 1e-4;
  static constexpr double k_usual_rows = 50.0;
  /// A friction row is dependent if its part orthogonal to the other rows is below this fraction of its length.
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
  void trace_sparse(const std::vector<SchurRowOf<TapeNumber>>& rows, double least_pivot, TapeNumber* x,
                    std::vector<TracedPivot>& pivots) const;
  template <class S> void add_part_products(const std::vector<SchurRowOf<S>>& rows, int k, S* y) const;
  template <class S, class Raise, class Invert>
  void eliminate_pattern(const std::vector<SchurRowOf<S>>& rows, int* fill, S* y, S* l, S* inverse_d, const Raise& raise,
                         const Invert& invert) const;
  template <class S> void substitute_pattern(const S* l, const S* inverse_d, S* y, S* x) const;
  template <class F> void for_parts(const F& f, const std::vector<SchurRow>& rows) const;
  template <int N> void solve_dense(double* x) const;

  static constexpr int k_max_dense = 8;
  /// Product of one number of wj and one of j, of two rows that act on the same body; a term of one entry of A.
  struct DenseProduct {
    std::uint16_t entry, wj, j; ///< indices of doubles from the start of the first row
  };
  std::vector<DenseProduct> dense_products_, dense_turns_;         ///< products for all three coordinates; for θ only
  std::array<double, k_max_dense * k_max_dense> dense_constant_{}; ///< contributions of constant rows
  std::array<double, k_max_dense * k_max_dense> dense_{};

  struct Product {
    int row;      ///< the earlier row in elimination order
    int position; ///< its position in elimination order
    unsigned char side_k, side_i;
  };
  /// A product with a number of a further part of the later row.
  struct PartProduct {
    int part;
    Product product;
  };
  std::vector<SchurPart> parts_;
  std::vector<PartProduct> part_products_; ///< empty without parts
  std::vector<int> part_begin_;
  int n_ = 0;
  int body_count_ = 0;
  double shift_ = 0.0;
  /// Returns true if a row with pivot `d` and diagonal element `diagonal` is left out.
  [[nodiscard]] bool leaves_out(int row, double d, double diagonal) { return is_left_out(row) || !(d > k_pivot_tolerance * diagonal); }
  void keep_rank(const std::vector<SchurRow>& rows, double shift);
  [[nodiscard]] bool is_rank_uncertain(const std::vector<SchurRow>& rows) const;
  [[nodiscard]] std::vector<char> dependent_friction(const std::vector<SchurRow>& rows) const;

  std::vector<char> can_stay_out_, out_, was_dependent_; ///< per row; empty: none
  bool is_rank_open_ = false;
  int dependent_count_ = 0;
  double smallest_pivot_ = 1.0;
  double length_ = 1.0;       ///< number of rows over k_usual_rows, at least 1
  std::vector<int> order_;    ///< order_[k]: row eliminated in step k
  std::vector<int> position_; ///< inverse of order_
  std::vector<int> product_begin_;
  std::vector<Product> products_;
  std::vector<int> pattern_begin_, pattern_; ///< column indices of row k of L, ascending
  std::vector<int> column_begin_, column_row_;
  std::vector<int> column_fill_;
  std::vector<double> l_, inverse_d_, work_;
  mutable std::vector<double> permuted_;
  mutable std::vector<double> right_, correction_, response_; ///< scratch of refine()
  std::unique_ptr<HubSolver> hubs_;                           ///< null: not used
  bool is_by_hubs_ = false;                                   ///< the last factorisation is that of hubs_
  bool is_pattern_known_ = false;                             ///< pattern for the case without hubs_
};

} // namespace steplap
