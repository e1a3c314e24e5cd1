// What a model says about looking at its runs: [[channel]], [[plot]] and [[acceptance]].
//
// Neither changes the motion. Both name channels by patterns, which can only be compared with the
// channels that a compiled system has: check_presentation() does that. Limits are read there too: what a
// number with a unit means is decided by the channel.
#pragma once

#include "mbd/system/system.h"

namespace steplap {

[[nodiscard]] const TableKind& channel_kind();
[[nodiscard]] const TableKind& plot_kind();
[[nodiscard]] const TableKind& acceptance_kind();

/// Reads the limits of the model's criteria in the unit of the channels that they are for. Throws ModelError for
/// limits of another dimension, for patterns that no channel, event or element matches, for actions that wait for an event which their
/// element cannot have, and for a plot or a criterion whose channels are of different units. Plots of channels that are not written are taken out of the model;
/// returns their names.
std::vector<std::string> check_presentation(Model& model, const System& system);

} // namespace steplap
