// Least-cost choice among discrete options: runs all combinations of the listed values of several design variables. Lists the combinations
// that keep all limits, cheapest first.
#pragma once

#include "tools/study/study_run.h"

namespace steplap::study {

/// Returns true if the study chooses by cost: [design] has a 'cost'.
[[nodiscard]] bool is_choice(const Study& study);

/// Appends errors of a choice by cost to `problems`: a design variable without a list of values, a cost formula without a value, or a
/// target reliability, which is possible for a single design variable only.
void check_choice(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);

/// Runs all combinations. The first note of the answer is a sentence with the cheapest combination that keeps all limits.
[[nodiscard]] Answer cheapest_option(StudyRun& run);

} // namespace steplap::study
