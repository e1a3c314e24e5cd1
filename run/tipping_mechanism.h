// Bodies that stand on each other in more ways than one (a beam on two columns): by which tilt their forces cannot
// balance any more, and the motion in which they then come down.
//
// Limit analysis of what bears no tension (J. Heyman, The Stone Skeleton, 1995; R. K. Livesley, Int. J. Numer. Meth.
// Engng 12 (1978) 1853), with friction that holds: there is balance as long as no motion that the contacts let (gaps
// open or stay, nothing slides, joints hold) gains power from the loads P(φ) = A cos φ + B sin φ + C, A the weights, B
// the same a right angle on.
#pragma once

#include "mbd/base/types.h"

#include <optional>

namespace steplap {

/// Of n velocities, forces on them and what they do to joints and gaps. Coordinates are scaled so that they are alike
/// in size.
struct Blocks {
  MatX joints;                ///< rows that stay zero: of joints, and of friction in what touches
  MatX gaps;                  ///< rows that stay zero or grow
  VecX weight, turned, loads; ///< A, B, C
};

/// Where blocks come down, and how.
struct Collapse {
  double turned = 0.0; ///< φ of gravity, rad
  VecX motion;         ///< in which they come down, of length 1
  VecX gap_forces;     ///< at φ, of a balance that is still possible there; empty if there is none
  VecX joint_forces;   ///< the same, the shortest of them
  bool stands = true;  ///< with φ = 0
};

/// In one direction of tilting, `sign` = ±1: up to where what stands goes on standing, or from where on what does not
/// would. Nothing within a right angle.
[[nodiscard]] std::optional<Collapse> collapse_of(const Blocks& blocks, double sign);

} // namespace steplap
