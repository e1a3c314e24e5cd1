// A pull that grows in one direction until the machine leaves its rest: what gives way, and at which acceleration.
//
// The pull grows by steps, each a tenth to a third of what it is. What a watch has left (static_machine.h) at both ends of a step tells whether it
// reached its limit within; there it is closed in on. Below the first limit of a machine whose springs and contacts are linear its
// rest moves in a straight line with the pull: contacts press with forces linear in it, and of friction what is in use, the gauge of a wrench
// linear in it over a convex set, is convex. A watch that has something left at both ends of a step then has in between, so
// that the first limit is not missed. Beyond it the machine is another one (a foot is up, a floor slides), and a limit that is reached and left
// within one step could be: these are given as what a growing pull was seen to reach.
#pragma once

#include "tools/assess/static_machine.h"

namespace steplap::assess {

/// Where something gives way.
struct StaticLimit {
  LimitKind kind = LimitKind::ends;
  std::string element;       ///< "" of an end
  std::string text;          ///< "'front joint' slips"; of an end what the search says
  double acceleration = 0.0; ///< m/s²
  double error = 0.0;        ///< half the interval in which it lies, m/s²
};

/// What a growing pull does.
struct StaticRay {
  std::vector<StaticLimit> limits; ///< by acceleration
  bool is_explained = true;        ///< false: it ends, but nothing gave way before, or the search does not know why
  double largest = 0.0;            ///< how far the pull grew, m/s²
};

/// `direction` of length 1; `most`: m/s², where nothing has to be known any more.
[[nodiscard]] StaticRay grow_pull(StaticMachine& machine, const Vec2& direction, double most);

} // namespace steplap::assess
