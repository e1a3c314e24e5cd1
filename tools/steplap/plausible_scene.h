// Is a scene one that somebody meant? Loads that begin behind the end of the run or are nothing throughout; places, speeds, masses
// and inertias so far beyond each other that rounding of the large ones is the size of the small ones.
#pragma once

#include "tools/steplap/findings.h"

namespace steplap {

[[nodiscard]] std::vector<Finding> implausible_loads(const LoadedModel& loaded);
[[nodiscard]] std::vector<Finding> implausible_sizes(const LoadedModel& loaded);

/// Does the finding forbid to call a run "hold"? What is unusual is no reason to open a machine, and none to sign for it.
[[nodiscard]] bool caps_verdict(const Finding& finding);

} // namespace steplap
