// Finds the tilt at which bodies that support each other in several ways (a beam on two columns) lose their balance, and the motion of the
// collapse.
//
// Limit analysis of structures without tension (J. Heyman, The Stone Skeleton, 1995; R. K. Livesley, Int. J. Numer. Meth. Engng 12 (1978)
// 1853), with friction that does not slip. The structure is in balance as long as the loads P(φ) = A cos φ + B sin φ + C have no positive
// power in any motion that the contacts permit (gaps open or stay closed, nothing slides, joints hold). A are the weights, B the weights
// turned by a right angle, C the other loads.
#pragma once

#include "mbd/base/types.h"

#include <optional>

namespace steplap {

/// Constraints and loads on n velocities. Coordinates are scaled to similar size.
struct Blocks {
  MatX joints;                ///< rows whose velocity is zero: joints, and friction in closed contacts
  MatX gaps;                  ///< rows whose velocity is zero or positive
  VecX weight, turned, loads; ///< A, B, C
};

/// Tilt at which blocks collapse, and the motion of the collapse.
struct Collapse {
  double turned = 0.0; ///< rotation φ of gravity, rad
  VecX motion;         ///< motion of the collapse, normalised
  VecX gap_forces;     ///< contact forces of the last possible balance, at φ; empty if there is none
  VecX joint_forces;   ///< joint forces of that balance, with the least norm
  bool stands = true;  ///< true if the structure is in balance at φ = 0
};

/// Searches in one direction of tilting, `sign` = ±1. If the structure stands at φ = 0, the result is the tilt up to which it stands;
/// otherwise the tilt from which it would stand. Returns nothing if there is no such tilt within a right angle.
[[nodiscard]] std::optional<Collapse> collapse_of(const Blocks& blocks, double sign);

} // namespace steplap
