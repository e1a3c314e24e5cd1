// Which events elements can have: what criteria and actions that name one are held to.
#pragma once

#include "mbd/base/event_kind.h"
#include "mbd/system/system.h"

#include <string>

namespace steplap {

/// Every kind of event that an element which matches the pattern `element` can have in a run of `model`, completed, of which `system`
/// is compiled: those of elements that do not act from the start, too.
[[nodiscard]] EventKinds possible_events(const Model& model, const System& system, const std::string& element);

} // namespace steplap
