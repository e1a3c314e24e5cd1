// Selects the channels and events of a run that are shown first.
#pragma once

#include "mbd/simulation/simulation.h"

#include <string>

namespace steplap {

/// Returns true for loads on an element (force, couple or required pressure), determined from the unit. Capacities are not loads.
[[nodiscard]] bool is_reaction(const Channel& channel);
/// Does the same as is_reaction(const Channel&) for a channel given by its name and unit.
[[nodiscard]] bool is_reaction(const std::string& name, const std::string& unit);
/// Returns true for the slid distance of friction.
[[nodiscard]] bool is_slide(const Channel& channel);
/// Does the same as is_slide(const Channel&) for a channel given by its name.
[[nodiscard]] bool is_slide(const std::string& name);
/// Returns true for events that are listed first (event_kind.h).
[[nodiscard]] bool is_main_event(const Event& event);

} // namespace steplap
