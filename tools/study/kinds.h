// All study kinds. A new kind is declared here and listed in kinds.cpp.
#pragma once

#include "tools/study/study_kind.h"

#include <string>
#include <vector>

namespace steplap::study {

// Each is defined in the source of its name.
[[nodiscard]] StudyKind sweep_kind();
[[nodiscard]] StudyKind sample_kind();
[[nodiscard]] StudyKind reliability_kind();
[[nodiscard]] StudyKind sensitivity_kind();
[[nodiscard]] StudyKind critical_kind();
[[nodiscard]] StudyKind design_kind();
[[nodiscard]] StudyKind map_kind();
[[nodiscard]] StudyKind needs_kind();
[[nodiscard]] StudyKind fit_kind();

[[nodiscard]] const std::vector<StudyKind>& study_kinds();
[[nodiscard]] std::vector<std::string> kind_names();
/// Returns nullptr if there is no kind of that name.
[[nodiscard]] const StudyKind* find_kind(const std::string& name);
/// Returns the kind of a study. Throws std::logic_error for a kind that the reader would have rejected.
[[nodiscard]] const StudyKind& kind_of(const Study& study);

} // namespace steplap::study
