// From one leg of a run to the next: what the state of one system is in another of the same model, in which other elements act.
//
// Places and velocities of bodies go on. So does what elements that act in both remember: modes, phases of friction, anchors, inner states.
// What is released bears nothing from there on, and the energy that it has stored is dissipated. What begins to act does so where the
// bodies are: a weld, a slide and a rod hold the pose that they find; a pin and a rope have to fit. Where velocities do not fit they jump
// (mbd/events/blow.h). A drive that is set anew begins at the place and, if it is read as an acceleration, at the velocity that it finds.
// Energy that appears with a spring that begins to act, or is made stiffer, is booked as work.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Two systems of one model, and what is different.
struct Changeover {
  const System& from;            ///< of the leg before
  const System& to;              ///< of the leg that begins
  std::vector<char> acted, acts; ///< per element: in `from`, in `to`
  std::vector<char> begins;      ///< it acts in `to`, and did not in `from` or is set otherwise

  /// It acts in `to` and did not in `from`.
  [[nodiscard]] bool closes(int element) const {
    return acts[static_cast<std::size_t>(element)] != 0 && acted[static_cast<std::size_t>(element)] == 0;
  }
  /// Some row or rope of `to` begins: velocities may have to jump.
  [[nodiscard]] bool closes_rows() const;
};

/// `state` of `from`, in `to`: of what begins there the bases of rows are still those of the reference pose.
[[nodiscard]] State carried(const Changeover& change, const State& state);

/// Joints that close hold the pose of `state`, ropes are taut or slack at it. Throws ElementFailure for what does not fit.
void place_what_closes(const Changeover& change, State& state);

/// What elements store in `after`, more or less than in `before`, both at the same places.
void book_stored_energy(const Changeover& change, const State& before, State& after);

} // namespace steplap
