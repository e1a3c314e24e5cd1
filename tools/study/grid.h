// Points of a grid over several variables.
#pragma once

#include <functional>
#include <vector>

namespace steplap::study {

/// Calls `visit` with every combination of one level of each variable. The last variable changes fastest. No list is empty.
void visit_grid(const std::vector<std::vector<double>>& levels, const std::function<void(const std::vector<double>&)>& visit);

} // namespace steplap::study
