// Which islands of a layout are described by joint coordinates, and how their members hang on one another.
//
// An island is what joints, drives and sticking friction connect. It can become a mechanism (mechanism.h) if pins or
// distance joints leave it fewer coordinates than its bodies have, and it has few: 16 at most, and as many rows; drives
// of a body's own coordinate stay with absolute ones, and so do ropes over more than two bodies, taut or slack. A member
// hangs on what is nearest to the ground, so that paths are short. Where the choice is left to the program an island with a
// member that is free stays absolute, too: there the momentum of all is a sum of coordinates' rates, which methods keep to
// rounding.
#pragma once

#include "mbd/dynamics/layout.h"

namespace steplap {

struct JointCoordinates {
  std::vector<Mechanism> mechanisms; ///< members by the clusters' present numbers; rows not known yet
  std::vector<int> mechanism_of;     ///< per cluster, −1: none
  std::vector<char> is_pin;          ///< per row block: a member hangs by it
};

/// Per cluster: a rope over more than two bodies acts on it, taut or slack; such rows are between absolute coordinates.
[[nodiscard]] std::vector<char> clusters_on_long_rows(const System& system, const Layout& layout);

/// `is_block_merged`, `is_friction_merged`: held inside clusters.
[[nodiscard]] JointCoordinates find_joint_coordinates(const System& system, const State& state, const Layout& layout, Coordinates choice,
                                                      const std::vector<char>& is_block_merged,
                                                      const std::vector<char>& is_friction_merged);

} // namespace steplap
