// The criteria that a model states: [[acceptance]].
//
// Channels are judged by their extremes over the whole run (mbd/simulation/extremes.h), whatever is written of them.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Judges one criterion of the model by the extremes and events of a run that looked for extremes. Without the value asked for
/// the outcome is "open".
[[nodiscard]] CriterionResult judge_criterion(const Criterion& criterion, const RunResult& result);

} // namespace steplap
