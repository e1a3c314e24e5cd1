// Checks of [[channel]], [[plot]] and [[acceptance]] against the compiled system. These do not affect the motion. They name channels by
// patterns, which can only be compared with the channels of a compiled system. Limits are read here too, because their unit is that of the
// channel.
#pragma once

#include "mbd/system/system.h"

namespace steplap {

[[nodiscard]] const TableKind& channel_kind();
[[nodiscard]] const TableKind& plot_kind();
[[nodiscard]] const TableKind& acceptance_kind();

/// Table [[acceptance]] as given: its criterion, and how the limit is known. Only decisions use the source.
struct AcceptanceTable : Criterion {
  std::string source; ///< "assumed", "specified" or "measured"; "": not stated
};
/// Returns all [[acceptance]] tables of the model, in order.
[[nodiscard]] std::vector<const AcceptanceTable*> acceptance_tables_of(const Model& model);

/// Reads the limits of the model's criteria in the units of their channels. Throws ModelError for limits of another dimension, patterns
/// without any match, actions that wait for an event which their element cannot have, and plots or criteria that combine different units.
/// Removes plots of channels that are not written from the model, and returns their names.
std::vector<std::string> check_presentation(Model& model, const System& system);
/// As check_presentation(), for the criteria alone: sets their limits in the units of their channels. The system needs only these channels.
void convert_limits(Model& model, const System& system);

} // namespace steplap
