// Description of a study: units, meaning of each variable and number, settings. It is kept in the store, so that a page can be made from
// the store alone.
#pragma once

#include "tools/study/law.h"
#include "tools/study/study_reader.h"

#include <string>

namespace steplap::study {

/// Returns the description as JSON. It depends on the study file only.
[[nodiscard]] std::string about_of(const LoadedStudy& loaded, const JointLaw& law);

/// Returns CSV made from it: a row for each variable, response and limit state, with its unit in the samples, "" if it has none, and its
/// distribution or formula.
[[nodiscard]] std::string variables_csv(const std::string& about);

} // namespace steplap::study
