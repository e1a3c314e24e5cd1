// Limits of the load cases of a study's models as limit states and as responses.
#pragma once

#include "tools/study/study_reader.h"

namespace steplap::study {

/// Replaces each model by one model for each of its load cases ([[case]]), or leaves it if it has none, and adds for each a response with
/// what is left of its limits and a limit state of the same value. Throws ModelError with the location of a case that is wrong, or that sets
/// the path of a variable itself, and for a model without criteria.
void add_limits_of_cases(LoadedStudy& loaded);

/// `what` of a response that is the least of what is left of the limits in all load cases of its model.
inline constexpr const char* k_reserve_of_cases = "reserve_of_cases";
/// Replaces each of these responses by one for each load case, of a model of this case, and by the least of them. Leaves out models that no
/// other response or history needs. Throws ModelError as add_limits_of_cases(), and for a model without load cases.
void add_reserves_of_cases(LoadedStudy& loaded);

/// Returns the model of which limit state `limit` is the reserve; nullptr for a limit state of the study file.
[[nodiscard]] const StudyModel* model_of_limit(const LoadedStudy& loaded, std::size_t limit);

/// Runs the model with `values` of all variables and returns the reason of its verdict, one sentence.
[[nodiscard]] std::string reason_of_verdict(const LoadedStudy& loaded, const StudyModel& model, const double* values);

} // namespace steplap::study
