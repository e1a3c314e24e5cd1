// The kinds "critical" and "map": where an expression is zero, along one variable or in the plane of two.
#pragma once

#include "study/study_run.h"

namespace steplap::study {

void check_critical(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);
[[nodiscard]] Answer run_critical(StudyRun& run);
void check_map(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);
[[nodiscard]] Answer run_map(StudyRun& run);

} // namespace steplap::study
