// Finds implausible values in a model: loads that are always zero, and positions, speeds, masses or inertias of such different size that
// rounding errors of the large ones are as large as the small ones.
#pragma once

#include "mbd/run/findings.h"

namespace steplap {

/// Returns one finding for each signal that is zero throughout the run and for each record with gaps, and one if no load acts although the
/// file has signals of loads. acted_loads.h reports signals that
/// the end cuts off. A gravity that the run sets, as a load case does with `pull`, is a load, too.
[[nodiscard]] std::vector<Finding> implausible_loads(const LoadedModel& loaded);
/// Returns one finding for each contact element whose coefficient of friction, given in the file or set by an action, is unusually high for
/// dry contacts: a note if the element gives a `source`, otherwise a warning. Above the highest value of any dry contact the warning also
/// prevents the verdict "hold".
[[nodiscard]] std::vector<Finding> implausible_friction(const LoadedModel& loaded);
/// Returns a finding if gravity points straight up, except by the `pull` of a load case, or is more than six times that of the Earth.
[[nodiscard]] std::vector<Finding> implausible_gravity(const LoadedModel& loaded);
/// Returns one finding for each group of positions, velocities, masses or inertias of too different magnitude, and for each angle beyond a
/// full turn.
[[nodiscard]] std::vector<Finding> magnitude_warnings(const LoadedModel& loaded);

} // namespace steplap
