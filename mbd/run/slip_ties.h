// Finds verdicts that depend on which of two friction elements slips first.
//
// If one element begins to slip while another is almost at its own friction bound (SimultaneousSlip), tiny changes of a coefficient decide which one
// slips. The slipping element then unloads the other one. The run is repeated with the same settings, but with the other element slipping
// at that time. If this changes the verdict, the verdict is not reliable.
#pragma once

#include "mbd/run/findings.h"
#include "mbd/run/run.h"
#include "mbd/trust/judgement.h"

#include <optional>
#include <vector>

namespace steplap {

struct GlobalErrorEstimate;

/// Returns one finding for each pair of elements, for their closest tie. A tie is closest if the share of the friction bound in use is
/// nearest to 1: nearer than 1e-5, or nearer than the change of the share within the error of the event time. The finding is a warning and
/// prevents "hold" if the other order changes the verdict. It is a note if the verdict is the same or the other order could not be run.
/// `errors` belong to the run; nullptr if unknown. At most `most_runs` runs are made.
[[nodiscard]] std::vector<Finding> slip_ties(const Run& run, const RunOptions& options, const Judgement& judgement,
                                             const GlobalErrorEstimate* errors, int most_runs = 3);

} // namespace steplap
