// Conversion of the state between two legs of a run, from one system to another of the same model with other active elements or changed
// fields.
//
// Positions and velocities are kept, and so are modes, friction phases, anchors and inner states of elements active in both. A deactivated
// element exerts no force, and its stored energy is dissipated. An activated element starts at the present positions: a weld, a slide and a
// rod keep the pose found; a pin and a rope must fit. Velocities that do not fit jump (mbd/events/blow.h). A drive with a new signal starts
// at the present position, and, if it is read as an acceleration, at the present velocity. Energy that appears with an activated or
// stiffened spring is counted as work.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Two systems of one model with their differences.
struct Changeover {
  const System& from;            ///< system of the previous leg
  const System& to;              ///< system of the next leg
  std::vector<char> acted, acts; ///< per element: active in `from`, active in `to`
  std::vector<char> begins;      ///< active in `to`, and in `from` inactive or with other values

  /// Returns true if the element is active in `to` and was not in `from`.
  [[nodiscard]] bool closes(int element) const {
    return acts[static_cast<std::size_t>(element)] != 0 && acted[static_cast<std::size_t>(element)] == 0;
  }
  /// Returns true if a row or rope of `to` is activated, so that velocities may jump.
  [[nodiscard]] bool closes_rows() const;
};

/// Returns `state` of `from` converted to `to`. Rows of activated elements still have the constants of the reference pose.
[[nodiscard]] State carried(const Changeover& change, const State& state);

/// Sets the constants of activated joints for the pose of `state`, and whether ropes are taut. Throws ElementFailure if a joint or rope
/// does not fit.
void place_what_closes(const Changeover& change, State& state);

/// Adds the difference of the stored energy of elements between `before` and `after` (both at the same positions) to work or dissipation of
/// `after`.
void book_stored_energy(const Changeover& change, const State& before, State& after);

} // namespace steplap
