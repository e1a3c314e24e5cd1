// What is found in a model before it runs and in a run when it has ended: for the screen, for results, for whoever shows it
// beside a verdict.
#pragma once

#include "run/finding.h"
#include "run/loaded_model.h"

#include <vector>

namespace steplap {

struct Balance;
struct Judgement;
struct RunResult;

/// All that `steplap check` finds, in its order. Runs nothing but the start.
[[nodiscard]] std::vector<Finding> findings_of(const LoadedModel& loaded);
/// Of these what bears on what a run can say.
[[nodiscard]] std::vector<Finding> findings_before(const LoadedModel& loaded);
/// What a run came to: feet beyond the parts they stood on, contacts through each other, channels without a value, actions that wait.
[[nodiscard]] std::vector<Finding> findings_after(const LoadedModel& loaded, const RunResult& result);
/// Findings on a run that was not broken off: loads that have not acted (acted_loads.h), and what is still going on (open_end.h).
[[nodiscard]] std::vector<Finding> findings_at_end(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement);
/// A machine that stays where it is only because nothing disturbs it (mbd/trust/balance.h).
[[nodiscard]] Finding balance_finding(const LoadedModel& loaded, const Balance& balance);
/// That it was not found out whether it does, and why.
[[nodiscard]] Finding balance_unknown_finding(const std::string& why);
/// Those about where the run begins: contacts and stops that contradict the poses, inertias that contradict outlines.
[[nodiscard]] std::vector<Finding> start_findings(const LoadedModel& loaded);
/// Those about values unlike any: cores, loads that do nothing, sizes apart (plausible_scene.h).
[[nodiscard]] std::vector<Finding> implausible_findings(const LoadedModel& loaded);

} // namespace steplap
