// Which clusters of a layout become carriages (carriage.h).
//
// A cluster that one guide and nothing else holds: no other joint, no drive, no friction that sticks (forces, contacts and
// friction that slides may act on it), on the ground or on a cluster in absolute coordinates that is no carriage
// itself; neither of them on a rope over more than two bodies.
#pragma once

#include "mbd/dynamics/carriage.h"
#include "mbd/dynamics/mechanism_layout.h"

namespace steplap {

/// By the clusters' present numbers, in their final order; null if there are none. Takes their clusters and guides out
/// of what `found` leaves absolute: carriages have the number behind the last mechanism's.
[[nodiscard]] std::unique_ptr<Carriages> find_carriages(const System& system, const State& state, const Layout& layout,
                                                        const std::vector<char>& is_block_merged,
                                                        const std::vector<char>& is_friction_merged,
                                                        JointCoordinates& found);

} // namespace steplap
