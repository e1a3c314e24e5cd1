// The kinds of study: the one list that a new one is added to.
#pragma once

#include "tools/study/study_kind.h"

#include <string>
#include <vector>

namespace steplap::study {

[[nodiscard]] const std::vector<StudyKind>& study_kinds();
[[nodiscard]] std::vector<std::string> kind_names();
/// Null if there is none of that name.
[[nodiscard]] const StudyKind* find_kind(const std::string& name);
/// Throws std::logic_error for a study that the reader would not have let pass.
[[nodiscard]] const StudyKind& kind_of(const Study& study);

} // namespace steplap::study
