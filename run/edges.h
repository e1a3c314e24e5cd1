// Finds contacts that have left their part: feet beyond the outline of the body that supports them (the line of a unilateral contact may be
// infinite while the part is not), and penetrations deeper than the part is thick.
#pragma once

#include "mbd/simulation/simulation.h"
#include "run/finding.h"
#include "run/loaded_model.h"

namespace steplap {

/// Returns one finding for each contact that is closed at `state` and lies beyond the end of the outline of body b along its line. Bodies
/// without an outline are not checked.
[[nodiscard]] std::vector<Finding> feet_beyond_edges(const LoadedModel& loaded, const State& state);

/// Returns one finding for each contact whose largest penetration in the run exceeds the thickness of the part behind it (contact_depth.h).
/// For a unilateral_contact this is the thickness of the outline of b behind the contact line.
[[nodiscard]] std::vector<Finding> contacts_too_deep(const LoadedModel& loaded, const std::vector<ChannelRange>& ranges);

} // namespace steplap
