// Detects unstable equilibria that a run keeps only because its model has no disturbance.
//
// A rod that stands on its end, or a column above its buckling load, stays straight to the last bit in an exactly symmetric model. This
// happens with every method and tolerance, so finer runs agree and energies balance. No real machine is that exact. For each leg of a run
// (the part in which the same elements are active) the directions in which it did not move (leg_motion.h) are examined: does a small
// displacement along them grow?
//
// 1. Stiffness: growth rate σ of small displacements with forces and stiffness frozen at an instant (frozen_growth.h), at instants spread
// over the leg. The exponent is ∫σ dt over the leg. If neither this nor the mean rate times one second exceeds k_exponent, there is no
// unstable equilibrium of this kind. If nothing moves, this decides alone. 2. Nudge: two runs of the leg confirm the stiffness, one from a
// pseudo-random displacement and one from its mirror image. Half their difference must grow by half the exponent, or to k_grown_nudge. It
// stays small between stops on either side and on supports that vibrate. If the growth is too small to be seen above rounding, the
// stiffness decides. 3. If something moves and the stiffness shows no growth, one nudged run looks for other causes, such as rotating slots
// or parametric resonance. Growth by less than k_far_grown_nudge must be exponential in two runs as above. If the bodies that a nudge moves
// have events in the leg, growth is taken as motion (rattling, rebounds, chaos).
#pragma once

#include "mbd/simulation/simulation.h"

#include <optional>
#include <string>

namespace steplap {

/// Body in an unstable equilibrium.
struct Balance {
  std::string body;       ///< name of the body that leaves fastest
  int coordinate = 0;     ///< 0: it moves along `direction`; 2: it turns
  double direction = 0.0; ///< angle of its displacement to the x axis, rad, in (−π/2, π/2]
  double t = 0.0;         ///< start of the equilibrium, s
  double rate = 0.0;      ///< mean growth rate, 1/s: a displacement grows as exp(rate t)
};

/// Least exponent of an unstable equilibrium, over the leg or one second, whichever is longer.
inline constexpr double k_exponent = 3.0;
/// Growth of a nudge that confirms an instability found by the stiffness.
inline constexpr double k_grown_nudge = 100.0;
/// Growth of a nudge that shows an instability if the stiffness shows none and one run decides. Levers and slow oscillations magnify by ten
/// to some hundred. At 1e4 an imperfection of 0.1 mm, usual in a real machine, becomes 1 m.
inline constexpr double k_far_grown_nudge = 1e4;

/// Returns the first unstable equilibrium of `run`, or nothing. `run` was made from `initial` with `options` and recorded its motion
/// (SimulationOptions::notes_motion). Throws EvaluationBudgetExceeded if the nudged runs need more than `most_evaluations` evaluations.
[[nodiscard]] std::optional<Balance> balance_of(const System& system, const State& initial, const SimulationOptions& options,
                                                const RunResult& run, double most_evaluations);

} // namespace steplap
