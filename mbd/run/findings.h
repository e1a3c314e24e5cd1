// Collects all findings on a model before a run and on a run after its end.
#pragma once

#include "mbd/run/finding.h"
#include "mbd/run/loaded_model.h"

#include <vector>

namespace steplap {

struct UnstableBody;
struct Judgement;
struct RunResult;

/// Returns all findings that `steplap check` reports, in its order. Computes the initial state but makes no run.
[[nodiscard]] std::vector<Finding> findings_of(const LoadedModel& loaded);
/// Returns those of findings_of() that affect the meaning of a run's results.
[[nodiscard]] std::vector<Finding> findings_before(const LoadedModel& loaded);
/// Returns findings on a run: feet beyond the edge of a part, excessive penetration, channels without a value, actions that did not happen.
[[nodiscard]] std::vector<Finding> findings_after(const LoadedModel& loaded, const RunResult& result);
/// Returns findings on a completed run: loads that have not acted completely (acted_loads.h) and motions that continue at the end
/// (open_end.h).
[[nodiscard]] std::vector<Finding> findings_at_end(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement);
/// Returns the finding that the machine is in an unstable equilibrium (mbd/trust/balance.h).
[[nodiscard]] Finding balance_finding(const LoadedModel& loaded, const UnstableBody& balance);
/// Returns the finding that stability could not be determined, with the reason.
[[nodiscard]] Finding balance_unknown_finding(const std::string& why);
/// Returns findings on the initial state: contacts and stops that contradict the poses, inertias that contradict outlines.
[[nodiscard]] std::vector<Finding> start_findings(const LoadedModel& loaded);
/// Returns findings on implausible values: cores, loads without effect, quantities of very different size (plausible_scene.h).
[[nodiscard]] std::vector<Finding> implausible_findings(const LoadedModel& loaded);
/// Returns true if a criterion, of the model or built into one of its elements, can judge a run.
[[nodiscard]] bool is_judged(const Model& model);

} // namespace steplap
