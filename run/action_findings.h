// What of [[action]] can have no effect: elements that never act, actions that are never armed or come too late, and those that have not
// happened.
#pragma once

#include "run/finding.h"
#include "run/loaded_model.h"

#include "mbd/simulation/simulation.h"

#include <vector>

namespace steplap {

/// Before the run: of the model alone.
[[nodiscard]] std::vector<Finding> idle_actions(const LoadedModel& loaded);
/// After it: which actions have not happened.
[[nodiscard]] std::vector<Finding> actions_that_wait(const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
