// Finds the kinds of events that elements can have. Criteria and actions that wait for other events are refused.
#pragma once

#include "mbd/base/event_kind.h"
#include "mbd/system/system.h"

#include <string>

namespace steplap {

/// Returns every kind of event that an element matching the pattern `element` can have in a run of `model`, including elements that are not
/// active from the start. Precondition: `model` is completed, and `system` is compiled from it.
[[nodiscard]] EventKinds possible_events(const Model& model, const System& system, const std::string& element);

/// Returns why no element that matches the pattern `element` (empty: any) can have an event that matches the pattern `event`; empty if one
/// can. Preconditions as above.
[[nodiscard]] std::string why_no_event(const Model& model, const System& system, const std::string& element, const std::string& event);

} // namespace steplap
