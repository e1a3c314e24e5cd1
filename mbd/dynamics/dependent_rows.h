// Which rows of friction depend on others so nearly that they stay out of the equations (schur.h).
#pragma once

#include "mbd/base/types.h"

#include <vector>

namespace steplap {

/// A row's gradient in the masses' metric, or what of it is beyond rows that are taken anyway; `length`: of all of it.
struct WeightedRow {
  VecX row;
  double length = 0.0;
};

/// Per row: it is one of those that `can_stay_out`, and stays out.
[[nodiscard]] std::vector<char> dependent_rows(const std::vector<WeightedRow>& rows, const char* can_stay_out,
                                               const std::vector<char>& was_out);

} // namespace steplap
