// Static equilibrium of a machine whose loads have increased slowly from those under which it rested.
//
// find_equilibrium (equilibrium.h) asks whether a machine can rest with any admissible distribution of friction forces. Under a slowly
// growing load the distribution is determined by the whole path of the load: sticking friction holds its position, and slides at its bound
// once that is reached. So the path is followed:
//   the load grows in increments s₀ < s₁ < … ,
//   q(sᵢ₊₁) minimises potential energy at sᵢ₊₁ plus the friction work from q(sᵢ), with the normal forces at the end of the increment
// (J. J. Moreau, Evolution problem associated with a moving convex set, J. Differential Equations 26 (1977) 347). An increment is exact
// at any length if the same friction sticks and slides, and the same contacts are closed, at its start and end: forces are then linear in
// the load, and the utilisation of friction is convex. Any other increment is computed at once and in two halves, and halved until both
// give the same forces. If no minimum near by is found for the shortest increment, the machine leaves its place.
#pragma once

#include "mbd/rest/equilibrium.h"
#include "mbd/system/element_failure.h"

#include <functional>

namespace steplap {

/// Error: the search did not converge, so it is unknown whether an equilibrium exists.
class RestNotFound : public ElementFailure {
public:
  using ElementFailure::ElementFailure;
};

/// A load that grows: gravity, m/s², from one vector to another in a straight line.
struct GravityRamp {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
};

/// Requests for each equilibrium on the path.
struct RampQuestions {
  /// Returns the forces by which increments are compared; each list has its own unit.
  std::function<std::vector<std::vector<double>>(const Equilibrium& rest)> forces;
  /// Called for each equilibrium of the path, including the last one; `share` of the ramp lies before it.
  std::function<void(const Equilibrium& rest, double share)> on_rest;
};

/// Returns the equilibrium at the end of `ramp`, from `start`, an equilibrium under `ramp.from`. `slid` lists friction that slid anywhere on
/// the path, `sliding` what slides on at its end. Forces of one increment are known to 2e-4. The gravity of `system` is restored at the end. Throws NumericalFailure if the
/// machine leaves its place, RestNotFound if the search does not converge.
[[nodiscard]] Equilibrium find_ramped_rest(System& system, const Equilibrium& start, const GravityRamp& ramp, const RampQuestions& questions);

} // namespace steplap
