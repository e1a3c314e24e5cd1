// Is a scene one that somebody meant? Loads that are nothing throughout; places, speeds, masses
// and inertias so far beyond each other that rounding of the large ones is the size of the small ones.
#pragma once

#include "run/findings.h"

namespace steplap {

/// Signals that are zero throughout the run, and records with gaps, one finding each. Those that the run's end cuts off: acted_loads.h.
[[nodiscard]] std::vector<Finding> implausible_loads(const LoadedModel& loaded);
/// Friction of contacts that is higher than dry contacts have, one finding for each element. A note that names the element's `source`, if
/// it gives one; else a warning, and beyond what any dry contact has one that caps the verdict.
[[nodiscard]] std::vector<Finding> implausible_friction(const LoadedModel& loaded);
/// Places, speeds, masses and inertias that are too far apart for the digits of a number, and angles beyond a turn, one finding each.
[[nodiscard]] std::vector<Finding> implausible_sizes(const LoadedModel& loaded);

} // namespace steplap
