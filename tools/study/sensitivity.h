// The kind "sensitivity": how much does each variable matter.
#pragma once

#include "tools/study/study_run.h"

namespace steplap::study {

void check_sensitivity(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);
[[nodiscard]] Answer run_sensitivity(StudyRun& run);

} // namespace steplap::study
