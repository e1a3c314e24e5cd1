// Selects the islands that are described by joint coordinates, and the parent of each of their members.
//
// An island is a set of clusters connected by joints, drives and sticking friction. It becomes a mechanism (mechanism.h) if pins or
// distance joints leave it fewer coordinates than its bodies have, with at most 16 coordinates and at most 16 rows. Drives of a body's own
// coordinate, and ropes over more than two bodies, require absolute coordinates. Parents are chosen such that the path to the ground is
// short. With automatic choice an island with a free member stays absolute, too: the total momentum is then a linear function of the
// coordinate rates, which integration methods conserve up to rounding.
#pragma once

#include "mbd/dynamics/layout.h"

namespace steplap {

/// Result of the selection of joint coordinates.
struct JointCoordinates {
  std::vector<Mechanism> mechanisms; ///< members refer to the present numbers of clusters; rows are not yet assigned
  std::vector<int> mechanism_of;     ///< per cluster; −1: none
  std::vector<char> is_pin;          ///< for each row block: it is the pin of a member, and needs no rows
};

/// Returns for each cluster whether a rope over more than two bodies acts on it, taut or slack. The rows of such ropes require absolute
/// coordinates.
[[nodiscard]] std::vector<char> clusters_on_long_rows(const System& system, const Layout& layout);

/// Selects the islands and parents. `is_block_merged` and `is_friction_merged` mark the joints inside clusters, which are not part of
/// mechanisms.
[[nodiscard]] JointCoordinates find_joint_coordinates(const System& system, const State& state, const Layout& layout, Coordinates choice,
                                                      const std::vector<char>& is_block_merged,
                                                      const std::vector<char>& is_friction_merged);

} // namespace steplap
