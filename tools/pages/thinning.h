// Fewer samples that look the same: of every stretch of a curve its lowest and its highest point.
#pragma once

#include <cstddef>
#include <vector>

namespace steplap {

/// Indices, ascending, of at most about 2 `stretches` + 2 of the values: first, last, and the least and
/// the largest of each stretch; of a stretch that holds some not-a-number, the first such besides. All, if
/// there are no more than that.
[[nodiscard]] std::vector<std::size_t> thinned(const std::vector<double>& values, std::size_t stretches);

} // namespace steplap
