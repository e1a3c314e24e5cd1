// LU factorisation of a sparse square matrix whose pattern remains the same over many steps.
//
// Columns are ordered once for a pattern (COLAMD). The first factorisation determines the pattern of the factors column by column, by
// depth-first search with row pivoting (J. R. Gilbert, T. Peierls, SIAM J. Sci. Stat. Comput. 9 (1988) 862; T. A. Davis, Direct Methods for
// Sparse Linear Systems, §6.2). Later ones reuse its pattern and pivots as long as no pivot is much smaller than the largest entry of its
// column (T. A. Davis, E. Palamadai Natarajan, ACM TOMS 37 (2010) 36); otherwise pivots are chosen again. After the first factorisations
// nothing is allocated.
//
// KLU of SuiteSparse is not used: it is slower on chains, though faster on medium-sized grids (docs/design/tried_and_left_out.md).
#pragma once

#include "mbd/base/types.h"

#include <vector>

namespace steplap {

/// Several sparse vectors stored one after the other, each with ascending indices.
struct SparseVectors {
  std::vector<std::size_t> begin{0}; ///< first entry of each vector, and the end of the last: one more than vectors
  std::vector<int> place;
  std::vector<double> value;

  void clear() {
    begin.resize(1);
    place.clear();
    value.clear();
  }
  void add(int at, double x) {
    place.push_back(at);
    value.push_back(x);
  }
  void end_vector() { begin.push_back(place.size()); }
};

/// A sparse matrix A and its LU factors.
class SparseLu {
public:
  /// Starts the assembly of a matrix of n rows. If the pattern is the same as before, entries must be added in the same order.
  void begin(int n);
  /// Adds an entry. Entries at the same matrix position are summed.
  void add(int row, int column, double value) {
    const std::size_t k = count_++;
    if (is_known_ && k < rows_.size() && rows_[k] == row && columns_[k] == column) {
      values_[places_[k]] += value;
      return;
    }
    add_unknown(k, row, column, value);
  }
  /// Factorises the matrix. Returns false if it is singular or has entries that are not finite.
  [[nodiscard]] bool factor();
  /// In place: x = A⁻¹ x. Precondition: factor() returned true.
  void solve(double* x);

  // Solution in two factors, A⁻¹ = B F, which keep most zeros of sparse right-hand sides. Precondition as for solve().
  // Appends F b for the vector b with `count` entries `values` at `rows`.
  void append_forward(const int* rows, const double* values, int count, SparseVectors& out);
  /// Appends Bᵀ c for the vector c with `count` entries `values` at `columns`, so that (Bᵀ c)·(F b) = c·A⁻¹b.
  void append_backward(const int* columns, const double* values, int count, SparseVectors& out);
  /// Computes x = B y; y has an entry for each row of A.
  void finish(const double* y, double* x);

private:
  void finish_work(double* x);
  void start_at(int position, double value);
  template <class Column> void append_reached(const Column& column, SparseVectors& out);
  void transpose_upper();

  void add_unknown(std::size_t k, int row, int column, double value);
  void analyze();
  [[nodiscard]] bool refactor();
  [[nodiscard]] bool factor_with_pivoting();
  [[nodiscard]] int reach(int column);
  void visit(int row, int& top);

  /// A pivot below this fraction of the largest candidate in its column is not reused.
  static constexpr double k_pivot_share = 1e-3;

  int n_ = 0;
  std::size_t count_ = 0; ///< number of entries since begin()
  bool is_known_ = false; ///< the entries added so far agree with the analysed pattern
  bool has_pivots_ = false;
  std::vector<int> rows_, columns_; ///< row and column of each added entry
  std::vector<int> places_;         ///< index in values_ of each added entry
  std::vector<double> added_;       ///< added values while the pattern is unknown
  std::vector<int> begin_, index_;  ///< compressed columns of the matrix
  std::vector<double> values_;
  std::vector<int> order_;    ///< order_[k]: column eliminated in step k
  std::vector<int> position_; ///< elimination step of each row; −1: none yet
  std::vector<int> pivot_;    ///< row of pivot k
  std::vector<double> inverse_pivot_;
  std::vector<int> l_begin_, l_row_, u_begin_,
      u_position_; ///< columns of U, as elimination steps
  std::vector<double> l_, u_;
  std::vector<double> work_; ///< scratch vector, one number per row; zero between calls
  std::vector<int> stack_, resume_, found_, mark_;
  int stamp_ = 0;
  bool has_transposed_ = false;
  std::vector<int> step_of_column_; ///< inverse of order_
  /// U by rows: elimination steps of the columns, and indices in the arrays of U
  std::vector<int> row_begin_, row_step_, row_place_, row_next_;
  std::vector<int> queue_; ///< heap of elimination steps
};

} // namespace steplap
