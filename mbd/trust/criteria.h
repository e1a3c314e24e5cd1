// Evaluates the acceptance criteria of a model ([[acceptance]]). Channels are judged by their extremes over the whole run
// (mbd/simulation/extremes.h), whatever the output step.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Judges one criterion by the extremes and events of a run. Precondition: the run located extremes. The outcome is "open" if the required
/// value is missing.
[[nodiscard]] CriterionResult judge_criterion(const Criterion& criterion, const RunResult& result);

} // namespace steplap
