// The rows of a scene at rest for sparse equations: over scaled coordinates, of unit length, each with those that others imply told
// from the rest.
#pragma once

#include "mbd/dynamics/schur.h"
#include "mbd/rest/bordered_system.h"
#include "mbd/rest/statics.h"

#include <vector>

namespace steplap {

class SparseRows {
public:
  /// At the present evaluation of `statics`; rows that are known to depend on others are left empty.
  void measure(const Statics& statics, const VecX& scale);
  /// The same, and asks anew which rows depend on others, by the rule of the equations of motion (schur.h): what is next to
  /// nothing beyond the others would hold what nothing holds.
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
  std::vector<int> bodies_; ///< that rank_ was analysed for
  SchurSolver rank_;
};

} // namespace steplap
