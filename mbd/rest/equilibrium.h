// Static equilibrium: the pose in which nothing accelerates, contacts, friction and preload included.
//
// The machine gives way downhill along its constraints (descent.h) until its forces balance: what hangs swings down,
// what lies settles, what drives hold is held. Friction that gets its load holds its rows where they are then; where it
// would have to hold more than it can, it slides at its bound until it holds. Among several rests this is the nearest
// downhill. A pose that balances but would run away at a nudge is left.
//
// That finds none where a body would go on without end, where friction between touching bodies gives way (a ladder that
// slides down may come to rest somewhere, but it does not stand), or where a joint's friction is overloaded. Before it is said
// that there is none, a machine with contacts or friction is let go and damped (settling.h): what it comes to is searched anew
// from there. Where friction holds such a rest is one of many, and which one hangs on the way.
#pragma once

#include "mbd/rest/descent.h"

#include <string>
#include <vector>

namespace steplap {

/// How far a friction element that holds is from slipping.
struct FrictionMargin {
  int friction = 0;       ///< index in System::frictions
  double used = 0.0;      ///< share of what it could bear: the wrench over the largest one of its direction
  bool is_shared = false; ///< the least share with which it and others can bear the load that they have in common
};

/// A pose of rest and how it was found.
struct Equilibrium {
  State state;                         ///< at rest; modes and friction phases belong to it
  double residual = 0.0;               ///< largest acceleration left, m/s² or rad/s²
  double moved = 0.0;                  ///< largest displacement from the start, m
  int iterations = 0;                  ///< of the search
  bool is_settled = false;             ///< found by letting the damped machine settle in time from the start
  int settling_steps = 0;              ///< that this took
  bool hangs_on_way = false;           ///< settled, and friction holds it: one rest of many
  std::vector<FrictionMargin> margins; ///< of those that hold
  std::vector<MotionPart> indifferent; ///< directions along which nothing holds it, by their largest parts
  int more_indifferent = 0;            ///< and how many more, where they are too many to be named
  std::vector<MotionPart> left;        ///< poses that balanced on the way, but that a nudge would leave
  std::vector<int> slid;               ///< friction elements that slid to where they hold
  int turned_body = 0;                 ///< of those that no joint leads the one that turned furthest, if so far that it
  double turned = 0.0;                 ///< did not settle but tip over; rad
  std::vector<int> moving_drives;      ///< elements whose drives move or accelerate now; taken as held
};

/// From `start`'s pose. Throws NumericalFailure if there is no equilibrium, saying what would move where and why.
/// `algebra`: for tests that hold one against the other.
[[nodiscard]] Equilibrium find_equilibrium(const System& system, const State& start, RestAlgebra algebra = RestAlgebra::by_size);

/// "'bob' along -x", "'bob' turning clockwise".
[[nodiscard]] std::string part_text(const System& system, const MotionPart& part);
/// What is to be known beside the pose, a sentence each: rests that were left, what is indifferent, what slid, drives
/// that move.
[[nodiscard]] std::vector<std::string> remarks_on(const System& system, const Equilibrium& found);

} // namespace steplap
