// Least-cost choice among discrete options: all combinations of the values of several design variables are run, and those that hold are listed
// from the cheapest.
#pragma once

#include "tools/study/study_run.h"

namespace steplap::study {

/// Returns true if the study chooses by cost: [design] has a 'cost'.
[[nodiscard]] bool is_choice(const Study& study);

/// Appends errors of a choice to `problems`: variables without list of values, a cost without value, targets that go with one variable only.
void check_choice(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);

/// Runs all options. The answer begins with the cheapest that holds, as a sentence.
[[nodiscard]] Answer cheapest_option(StudyRun& run);

} // namespace steplap::study
