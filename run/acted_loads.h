// Has a run seen all of its loads? Signals, forces and formulas of time that began, reached their full size and ended within it.
//
// Counted is what acted in the legs that ran: actions release, hold and set elements, and end the run. The events of the run tell when.
//   signal with an end     has acted if its end came while its element acted
//   harmonics, sea, road   after SignalCourse::k_periods mean periods at full size; after two, if the last one has added less than a
//                          hundredth to what each criterion has used
//   ramp and hold          when nothing moves any more; or if the second half of the time at full size has added less than a hundredth to
//                          what each criterion has used, and some has been used or bodies move evenly; or until an action ends it
//   formula of the time    if it changes within the run, or not behind its end either
// An action that cuts a load off ends it as it was meant if it gives a `reason`, whatever has acted by then.
#pragma once

#include "mbd/trust/judgement.h"
#include "run/findings.h"

namespace steplap {

/// Before a run: signals that its end cuts off, as if no action happened.
[[nodiscard]] std::vector<Finding> loads_beyond_end(const LoadedModel& loaded);
/// After a run that was not broken off: loads that have not acted, each once. `judgement`: of this run.
[[nodiscard]] std::vector<Finding> loads_not_acted(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement);

} // namespace steplap
