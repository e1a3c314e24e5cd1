// The kinds "sweep" and "sample".
#pragma once

#include "study/study_run.h"

namespace steplap::study {

void check_sweep(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);
[[nodiscard]] Answer run_sweep(StudyRun& run);
void check_sample(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);
[[nodiscard]] Answer run_sample(StudyRun& run);

/// That there is a variable that varies at random, and none of which only a list of values is known.
void check_random(const LoadedStudy& loaded, bool takes_ranges, std::vector<Diagnostic>& problems);

} // namespace steplap::study
