// The verdict on a run.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// By the criteria of elements (ElementKind::judge), in the model's order, and by those that the model states.
/// `failure`: what stopped the run, empty if it reached its end.
[[nodiscard]] Judgement judge(const Model& model, const System& system, const RunResult& result, const std::string& failure);

/// Names of the channels whose extremes tell whether a run can be trusted: who leaves out channels keeps these, or takes a
/// run for trusted that is not.
[[nodiscard]] std::vector<std::string> channels_of_trust(const Model& model);

} // namespace steplap
