// Constraint rows of a model at rest for sparse equations: in scaled coordinates, normalised to unit length, with dependent rows marked.
#pragma once

#include "mbd/dynamics/schur.h"
#include "mbd/rest/bordered_system.h"
#include "mbd/rest/statics.h"

#include <vector>

namespace steplap {

class SparseRows {
public:
  /// Computes the rows at the present evaluation of `statics`. Rows that are known to be dependent become empty.
  void measure(const Statics& statics, const VecX& scale);
  /// Computes the rows and determines anew which are dependent, by the rule of the equations of motion (schur.h). A nearly dependent row,
  /// if it were kept, would hold motions that are free.
  void measure_and_rank(const Statics& statics, const VecX& scale);

  [[nodiscard]] const std::vector<SparseRow>& rows() const { return rows_; }
  [[nodiscard]] const VecX& size() const { return size_; } ///< lengths of the scaled gradients
  [[nodiscard]] bool is_dependent(std::size_t row) const { return is_dependent_[row] != 0; }

private:
  void measure_all(const Statics& statics, const VecX& scale);
  void find_dependent(const Statics& statics);
  void drop_dependent();

  std::vector<SparseRow> rows_;
  VecX size_;
  std::vector<char> is_dependent_;
  std::vector<int> bodies_; ///< bodies on which the rows act, for which rank_ was analysed
  SchurSolver rank_;
};

} // namespace steplap
