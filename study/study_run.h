// What a kind of study works with.
#pragma once

#include "study/evaluator.h"
#include "study/finding.h"
#include "study/law.h"
#include "study/study_reader.h"

namespace steplap::study {

struct StudyRun {
  const LoadedStudy& loaded;
  const JointLaw& law;
  Evaluator& evaluator;

  [[nodiscard]] const Study& study() const { return loaded.study; }
};

} // namespace steplap::study
