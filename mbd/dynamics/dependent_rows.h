// Selects friction rows that depend (nearly) linearly on other rows and are therefore left out of the equations (schur.h).
#pragma once

#include "mbd/base/types.h"

#include <vector>

namespace steplap {

/// Gradient of a row in the metric of W, or its part orthogonal to rows that are always kept. `length` is the length of the whole gradient.
struct WeightedRow {
  VecX row;
  double length = 0.0;
};

/// Returns for each row whether it is left out. Only rows marked in `can_stay_out` may be left out. `was_out` is the previous decision,
/// which is changed only beyond a hysteresis.
[[nodiscard]] std::vector<char> dependent_rows(const std::vector<WeightedRow>& rows, const char* can_stay_out,
                                               const std::vector<char>& was_out);

} // namespace steplap
