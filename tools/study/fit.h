// The kind "fit": parameters from measured histories by least squares, with what the records tell of them and what not.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

struct FitSettings : KindSettings {
  long starts = 8;       ///< places where the search may begin; it does from the best of them
  long iterations = 100; ///< of one search
  double confidence = 0.95;
};

[[nodiscard]] StudyKind fit_kind();

} // namespace steplap::study
