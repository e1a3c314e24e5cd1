// Samples a function of one variable along its range, more closely where it may touch zero or cross it twice.
#pragma once

#include <functional>
#include <vector>

namespace steplap::study {

/// Values of a function at points in ascending order.
struct LineSamples {
  std::vector<double> x, g; ///< points; values, NaN: no value
};

/// Evaluates the function at several points. NaN: no value.
using LineFunction = std::function<std::vector<double>(const std::vector<double>& xs)>;

/// Returns `points` values from `low` to `high`, both included.
[[nodiscard]] std::vector<double> evenly_spaced(double low, double high, long points);
/// Evaluates the function at the points `more`, once each, and inserts them into `samples`.
void add_samples(const LineFunction& function, std::vector<double> more, LineSamples& samples);
/// Adds samples next to points at which the function has the same sign as at both neighbours and is closer to zero: it may touch zero or
/// cross it twice there. The search takes four rounds, each eight times as close, at the six points that are closest to zero.
void refine_turns(const LineFunction& function, LineSamples& samples);

} // namespace steplap::study
