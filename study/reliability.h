// The kind "reliability": how likely is failure.
#pragma once

#include "study/study_run.h"

namespace steplap::study {

void check_reliability(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);
[[nodiscard]] Answer run_reliability(StudyRun& run);

} // namespace steplap::study
