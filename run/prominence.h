// What of a run a reader looks for first.
#pragma once

#include "mbd/simulation/simulation.h"

namespace steplap {

/// What an element has to bear, told by its unit: a force, a couple, the pressure that a joint would
/// need. What it could bear is none.
[[nodiscard]] bool is_reaction(const Channel& channel);
/// A path slid in friction.
[[nodiscard]] bool is_slide(const Channel& channel);
/// Of a kind that a reader looks for first (event_kind.h).
[[nodiscard]] bool is_main_event(const Event& event);

} // namespace steplap
