// Finds common end points of two segments over which a circle rolls from one segment to the next: at this point both segments press.
#pragma once

#include "mbd/run/finding.h"
#include "mbd/run/loaded_model.h"

namespace steplap {

/// Returns, for each pair of a circle and a body with segments, at most one finding: on the first common end point.
[[nodiscard]] std::vector<Finding> doubled_corners(const LoadedModel& loaded);

} // namespace steplap
