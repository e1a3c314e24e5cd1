// The kind "sensitivity": how much does each variable matter.
#pragma once

#include "study/study_run.h"

namespace steplap::study {

void check_sensitivity(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);
[[nodiscard]] Answer run_sensitivity(StudyRun& run);

/// What a number of a run is known to: by its tolerance; of fixed steps by how events are located, since errors of
/// steps themselves change smoothly with the variables.
[[nodiscard]] double run_error_of(const LoadedStudy& loaded);

} // namespace steplap::study
