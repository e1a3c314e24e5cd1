// Study kind "fit": identifies parameters from measured histories by least squares, and finds out which parameters the records determine.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

/// Settings of a "fit" study.
struct FitSettings : KindSettings {
  long starts = 8;       ///< number of candidate start points; the search starts from the best of them
  long iterations = 100; ///< limit for one search
  double confidence = 0.95;
};

[[nodiscard]] StudyKind fit_kind();

} // namespace steplap::study
