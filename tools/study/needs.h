// The kind "needs": what a scene needs. Every element in turn is taken out, or holds rigidly what it connects; every
// body in turn is fixed. What changes in the responses by how much?
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

struct NeedsSettings : KindSettings {
  double accuracy = 0.01; ///< changes of responses up to this share of them do not matter
};

[[nodiscard]] StudyKind needs_kind();

} // namespace steplap::study
