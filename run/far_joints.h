// Pins whose ends are far apart in the poses given, since 'b' names the ground and no place on it: that is the ground's origin.
#pragma once

#include "run/finding.h"
#include "run/loaded_model.h"

namespace steplap {

/// One for each, with the place that 'b' would have to have.
[[nodiscard]] std::vector<Finding> far_joints(const LoadedModel& loaded);

} // namespace steplap
