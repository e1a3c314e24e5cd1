// Does a machine stay where it is only because nothing disturbs it?
//
// A rod that stands on its end, or a column pressed beyond what it can bear straight, stays so to the last bit in a scene that is
// exactly symmetric: with every method and at every tolerance, so that finer runs agree and energies balance. Nothing real is
// that exact. So where a coordinate that could move keeps its place to rounding from the start of a run to its end, the run is made
// again from poses that are a hair off in all such coordinates. What is stable stays as near as it began, what is let go drifts or
// falls; what balances leaves exponentially, which takes as long from a hundred to ten thousand times the nudge as it took to a hundred.
#pragma once

#include "mbd/simulation/simulation.h"

#include <optional>
#include <string>

namespace steplap {

/// A coordinate that stays where it is, and leaves when it is nudged.
struct Balance {
  std::string body;   ///< its name
  int coordinate = 0; ///< 0, 1, 2: x, y or angle
  double t = 0.0;     ///< s, when it had gone further than k_grown_nudge times its nudge
};

/// How far a nudge grows where a machine balances. Levers and slow swings make some ten or hundred times of it; and an
/// imperfection of a tenth of a millimetre, which is little in what is built, comes to a metre.
inline constexpr double k_grown_nudge = 1e4;

/// `run` was made from `initial` with `options`, which ask for extremes. None: all that could move does, or returns, or drifts.
/// Throws EstimateTooDear if the run from nudged poses takes more than `most_evaluations`.
[[nodiscard]] std::optional<Balance> balance_of(const System& system, const State& initial, const SimulationOptions& options,
                                                const RunResult& run, double most_evaluations);

} // namespace steplap
