// Checks [[channel]], [[plot]] and [[acceptance]], which do not affect the motion, against the compiled system. They name channels by
// patterns, so that the channels of the system must be known. The limits of criteria are read here, too, because their unit is that of the
// channel.
#pragma once

#include "mbd/system/system.h"

namespace steplap {

[[nodiscard]] const TableKind& channel_kind();
[[nodiscard]] const TableKind& plot_kind();
[[nodiscard]] const TableKind& acceptance_kind();

/// Table [[acceptance]]: a criterion, and the source of its limit, which only decisions use.
struct AcceptanceTable : Criterion {
  std::string source; ///< "assumed", "specified" or "measured"; "": not stated
};
/// Returns all [[acceptance]] tables of the model, in order.
[[nodiscard]] std::vector<const AcceptanceTable*> acceptance_tables_of(const Model& model);

/// Checks all plots, actions and criteria, and converts the limits of criteria to the units of their channels. Throws ModelError for limits
/// of another dimension, patterns that match nothing, actions that wait for an event which their element cannot have, and plots or criteria
/// that combine different units. Removes plots of channels that are not written from the model, and returns the names of the removed plots.
std::vector<std::string> check_presentation(Model& model, const System& system);
/// Throws ModelError for a pattern in `channels` of [output] that matches no channel. This is for models as they are given; programs ask
/// for channels that a variant of a model may lack.
void check_written_channels(Model& model, const System& system);
/// Checks criteria only, and converts their limits to the units of their channels. Other channels may be missing in the system.
void convert_limits(Model& model, const System& system);

} // namespace steplap
