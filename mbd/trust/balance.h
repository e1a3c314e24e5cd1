// Does a machine stay where it is only because nothing disturbs it?
//
// A rod that stands on its end, or a column pressed beyond what it can bear straight, stays so to the last bit in a scene that is
// exactly symmetric: with every method and at every tolerance, so that finer runs agree and energies balance. Nothing real is
// that exact. So each leg of a run is asked in which directions of the configuration space it did not move (leg_motion.h), and whether
// a nudge in these directions grows.
//
// 1. Stiffness: how fast small displacements would grow if the instant lasted (frozen_growth.h), at instants spread over the leg. The
//    integral of that rate over the leg is the exponent of what grows. A leg whose exponent, or that of one second at the same mean rate, does
//    not exceed k_exponent has no balance of this kind. Where nothing moves that decides at once.
// 2. Nudge: what the stiffness says is confirmed by two runs of the leg, from a nudge in a pseudo-random direction and from its mirror
//    image. Half their difference has to grow by half the exponent, or to k_grown_nudge. Stops on either side and supports that vibrate
//    keep it small. A leg in which the nudge grows too little to be seen above rounding is left to the stiffness.
// 3. Where something moves and the stiffness finds nothing, one nudged run looks for growth by other means, such as slots that turn or
//    parametric resonance; growth by less than k_far_grown_nudge has to show as exponential in two runs, as above. In legs in which the bodies that
//    a nudge moves have events such growth is motion itself: rattling, rebounds, chaos.
#pragma once

#include "mbd/simulation/simulation.h"

#include <optional>
#include <string>

namespace steplap {

/// A body that stays where it is, and leaves when it is nudged.
struct Balance {
  std::string body;       ///< the one that leaves fastest
  int coordinate = 0;     ///< 0: along `direction`; 2: it turns
  double direction = 0.0; ///< rad, of its displacement against the x axis, in (−π/2, π/2]
  double t = 0.0;         ///< s, since when
  double rate = 0.0;      ///< 1/s, mean: a nudge grows as exp(rate t)
};

/// Exponent of growth, over the longer of the leg and one second, from which on a machine balances.
inline constexpr double k_exponent = 3.0;
/// How far a nudge has to grow to show that what the stiffness says is so.
inline constexpr double k_grown_nudge = 100.0;
/// The same where the stiffness says nothing and one nudged run decides. Levers and slow swings make some ten or hundred times of it; and an
/// imperfection of a tenth of a millimetre, which is little in what is built, comes to a metre.
inline constexpr double k_far_grown_nudge = 1e4;

/// `run` was made from `initial` with `options`, with notes of its motion (SimulationOptions::notes_motion). None: all that could move does,
/// or returns, or drifts. Throws EstimateTooDear if the nudged runs take more than `most_evaluations`.
[[nodiscard]] std::optional<Balance> balance_of(const System& system, const State& initial, const SimulationOptions& options,
                                                const RunResult& run, double most_evaluations);

} // namespace steplap
