// Rows over more than two bodies: contributions of the second and further parts to the equations (row.h, layout.h).
//
// Gradient, bias and value of such a row are sums over its parts. Each part is computed like a row between two bodies, in ground axes. All
// parts have the multiplier of the row.
#include "mbd/dynamics/constraint_solution.h"
#include "mbd/dynamics/row_pull.h"

#include <algorithm>

namespace steplap {

void ConstraintSolution::pull_parts() { steplap::pull_parts(*layout_, motion_, layout_->schur_rows.data(), multiplier_.data()); }

void ConstraintSolution::compare_parts() {
  for (std::size_t i = 0; i < layout_->parts.size(); ++i) {
    const MeasureValue<double> m = load_part<false>(*layout_, i, motion_, layout_->schur_rows.data());
    off_[layout_->parts[i].of] += m.value;
    rate_off_[layout_->parts[i].of] += m.rate;
  }
}

void ConstraintSolution::subtract_part_accelerations(const double* a, double* right) const {
  steplap::subtract_part_accelerations(*layout_, layout_->schur_rows.data(), a, right);
}

void ConstraintSolution::add_part_responses(const double* lambda, double* a) const {
  steplap::add_part_responses(*layout_, layout_->schur_rows.data(), lambda, a);
}

double ConstraintSolution::along_parts(std::size_t r, const double* change) const {
  const std::vector<SchurPart>& parts = layout_->parts; // sorted by row
  auto part = std::lower_bound(parts.begin(), parts.end(), static_cast<int>(r), [](const SchurPart& p, int row) { return p.of < row; });
  double sum = 0.0;
  for (; part != parts.end() && part->of == static_cast<int>(r); ++part)
    sum -= less_accelerations(layout_->schur_rows[part->row], 0.0, change);
  return sum;
}

} // namespace steplap
