// Static equilibrium: the pose in which nothing accelerates, contacts and preload included.
//
// Friction that is loaded holds its rows where they are (the machine settles without sliding); whether
// it can is reported. Newton on the constrained accelerations a(q) = 0 from finite differences of them,
// least-norm where the pose is not unique; where Newton gets nowhere (a body that must first fall onto
// its contacts), motion with kinetic damping brings it near: velocities are dropped whenever the kinetic
// energy has passed a peak. A pose that balances but would run away at a nudge is not taken.
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <string>
#include <vector>

namespace steplap {

/// How far a friction element that holds is from slipping.
struct FrictionMargin {
  int friction = 0;   ///< index in System::frictions
  double used = 0.0;  ///< share of what it could bear: the wrench over the largest one of its direction
};

struct Equilibrium {
  State state;                  ///< at rest; modes and friction phases belong to it
  double residual = 0.0;        ///< largest acceleration left, m/s² or rad/s² · 1 m
  double moved = 0.0;           ///< largest displacement from the start, m
  int iterations = 0;
  std::vector<FrictionMargin> margins; ///< of those that hold; where several share a load, its least-norm share
  std::vector<std::string> slipping; ///< friction elements that cannot hold what they would have to
};

/// From `start`'s pose. Throws NumericalFailure if no equilibrium is found, naming the body that moves.
[[nodiscard]] Equilibrium find_equilibrium(const System& system, const State& start);

} // namespace steplap
