// Description of a study: units, meaning of each variable and number, settings. It is kept in the store, so that a page can be made from
// the store alone.
#pragma once

#include "tools/study/law.h"
#include "tools/study/study_reader.h"

#include <string>

namespace steplap::study {

/// Returns the description as JSON. It depends on the study file only.
[[nodiscard]] std::string about_of(const LoadedStudy& loaded, const JointLaw& law);

} // namespace steplap::study
