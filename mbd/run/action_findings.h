// Finds [[action]] tables without effect: elements that never act, actions that are never armed or come too late, and actions that were not
// executed.
#pragma once

#include "mbd/run/finding.h"
#include "mbd/run/loaded_model.h"

#include "mbd/simulation/simulation.h"

#include <vector>

namespace steplap {

/// Returns the findings that follow from the model alone, before a run.
[[nodiscard]] std::vector<Finding> idle_actions(const LoadedModel& loaded);
/// Returns, after a run, one finding for each action that was not executed.
[[nodiscard]] std::vector<Finding> actions_that_wait(const LoadedModel& loaded, const RunResult& result);

} // namespace steplap
