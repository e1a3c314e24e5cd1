// Conversion of the state between two legs of a run, from one system to another of the same model with other active elements or changed
// fields.
//
// Positions and velocities are kept, and so are modes, friction phases, anchors and inner states of elements active in both systems. A
// deactivated element exerts no force, and its stored energy is dissipated. An activated element starts at the present positions: a weld, a
// slide and a rod keep the present pose as their reference; a pin and a rope must fit the pose. Velocities that violate new constraints
// jump (mbd/events/blow.h). A drive with a new signal starts at the present position and, if the signal is an acceleration, at the present
// velocity. Energy that appears with an activated or stiffened spring is counted as work.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Two systems of one model with their differences.
struct Changeover {
  const System& from;            ///< system of the previous leg
  const System& to;              ///< system of the next leg
  std::vector<char> acted, acts; ///< per element: active in `from`, active in `to`
  std::vector<char> begins;      ///< active in `to`, and either inactive or with other values in `from`

  /// Returns true if the element is activated by the changeover.
  [[nodiscard]] bool closes(int element) const {
    return acts[static_cast<std::size_t>(element)] != 0 && acted[static_cast<std::size_t>(element)] == 0;
  }
  /// Returns true if a row or rope of `to` is activated, so that velocities may jump.
  [[nodiscard]] bool closes_rows() const;
};

/// Returns `state` of `from` converted to `to`. Rows of activated elements keep the constants of the reference pose until
/// place_what_closes().
[[nodiscard]] State carried(const Changeover& change, const State& state);

/// Sets the constants of activated joints from the pose of `state`, and the phases of ropes (taut or slack). Throws ElementFailure if a
/// joint or rope does not fit the pose.
void place_what_closes(const Changeover& change, State& state);

/// Adds the change of stored energy from `before` to `after` (same positions, different active elements) to work or dissipation of `after`.
void book_stored_energy(const Changeover& change, const State& before, State& after);

} // namespace steplap
