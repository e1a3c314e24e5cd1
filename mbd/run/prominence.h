// Selects the channels and events of a run that are shown first.
#pragma once

#include "mbd/simulation/simulation.h"

#include <string>

namespace steplap {

/// Returns true for loads on an element (force, couple or required pressure), determined from the unit. Capacities are not loads.
[[nodiscard]] bool is_reaction(const Channel& channel);
/// Returns true for loads on an element, as is_reaction() above, by name and unit of the channel.
[[nodiscard]] bool is_reaction(const std::string& name, const std::string& unit);
/// Returns true for the slid distance of friction.
[[nodiscard]] bool is_slide(const Channel& channel);
/// Returns true for the slid distance of friction, by the name of the channel.
[[nodiscard]] bool is_slide(const std::string& name);
/// Returns true for events that are listed first (event_kind.h).
[[nodiscard]] bool is_main_event(const Event& event);

} // namespace steplap
