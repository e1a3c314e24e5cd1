// Counts degrees of freedom of a compiled system in its reference pose: coordinates, independent
// constraint rows, and what friction takes away while it sticks.
//
// A row counts as dependent where the equations of motion take it for that: if, in the metric of the masses, what is left of
// it beyond the others is below 3e-7 of its length (the root of SchurSolver::k_pivot_tolerance). A mechanism in a singular
// pose has more freedom there than elsewhere: the count is that of the pose. Linear in the size of scenes without many
// loops through each other.
#pragma once

#include "mbd/system/system.h"

#include <string>
#include <vector>

namespace steplap {

/// Of an element, the rows whose multipliers are not unique; what they hold, by RowSpec::quantity.
struct SharedReaction {
  int element = 0;
  std::vector<std::string> quantities; ///< of joints and drives; empty for friction
};

struct Freedom {
  int coordinates = 0;             ///< three for each body that moves
  int rows = 0;                    ///< constraint rows of joints and drives
  int rank = 0;                    ///< independent ones among them
  int rank_sticking = 0;           ///< the same with every friction joint sticking
  std::vector<int> dependent_rows; ///< rows that others imply: which of a set is arbitrary
  /// Reactions that are not unique: of joints and drives alone, and with all friction sticking.
  std::vector<SharedReaction> shared, shared_sticking;

  [[nodiscard]] int degrees() const { return coordinates - rank; }
  [[nodiscard]] int degrees_sticking() const { return coordinates - rank_sticking; }
};

[[nodiscard]] Freedom count_freedom(const System& system);

} // namespace steplap
