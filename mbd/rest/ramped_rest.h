// Static equilibrium of a machine whose loads have increased slowly from those under which it rested.
//
// find_equilibrium (equilibrium.h) asks whether a machine can rest with any admissible distribution of friction forces. Under a slowly
// growing load the distribution is determined by the whole path of the load: sticking friction holds its position, and slides at its bound
// once that is reached. So the path is followed: the load grows in increments, each from the last rest to the next. Friction is implicit, with
// the normal forces of the end (J. J. Moreau, Evolution problem associated with a moving convex set, J. Differential Equations 26 (1977)
// 347). A few trials usually find the set of friction that slides; otherwise the machine creeps without inertia (settling.h).
//
// An increment is exact at any length if the same friction sticks and slides, and the same contacts are closed, at its start and end: forces
// are then linear in the load, and the utilisation of friction is convex. Any other increment is halved, down to 1/4096 of the load: two
// halves that agree prove nothing, since friction that began and ended sliding between them is in neither. If no rest near by is found for
// the shortest increment, the machine leaves its place.
//
// Friction that has slid and does not end at its bound against its slide has passed the rest of a growing load. If it does so in the shortest
// increment, the machine jumps, and where it stops depends on its inertia, which this path does not know.
#pragma once

#include "mbd/rest/equilibrium.h"
#include "mbd/system/element_failure.h"

#include <functional>
#include <optional>

namespace steplap {

/// Error of a search that did not converge, so that it is unknown whether an equilibrium exists.
class RestNotFound : public ElementFailure {
public:
  using ElementFailure::ElementFailure;
};

/// An equilibrium on the path of a growing load.
struct RampedRest : Equilibrium {
  std::vector<int> sliding; ///< friction elements that slide on while the load grows: they have slid, and are at their bounds
};

/// A load that grows: gravity, m/s², from one vector to another in a straight line.
struct GravityRamp {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
  double first = 1.0; ///< share of the ramp: length of the first increment that is tried, and of that after each change of modes
};

/// Forces of one unit.
struct ForcesOfUnit {
  std::vector<double> values;
  double rounding = 0.0; ///< smaller differences have no meaning
};

/// Requests for each equilibrium on the path.
struct RampQuestions {
  /// Returns the forces by which increments are compared; each list has its own unit.
  std::function<std::vector<ForcesOfUnit>(const RampedRest& rest)> forces;
  /// Called for each equilibrium of the path, from the start to the last one; `share` of the ramp lies before it. While modes stay,
  /// utilisation of friction is convex in the load, so its largest values are among these.
  std::function<void(const RampedRest& rest, double share)> on_rest;
  /// Called for each jump: the friction element that has passed a rest, and the share of the ramp at its end.
  std::function<void(int friction, double share)> on_jump;
};

/// Returns the equilibrium at the end of `ramp`, from `start`, an equilibrium under `ramp.from`. `slid` lists friction that slid anywhere on
/// the path, `sliding` what slides on at its end. Changes of modes are located within 1/4096 of the load. The gravity of `system` is restored
/// at the end. Throws NumericalFailure if the machine leaves its place, RestNotFound if that is not known.
[[nodiscard]] RampedRest find_ramped_rest(System& system, const RampedRest& start, const GravityRamp& ramp, const RampQuestions& questions);

/// Returns the largest difference of forces, as a share of themselves, or, if they are less than `small` of the largest one of their unit, of
/// that. Infinite if only one of two has a value.
[[nodiscard]] double largest_difference(const std::vector<ForcesOfUnit>& x, const std::vector<ForcesOfUnit>& y, double small);

/// Returns the equilibrium near `before`, an equilibrium under slightly different loads. Friction sticks at its place in `before` while its
/// bound allows; else it slides, at the bound for the normal forces of the new equilibrium. `sliding` lists what slides at the end, `slid`
/// also what slid on the way. `may_creep`: if no set of sliding friction is consistent, follows the machine as it creeps, which costs some
/// hundred times more. Throws NumericalFailure if there is no equilibrium near by, RestNotFound if that is not known.
[[nodiscard]] RampedRest rest_after_increment(const System& system, const RampedRest& before, bool may_creep);

/// Returns the equilibrium under the gravity of `system` in which all friction sticks as in `start`; nothing if friction slides, or if that is
/// not known. As long as nothing has slid, it is that of any ramp, found at once. Throws NumericalFailure if the machine leaves its place with
/// all friction sticking.
[[nodiscard]] std::optional<Equilibrium> find_still_rest(const System& system, const Equilibrium& start);

} // namespace steplap
