// Contacts that have left the parts they belong to: feet beyond the outline of what they stand on, since a unilateral contact's
// line may have no ends where a part does; and contacts that are deeper than a part is thick.
#pragma once

#include "mbd/simulation/simulation.h"
#include "run/finding.h"
#include "run/loaded_model.h"

namespace steplap {

/// One for each contact that is closed at `state` further along its line than the outline of body b reaches;
/// bodies without an outline say nothing.
[[nodiscard]] std::vector<Finding> feet_beyond_edges(const LoadedModel& loaded, const State& state);

/// One for each contact that was deeper in the run than what it presses on is thick (contact_depth.h; of a
/// unilateral_contact, the outline of b behind its line).
[[nodiscard]] std::vector<Finding> contacts_too_deep(const LoadedModel& loaded, const std::vector<ChannelRange>& ranges);

} // namespace steplap
