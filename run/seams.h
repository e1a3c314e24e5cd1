// Segments that a circle passes from one to the next, where both end at one point: there both press.
#pragma once

#include "run/finding.h"
#include "run/loaded_model.h"

namespace steplap {

/// One for each circle and body with segments, naming the first such corner.
[[nodiscard]] std::vector<Finding> doubled_corners(const LoadedModel& loaded);

} // namespace steplap
