// Locates zeros of a function of one variable that is evaluated in batches, several zeros at a time.
#pragma once

#include <functional>
#include <vector>

namespace steplap::study {

/// An interval with different signs of the function at its ends.
struct Crossing {
  double low = 0.0, high = 0.0, g_low = 0.0, g_high = 0.0;
  bool is_jump = false; ///< true if the function jumps over zero
  bool is_bad = false;  ///< true if a run inside the interval gave no value; the interval is then not reduced further

  /// Returns the end at which the function is closer to zero.
  [[nodiscard]] double root() const;
};

/// Evaluates the function at several points, one for each crossing in `which`. NaN: no value.
using BatchFunction = std::function<std::vector<double>(const std::vector<std::size_t>& which, const std::vector<double>& at)>;

/// Reduces all intervals to `tolerance` by the Illinois method, with a bisection at every fourth iteration.
void close_crossings(std::vector<Crossing>& crossings, double tolerance, const BatchFunction& function);

} // namespace steplap::study
