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

/// A sparse matrix A and its LU factors.
class SparseLu {
public:
  /// Begins a matrix of n rows. Its entries must be added in the same order as before if the pattern is the same.
  void begin(int n);
  /// Adds an entry. Entries at the same place are summed.
  void add(int row, int column, double value) {
    const std::size_t k = count_++;
    if (is_known_ && k < rows_.size() && rows_[k] == row && columns_[k] == column) {
      values_[places_[k]] += value;
      return;
    }
    add_unknown(k, row, column, value);
  }
  /// Returns false if the matrix is singular or has entries that are not finite.
  [[nodiscard]] bool factor();
  /// In place: x = A⁻¹ x. Precondition: factor() returned true.
  void solve(double* x);

private:
  void add_unknown(std::size_t k, int row, int column, double value);
  void analyze();
  [[nodiscard]] bool refactor();
  [[nodiscard]] bool factor_anew();
  [[nodiscard]] int reach(int column);
  void visit(int row, int& top);

  /// A pivot below this fraction of the largest candidate in its column is not reused.
  static constexpr double k_pivot_share = 1e-3;

  int n_ = 0;
  std::size_t count_ = 0; ///< number of entries since begin()
  bool is_known_ = false; ///< entries so far agree with the analysed pattern
  bool has_pivots_ = false;
  std::vector<int> rows_, columns_; ///< per entry added
  std::vector<int> places_;         ///< per added entry: index in values_
  std::vector<double> added_;       ///< added values while the pattern is unknown
  std::vector<int> begin_, index_;  ///< compressed columns of the matrix
  std::vector<double> values_;
  std::vector<int> order_;    ///< order_[k]: column eliminated in step k
  std::vector<int> position_; ///< elimination step of each row; −1: none yet
  std::vector<int> pivot_;    ///< row of pivot k
  std::vector<double> inverse_pivot_;
  std::vector<int> l_begin_, l_row_, u_begin_,
      u_position_; ///< U's columns in an order of elimination
  std::vector<double> l_, u_;
  std::vector<double> work_; ///< per row, zero between calls
  std::vector<int> stack_, resume_, found_, mark_;
  int stamp_ = 0;
};

} // namespace steplap
