// Counts the degrees of freedom of a compiled system in its reference pose: coordinates, independent constraint rows, and those that
// friction removes while it sticks.
//
// A row counts as dependent by the rule of the equations of motion: in the mass metric, its part independent of other rows is below 3e-7 of
// its length (the square root of SchurSolver::k_pivot_tolerance). In a singular pose a mechanism has more freedom than elsewhere, and the
// count is that of the pose. The cost is linear in the size of models without many interlinked loops.
#pragma once

#include "mbd/system/system.h"

#include <string>
#include <vector>

namespace steplap {

/// An element with rows whose multipliers are not unique, and the quantities that these rows constrain (RowSpec::quantity).
struct SharedReaction {
  int element = 0;
  std::vector<std::string> quantities; ///< for joints and drives; empty for friction
};

struct DegreesOfFreedom {
  int coordinates = 0;             ///< three for each movable body
  int rows = 0;                    ///< constraint rows of joints and drives
  int rank = 0;                    ///< number of independent rows
  int rank_sticking = 0;           ///< number of independent rows with all friction sticking
  std::vector<int> dependent_rows; ///< rows that follow from others; which row of a dependent set is listed is arbitrary
  /// Reactions that are not unique, for joints and drives alone, and with all friction sticking.
  std::vector<SharedReaction> shared, shared_sticking;

  [[nodiscard]] int degrees() const { return coordinates - rank; }
  [[nodiscard]] int degrees_sticking() const { return coordinates - rank_sticking; }
};

[[nodiscard]] DegreesOfFreedom count_freedom(const System& system);

} // namespace steplap
