// Scenes in which one load of some kind is cut off before, inside or behind its effect, by the end of the run or by an action.
//
// A mass of 100 kg on a rail is held by friction of 300 N. No load of a scene reaches that, so that the mass never moves: whether a run may
// be called "hold" depends on its load alone. Loads that are no forces move a second body, on which nothing is asked.
#pragma once

#include <string>
#include <vector>

namespace steplap::testing {

/// One kind of load.
struct LoadKind {
  std::string name;
  std::string signals;     ///< tables that define the signal "p", and what drives a body by it if it is no force
  bool is_force = true;    ///< "p" is a force on the mass; else it drives the second body by element "l"
  double begins = 0.0;     ///< s
  double acted = 0.0;      ///< s, from when on it has acted: its end, ten periods at full size, its level
  bool is_endless = false; ///< it goes on behind `acted`
};

/// Every kind of signal, alone and made of others.
[[nodiscard]] std::vector<LoadKind> load_kinds();

/// One scene and what its verdict has to be.
struct LoadCase {
  std::string name, text;
  bool is_hold = false; ///< else it is open
};

/// All kinds, cut off in all ways at times before, inside and behind their effect.
[[nodiscard]] std::vector<LoadCase> load_cases();

} // namespace steplap::testing
