// What a store keeps of its study besides names, so that a page can be made of the store alone: units, what each
// variable and number is, what was asked.
#pragma once

#include "tools/study/law.h"
#include "tools/study/study_reader.h"

#include <string>

namespace steplap::study {

/// JSON, the same for the same study file, whatever runs it.
[[nodiscard]] std::string about_of(const LoadedStudy& loaded, const JointLaw& law);

} // namespace steplap::study
