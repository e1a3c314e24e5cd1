// Detects unstable equilibria that a run keeps only because its model has no disturbance.
//
// A rod that stands on its end, or a column above its buckling load, stays straight to the last bit if the model is exactly symmetric. This
// happens with every method and tolerance, so finer runs agree and energies balance. No real machine is that exact. A run consists of legs,
// in each of which the same elements are active. For each leg this file tests the directions in which nothing moved (leg_motion.h): does a
// small displacement along them grow?
//
// 1. Stiffness. The growth rate σ of small displacements, with forces and stiffness frozen at an instant (frozen_growth.h), is computed at
// instants spread over the leg. The exponent is ∫σ dt over the leg. If neither this nor the mean rate times one second exceeds k_exponent,
// there is no unstable equilibrium of this kind. If nothing moves in the leg, the test ends here.
//
// 2. Confirmation. The leg is run twice, from a pseudo-random small displacement (nudge) and from its mirror image. Half the difference of
// the two runs must grow by half the exponent, or by k_grown_nudge. It does not grow between stops on either side, or on supports that
// vibrate. If the predicted growth is too small to be seen above rounding, this test is omitted.
//
// 3. Other causes, such as rotating slots or parametric resonance. If something moves and the stiffness shows no growth, one run from a
// nudge is made. If the nudge grows by less than k_far_grown_nudge, exponential growth must be seen in two runs as above. If bodies that
// the nudge moves have events in the leg, growth counts as part of the motion (rattling, rebounds, chaos).
#pragma once

#include "mbd/simulation/simulation.h"

#include <optional>
#include <string>

namespace steplap {

/// A body in an unstable equilibrium.
struct UnstableBody {
  std::string body;       ///< name of the body that departs fastest
  int coordinate = 0;     ///< 0: it departs along `direction`; 2: it rotates
  double direction = 0.0; ///< angle of its displacement to the x axis, rad, in (−π/2, π/2]
  double t = 0.0;         ///< start of the equilibrium, s
  double rate = 0.0;      ///< mean growth rate, 1/s: a displacement grows as exp(rate t)
};

/// An equilibrium is unstable if its exponent over the leg, or over one second if that is longer, is at least this.
inline constexpr double k_exponent = 3.0;
/// Growth of a nudge that confirms an instability which the stiffness shows.
inline constexpr double k_grown_nudge = 100.0;
/// Growth of a nudge in a single run that shows an instability without the stiffness. Levers and slow oscillations magnify displacements by
/// ten to some hundred. At 1e4 an imperfection of 0.1 mm, usual in a real machine, becomes 1 m.
inline constexpr double k_far_grown_nudge = 1e4;

/// Returns the first unstable equilibrium of `run`; nothing if there is none. `run` must have been made from `initial` with `options` and
/// have recorded its motion (SimulationOptions::notes_motion). Throws EvaluationBudgetExceeded if the additional runs need more than
/// `most_evaluations` evaluations.
[[nodiscard]] std::optional<UnstableBody> balance_of(const System& system, const State& initial, const SimulationOptions& options,
                                                     const RunResult& run, double most_evaluations);

} // namespace steplap
