// Samples a function of one variable along its range, more closely where it may touch zero or cross it twice.
#pragma once

#include <functional>
#include <vector>

namespace steplap::study {

/// Values of a function at points in ascending order.
struct LineSamples {
  std::vector<double> x, g; ///< points in ascending order, and function values; NaN: no value
};

/// Evaluates the function at several points. NaN: no value.
using LineFunction = std::function<std::vector<double>(const std::vector<double>& xs)>;

/// Returns `points` values from `low` to `high`, both included.
[[nodiscard]] std::vector<double> evenly_spaced(double low, double high, long points);
/// Evaluates the function at the points `more`, once each, and inserts them into `samples`.
void add_samples(const LineFunction& function, std::vector<double> more, LineSamples& samples);
/// Adds samples around local minima of |g| without a sign change, where the function may touch zero or cross it twice. Four rounds treat
/// the six points nearest to zero, each with 1/8 of the previous distance.
void refine_turns(const LineFunction& function, LineSamples& samples);

} // namespace steplap::study
