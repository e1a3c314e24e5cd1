// Study kind "sweep": evaluates given values one after the other.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

/// Settings of a "sweep" study.
struct SweepSettings : KindSettings {
  std::string design = "grid"; ///< choice of points: grid, list, one_at_a_time
  long points = 11;            ///< number of points over a range, or over the 5 % to 95 % quantiles of a distribution
};

[[nodiscard]] StudyKind sweep_kind();

} // namespace steplap::study
