// Rows over more than two bodies: what their parts beyond the first add to the equations (row.h, layout.h).
//
// Such a row's gradient, second rate and value are sums over its parts, and so is everything that is linear in it: each part
// is filled in as a row of two bodies is, in ground axes, and has its row's multiplier.
#include "mbd/dynamics/constraint_solution.h"
#include "mbd/dynamics/row_pull.h"

#include <algorithm>

namespace steplap {

template <bool WithBias> MeasureValue<double> ConstraintSolution::load_part(std::size_t i) {
  const RowSpec& part = *layout_->part_specs[i];
  MeasureValue<double> m = evaluate_row<WithBias>(part, motion_[part.a], motion_[part.b]);
  put_in_clusters<WithBias>(*layout_, part, motion_, m, layout_->schur_rows[layout_->parts[i].row]);
  return m;
}

void ConstraintSolution::pull_parts() {
  for (std::size_t i = 0; i < layout_->parts.size(); ++i) multiplier_[layout_->parts[i].of] -= load_part<true>(i).bias;
}

void ConstraintSolution::compare_parts() {
  for (std::size_t i = 0; i < layout_->parts.size(); ++i) {
    const MeasureValue<double> m = load_part<false>(i);
    off_[layout_->parts[i].of] += m.value;
    rate_off_[layout_->parts[i].of] += m.rate;
  }
}

void ConstraintSolution::take_part_accelerations(const double* a, double* right) const {
  for (const SchurPart& part : layout_->parts)
    right[part.of] = less_accelerations(layout_->schur_rows[part.row], right[part.of], a);
}

void ConstraintSolution::add_part_responses(const double* lambda, double* a) const {
  for (const SchurPart& part : layout_->parts) {
    const SchurRow& row = layout_->schur_rows[part.row];
    for (int side = 0; side < 2; ++side)
      if (row.body[side] >= 0)
        for (int c = 0; c < 3; ++c) a[3 * row.body[side] + c] += row.wj[side][c] * lambda[part.of];
  }
}

double ConstraintSolution::along_parts(std::size_t r, const double* change) const {
  const std::vector<SchurPart>& parts = layout_->parts; // in the order of their rows
  auto part = std::lower_bound(parts.begin(), parts.end(), static_cast<int>(r),
                               [](const SchurPart& p, int row) { return p.of < row; });
  double sum = 0.0;
  for (; part != parts.end() && part->of == static_cast<int>(r); ++part)
    sum -= less_accelerations(layout_->schur_rows[part->row], 0.0, change);
  return sum;
}

} // namespace steplap
