// Random events by a hair whose times are known in closed form: what holds under harmonic loads slips where a peak is above
// what it holds by a share `depth` of the load's range, and nowhere if the peak is as much below it; an oscillation closes a
// gap, or makes a rope taut, in the same way.
#pragma once

#include "mbd/simulation/simulation.h"

#include <cstdint>
#include <string>
#include <vector>

namespace steplap::testing {

enum class Hair { friction, step_lap, gap, rope };

struct DipCase {
  Hair hair = Hair::friction;
  std::string text;             ///< of the model
  std::string element;          ///< whose events count
  std::string begins;           ///< first words of its events
  std::vector<double> begin;    ///< their times, s, in closed form
  std::vector<double> rounding; ///< of each, s: that of the watched value, over its rate
  std::vector<double> motion;   ///< of each, s: a motion that is off by all of its range, over its rate
  double end = 1.0;             ///< of the run, s
  double fastest = 1.0;         ///< rad/s
  bool counts_all = true;       ///< false: only the first event is known
};

/// One case of its kind. `depth`: share of the range; negative: the peak is below.
[[nodiscard]] DipCase random_dip(Hair hair, std::uint64_t seed, double depth);

/// A depth over decades, of either sign, that this method at this tolerance can tell from none: 1e-7 where what is watched
/// is a load alone; where it moves, as much as motions may be off.
[[nodiscard]] double dip_depth(Hair hair, std::uint64_t seed, double tolerance);

struct DipOutcome {
  int wanted = 0, found = 0;
  double worst = 0.0;  ///< of the times, as a share of what is allowed
  std::string failure; ///< empty: it ran to its end
  [[nodiscard]] bool is_right() const { return failure.empty() && wanted == found && worst <= 1.0; }
};

/// `step_or_tolerance`: of fixed steps in periods of the fastest harmonic.
[[nodiscard]] DipOutcome outcome(const DipCase& dip, const std::string& integrator, double step_or_tolerance);

} // namespace steplap::testing
