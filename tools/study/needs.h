// Study kind "needs": finds which parts of a scene matter. Each element is removed or made rigid and each body is fixed, one at a time, and
// the change of the responses is measured.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

/// Settings of a "needs" study.
struct NeedsSettings : KindSettings {
  double accuracy = 0.01; ///< relative changes of responses up to this value do not matter
};

[[nodiscard]] StudyKind needs_kind();

} // namespace steplap::study
