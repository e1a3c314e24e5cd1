// The kinds of study: the one list that a new one is added to.
#pragma once

#include "study/study_run.h"

#include <functional>
#include <string>
#include <vector>

namespace steplap::study {

struct StudyKind {
  std::string name;
  std::string doc;
  /// Appends what is wrong with the study for this kind; nothing has run.
  std::function<void(const LoadedStudy& study, std::vector<Diagnostic>& problems)> check;
  std::function<Answer(StudyRun& run)> run;
};

[[nodiscard]] const std::vector<StudyKind>& study_kinds();
[[nodiscard]] std::vector<std::string> kind_names();

} // namespace steplap::study
