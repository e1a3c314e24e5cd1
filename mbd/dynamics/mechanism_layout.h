// Selection of the islands described by joint coordinates, and of the parent of each of their members.
//
// An island is a set of clusters connected by joints, drives and sticking friction. It becomes a mechanism (mechanism.h) if pins or
// distance joints leave it fewer coordinates than its bodies have, at most 16, and at most 16 rows. Drives of a body's own coordinate and
// ropes over more than two bodies require absolute coordinates. Parents are chosen so that the path to the ground is short. With automatic
// choice an island with a free member also stays absolute: there the total momentum is a linear function of the coordinate rates, which
// integration methods conserve up to rounding.
#pragma once

#include "mbd/dynamics/layout.h"

namespace steplap {

/// Result of the selection.
struct JointCoordinates {
  std::vector<Mechanism> mechanisms; ///< members refer to present cluster numbers; rows are not yet assigned
  std::vector<int> mechanism_of;     ///< per cluster; −1: none
  std::vector<char> is_pin;          ///< per row block: pin of a member, needs no rows
};

/// Returns, per cluster, whether a rope over more than two bodies acts on it, taut or slack. Rows of such ropes need absolute coordinates.
[[nodiscard]] std::vector<char> clusters_on_long_rows(const System& system, const Layout& layout);

/// `is_block_merged` and `is_friction_merged` mark the joints inside clusters, which are not part of mechanisms.
[[nodiscard]] JointCoordinates find_joint_coordinates(const System& system, const State& state, const Layout& layout, Coordinates choice,
                                                      const std::vector<char>& is_block_merged,
                                                      const std::vector<char>& is_friction_merged);

} // namespace steplap
