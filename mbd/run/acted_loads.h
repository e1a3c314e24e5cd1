// Finds loads that have not acted completely within a run. Signals, forces and formulas of time should begin, reach their full size and end
// before the run ends.
//
// Only the time during which an element acts counts: actions release, hold and set elements, and can end the run. The times of actions are
// taken from the events of the run. A load has acted completely if:
//
//   signal with an end     its end comes while its element acts
//   harmonics, sea, road   SignalCourse::k_periods mean periods have passed at full size; two suffice if the last one raised the
//                          utilisation of each criterion by less than 0.01
//   ramp and hold,         nothing moves any more; or the second half of the time at full size raised the utilisation of each criterion
//   constant               by less than 0.01, and some utilisation is above zero, bodies move uniformly, or an action ends it. A constant
//                          load does not require a longer run if other loads change with time
//   formula of time        it changes within the run, or it is constant after the end, too
//
// An action with a `reason` that ends a load is intended; such a load is not reported.
#pragma once

#include "mbd/run/findings.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Returns, before a run, a finding for each signal that the end of the run cuts off. Assumes that no action is executed.
[[nodiscard]] std::vector<Finding> loads_beyond_end(const LoadedModel& loaded);
/// Returns, before a run that begins in equilibrium, a warning for each pulse that jumps from zero exactly at the start and is a force: the
/// search for the equilibrium takes it as acting before, so that it is no blow.
[[nodiscard]] std::vector<Finding> pulses_at_rest(const LoadedModel& loaded);
/// Returns, after a completed run, one finding for each load that has not acted completely. `judgement` belongs to `result`.
[[nodiscard]] std::vector<Finding> loads_not_acted(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement);

} // namespace steplap
