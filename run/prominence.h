// What of a run a reader looks for first.
#pragma once

#include "mbd/simulation/simulation.h"

#include <string>

namespace steplap {

/// What an element has to bear, told by its unit: a force, a couple, the pressure that a joint would
/// need. What it could bear is none.
[[nodiscard]] bool is_reaction(const Channel& channel);
/// The same of a channel by its name and unit.
[[nodiscard]] bool is_reaction(const std::string& name, const std::string& unit);
/// A path slid in friction.
[[nodiscard]] bool is_slide(const Channel& channel);
/// The same of a channel by its name.
[[nodiscard]] bool is_slide(const std::string& name);
/// Of a kind that a reader looks for first (event_kind.h).
[[nodiscard]] bool is_main_event(const Event& event);

} // namespace steplap
