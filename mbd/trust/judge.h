// Judges a run: computes its verdict from all criteria.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Applies the criteria of elements (ElementKind::judge), in the model's order, and those of the model. `failure`: reason why the run
/// stopped early, empty if it reached its end.
[[nodiscard]] Judgement judge(const Model& model, const System& system, const RunResult& result, const std::string& failure);

/// Returns the channels whose extremes decide whether a run can be trusted. Callers that omit channels must keep these. Otherwise runs that
/// cannot be trusted pass as trusted.
[[nodiscard]] std::vector<std::string> channels_of_trust(const Model& model);

} // namespace steplap
