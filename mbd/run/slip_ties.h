// Finds verdicts that depend on which of two friction elements slips first.
//
// If one element begins to slip while another is almost at its own friction bound (SimultaneousSlip), a tiny change of a coefficient
// decides which of them slips. The slipping element then unloads the other one. The run is repeated with the same settings, but with the
// other element slipping at that time. If this changes the verdict, the verdict is not reliable.
#pragma once

#include "mbd/run/findings.h"
#include "mbd/run/run.h"
#include "mbd/trust/judgement.h"

#include <optional>
#include <vector>

namespace steplap {

struct GlobalErrorEstimate;

/// Returns one finding for each pair of elements with a tie, at the time when the utilisation of the sticking element is nearest to 1:
/// within 1e-5, or within the change of the utilisation during the error of the event time. The finding is a warning and prevents "hold" if
/// the other order changes the verdict. It is a note if the verdict is the same or the other order could not be run. `errors`: errors of
/// the run; nullptr if unknown. At most `most_runs` runs are made.
[[nodiscard]] std::vector<Finding> slip_ties(const Run& run, const RunOptions& options, const Judgement& judgement,
                                             const GlobalErrorEstimate* errors, int most_runs = 3);

} // namespace steplap
