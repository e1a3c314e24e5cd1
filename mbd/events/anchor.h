// Stores the position at which a friction element begins to stick. Its rows keep the values of that pose as targets.
#pragma once

#include "mbd/system/system.h"

namespace steplap {

/// Anchors the rows of friction element f at the pose of `motion`; each row has its own base.
inline void anchor_friction(const System& system, State& state, int f, const Motion<double>* motion) {
  const FrictionElement& friction = *system.frictions[f].friction;
  if (system.frictions[f].rope) return; // the target length of a rope is constant, whatever the pose
  const RowSpec* const rows = friction.rows(state.friction[f]);
  for (int r = 0; r < friction.dimension(); ++r)
    if (rows[r].base >= 0) state.bases[rows[r].base].value = evaluate_row<false>(rows[r], motion).value;
}

} // namespace steplap
