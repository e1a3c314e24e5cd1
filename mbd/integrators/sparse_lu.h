// LU factors of a sparse square matrix whose pattern stays the same from step to step.
//
// Columns are ordered once for a pattern (COLAMD). The first factorisation finds the pattern of the
// factors column by column, each by a depth-first search through the columns of L before it, with
// row pivoting (J. R. Gilbert, T. Peierls, SIAM J. Sci. Stat. Comput. 9 (1988) 862; T. A. Davis,
// Direct Methods for Sparse Linear Systems, §6.2). Later ones run over the lists of that one, with
// its pivots, as long as none of them is much smaller than another that its column offers (T. A.
// Davis, E. Palamadai Natarajan, ACM TOMS 37 (2010) 36); else rows are chosen anew. Once the lists
// have their length nothing is allocated.
//
// By hand, and not KLU of SuiteSparse: faster on chains, slower on middling grids (docs/design/tried_and_left_out.md).
#pragma once

#include "mbd/base/types.h"

#include <vector>

namespace steplap {

class SparseLu {
public:
  /// Begins a matrix of n rows; add() its entries, always in the same order while the pattern is
  /// the same.
  void begin(int n);
  /// Entries at the same place add up.
  void add(int row, int column, double value) {
    const std::size_t k = count_++;
    if (is_known_ && k < rows_.size() && rows_[k] == row && columns_[k] == column) {
      values_[places_[k]] += value;
      return;
    }
    add_unknown(k, row, column, value);
  }
  /// False if the matrix is singular, or an entry is not finite.
  [[nodiscard]] bool factor();
  /// In place: x = A⁻¹ x.
  void solve(double* x);

private:
  void add_unknown(std::size_t k, int row, int column, double value);
  void analyze();
  [[nodiscard]] bool refactor();
  [[nodiscard]] bool factor_anew();
  [[nodiscard]] int reach(int column);
  void visit(int row, int& top);

  /// A pivot below this share of the largest entry that its column offers is not used again.
  static constexpr double k_pivot_share = 1e-3;

  int n_ = 0;
  std::size_t count_ = 0; ///< entries added since begin()
  bool is_known_ = false; ///< entries so far are those of the pattern analysed
  bool has_pivots_ = false;
  std::vector<int> rows_, columns_; ///< per entry added
  std::vector<int> places_;         ///< per entry added: where it goes in values_
  std::vector<double> added_;       ///< values as added, while the pattern is not known
  std::vector<int> begin_, index_;  ///< the matrix by columns
  std::vector<double> values_;
  std::vector<int> order_;    ///< order_[k]: column eliminated as k-th
  std::vector<int> position_; ///< of a row among the pivots, −1 if it is none yet
  std::vector<int> pivot_;    ///< row of the k-th pivot
  std::vector<double> inverse_pivot_;
  std::vector<int> l_begin_, l_row_, u_begin_,
      u_position_; ///< U's columns in an order of elimination
  std::vector<double> l_, u_;
  std::vector<double> work_; ///< per row, zero between uses
  std::vector<int> stack_, resume_, found_, mark_;
  int stamp_ = 0;
};

} // namespace steplap
