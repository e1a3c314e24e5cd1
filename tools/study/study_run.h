// Data of a running study, passed to its study kind.
#pragma once

#include "tools/study/evaluator.h"
#include "tools/study/finding.h"
#include "tools/study/law.h"
#include "tools/study/study_reader.h"

namespace steplap::study {

/// Objects of a running study.
struct StudyRun {
  const LoadedStudy& loaded;
  const JointLaw& law;
  Evaluator& evaluator;

  [[nodiscard]] const Study& study() const { return loaded.study; }
};

} // namespace steplap::study
