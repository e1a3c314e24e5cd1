// Selection of friction rows that are nearly linearly dependent on others and are therefore left out of the equations (schur.h).
#pragma once

#include "mbd/base/types.h"

#include <vector>

namespace steplap {

/// Gradient of a row in the metric of W, possibly reduced to the part orthogonal to rows that are always kept; `length` is that of the
/// whole gradient.
struct WeightedRow {
  VecX row;
  double length = 0.0;
};

/// Returns for each row whether it is left out. Only rows with `can_stay_out` may be; `was_out` is the previous decision, for hysteresis.
[[nodiscard]] std::vector<char> dependent_rows(const std::vector<WeightedRow>& rows, const char* can_stay_out,
                                               const std::vector<char>& was_out);

} // namespace steplap
