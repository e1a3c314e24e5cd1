// Zeros of a function that is only known by samples, several at a time.
#pragma once

#include <functional>
#include <vector>

namespace steplap::study {

/// An interval at whose ends the function differs in sign.
struct Crossing {
  double low = 0.0, high = 0.0, g_low = 0.0, g_high = 0.0;
  bool is_jump = false; ///< the function does not come to zero there: it jumps past it
  bool is_bad = false;  ///< a run inside gave no value: it is closed in no further

  /// The end at which the function is nearer to zero.
  [[nodiscard]] double root() const;
};

/// Values at several places; not-a-number where there is none. `which`: the crossing each is asked for.
using BatchFunction = std::function<std::vector<double>(const std::vector<std::size_t>& which, const std::vector<double>& at)>;

/// Closes all crossings in, to `tolerance` (Illinois' rule, with a bisection every fourth time).
void close_crossings(std::vector<Crossing>& crossings, double tolerance, const BatchFunction& function);

} // namespace steplap::study
