// List of all study kinds. New kinds are added in kinds.cpp.
#pragma once

#include "tools/study/study_kind.h"

#include <string>
#include <vector>

namespace steplap::study {

[[nodiscard]] const std::vector<StudyKind>& study_kinds();
[[nodiscard]] std::vector<std::string> kind_names();
/// Returns nullptr if there is no kind of that name.
[[nodiscard]] const StudyKind* find_kind(const std::string& name);
/// Returns the kind of a study. Throws std::logic_error for a kind that the reader would have rejected.
[[nodiscard]] const StudyKind& kind_of(const Study& study);

} // namespace steplap::study
