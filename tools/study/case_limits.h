// Limits of the load cases of a study's models as limit states and as responses.
#pragma once

#include "tools/study/study_reader.h"

namespace steplap::study {

/// Replaces each model that has load cases ([[case]]) by one model per case. Adds to each resulting model a response, the least reserve of
/// its limits (1 − utilisation), and a limit state of the same value. Throws ModelError with its location for an invalid case, for a case
/// that sets the path of a variable, and for a model without criteria.
void add_limits_of_cases(LoadedStudy& loaded);

/// Value of the field `what` for a response that is the least reserve over all load cases of a model.
inline constexpr const char* k_reserve_of_cases = "reserve_of_cases";
/// Replaces each response of the kind `k_reserve_of_cases` by one response per load case, each from a model of that case, and by their
/// minimum. Removes models that no other response or history uses. Throws ModelError as add_limits_of_cases(), and for a model without load
/// cases.
void add_reserves_of_cases(LoadedStudy& loaded);

/// Returns the model whose reserve is limit state `limit`; nullptr if the study file defines this limit state.
[[nodiscard]] const StudyModel* model_of_limit(const LoadedStudy& loaded, std::size_t limit);

/// Runs the model with `values` of all variables and returns one sentence with the reason of its verdict.
[[nodiscard]] std::string reason_of_verdict(const LoadedStudy& loaded, const StudyModel& model, const double* values);

} // namespace steplap::study
