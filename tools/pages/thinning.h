// Reduces the samples of a curve without a visible change: keeps the minimum and maximum of every interval.
#pragma once

#include <cstddef>
#include <vector>

namespace steplap {

/// Returns ascending indices of at most about 2 `stretches` + 2 values: the first, the last, and the minimum and maximum of each of
/// `stretches` intervals, with the first NaN of an interval that contains any. Returns all indices if there are fewer values.
[[nodiscard]] std::vector<std::size_t> thinned(const std::vector<double>& values, std::size_t stretches);

} // namespace steplap
