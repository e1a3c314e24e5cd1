// Finds implausible values in a model: loads that are always zero, and positions, speeds, masses or inertias of such different size that
// rounding errors of the large ones are as large as the small ones.
#pragma once

#include "mbd/run/findings.h"

namespace steplap {

/// Returns one finding for each signal that is zero throughout the run and for each record with gaps. Signals cut off by the end:
/// acted_loads.h.
[[nodiscard]] std::vector<Finding> implausible_loads(const LoadedModel& loaded);
/// Returns one finding for each contact element whose coefficient of friction, as the file or an action gives it, is unusually high for dry
/// contacts: a note if the element gives a `source`, otherwise a warning. Above the highest value of any dry contact the warning also
/// prevents the verdict "hold".
[[nodiscard]] std::vector<Finding> implausible_friction(const LoadedModel& loaded);
/// Returns one finding for each group of positions, speeds, masses or inertias of too different size, and for each angle beyond a full
/// turn.
[[nodiscard]] std::vector<Finding> magnitude_warnings(const LoadedModel& loaded);

} // namespace steplap
