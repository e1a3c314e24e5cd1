// The kind "fit": parameters from measured histories by least squares, with what the records tell of them and what not.
#pragma once

#include "study/study_run.h"

namespace steplap::study {

void check_fit(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);
[[nodiscard]] Answer run_fit(StudyRun& run);

} // namespace steplap::study
