// Limits of the load cases of a study's models as limit states.
#pragma once

#include "tools/study/study_reader.h"

namespace steplap::study {

/// Replaces each model by one model for each of its load cases ([[case]]), or leaves it if it has none, and adds for each a response with
/// what is left of its limits and a limit state of the same value. Throws ModelError with the location of a case that is wrong, or that sets
/// the path of a variable itself, and for a model without criteria.
void add_limits_of_cases(LoadedStudy& loaded);

/// Returns the model of which limit state `limit` is the reserve; nullptr for a limit state of the study file.
[[nodiscard]] const StudyModel* model_of_limit(const LoadedStudy& loaded, std::size_t limit);

/// Runs the model with `values` of all variables and returns the reason of its verdict, one sentence.
[[nodiscard]] std::string reason_of_verdict(const LoadedStudy& loaded, const StudyModel& model, const double* values);

} // namespace steplap::study
