// Finds pins whose two ends lie far apart in the given poses because 'b' names the ground instead of a marker on it: the pin is then at the
// ground's origin.
#pragma once

#include "mbd/run/finding.h"
#include "mbd/run/loaded_model.h"

namespace steplap {

/// Returns one finding for each such pin, with the position that a marker for 'b' would need.
[[nodiscard]] std::vector<Finding> far_joints(const LoadedModel& loaded);

} // namespace steplap
