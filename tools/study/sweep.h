// The kind "sweep": values tried one after the other.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

struct SweepSettings : KindSettings {
  std::string design = "grid"; ///< grid, list, one_at_a_time
  long points = 11;            ///< of a range or a distribution's 5 % to 95 %
};

[[nodiscard]] StudyKind sweep_kind();

} // namespace steplap::study
