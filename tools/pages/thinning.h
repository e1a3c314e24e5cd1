// Reduces the samples of a curve without a visible change: keeps the minimum and maximum of every interval.
#pragma once

#include <cstddef>
#include <vector>

namespace steplap {

/// Returns indices, ascending, of at most about 2 `stretches` + 2 values: the first, the last, and the minimum and maximum of each
/// interval, with the first NaN of an interval if it contains any. Returns all indices if there are no more values than that.
[[nodiscard]] std::vector<std::size_t> thinned(const std::vector<double>& values, std::size_t stretches);

} // namespace steplap
