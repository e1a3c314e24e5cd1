#include "tools/study/crossing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace steplap::study {

double Crossing::root() const { return std::abs(g_low) < std::abs(g_high) ? low : high; }

namespace {

struct Closing {
  double low, high; ///< function values at the ends; halved if an end stays unchanged (Illinois rule)
  double first;     ///< larger magnitude of both initial function values
  int stuck = 0;
};

void take(Crossing& c, Closing& closing, double x, double g) {
  if (std::isnan(g)) {
    c.is_bad = true;
    return;
  }
  if ((g < 0.0) == (c.g_low < 0.0)) {
    c.low = x;
    c.g_low = closing.low = g;
    closing.stuck = std::max(closing.stuck, 0) + 1;
    if (closing.stuck > 1) closing.high *= 0.5;
  } else {
    c.high = x;
    c.g_high = closing.high = g;
    closing.stuck = std::min(closing.stuck, 0) - 1;
    if (closing.stuck < -1) closing.low *= 0.5;
  }
}

} // namespace

void close_crossings(std::vector<Crossing>& crossings, double tolerance, const BatchFunction& function) {
  std::vector<Closing> closing;
  for (const Crossing& c : crossings) closing.push_back({c.g_low, c.g_high, std::max(std::abs(c.g_low), std::abs(c.g_high))});
  for (int round = 0; round < 200; ++round) {
    std::vector<std::size_t> which;
    std::vector<double> at;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      const Crossing& c = crossings[i];
      // an end value of zero does not end the search, because it may be a rounding error
      if (c.is_bad || c.high - c.low <= tolerance) continue;
      double x = c.high - closing[i].high * (c.high - c.low) / (closing[i].high - closing[i].low);
      // The new point keeps this distance from both ends, so that the interval shrinks from both sides.
      const double inside = 0.3 * tolerance;
      x = round % 4 == 3 ? 0.5 * (c.low + c.high) : std::clamp(x, c.low + inside, c.high - inside);
      which.push_back(i);
      at.push_back(x);
    }
    if (which.empty()) break;
    const std::vector<double> values = function(which, at);
    for (std::size_t k = 0; k < which.size(); ++k) take(crossings[which[k]], closing[which[k]], at[k], values[k]);
  }
  constexpr double k_continuous = 1e-3; // a larger remaining value, relative to the initial values, is a jump
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    Crossing& c = crossings[i];
    c.is_jump = !c.is_bad && std::min(std::abs(c.g_low), std::abs(c.g_high)) > k_continuous * closing[i].first;
  }
}

} // namespace steplap::study
