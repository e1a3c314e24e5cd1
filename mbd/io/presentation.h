// Checks of [[channel]], [[plot]] and [[acceptance]] against the compiled system. These do not affect the motion. They name channels by
// patterns, which can only be compared with the channels of a compiled system. Limits are read here too, because their unit is that of the
// channel.
#pragma once

#include "mbd/system/system.h"

namespace steplap {

[[nodiscard]] const TableKind& channel_kind();
[[nodiscard]] const TableKind& plot_kind();
[[nodiscard]] const TableKind& acceptance_kind();

/// Reads the limits of the model's criteria in the units of their channels. Throws ModelError for limits of another dimension, patterns
/// without any match, actions that wait for an event which their element cannot have, and plots or criteria that combine different units.
/// Removes plots of channels that are not written from the model, and returns their names.
std::vector<std::string> check_presentation(Model& model, const System& system);

} // namespace steplap
