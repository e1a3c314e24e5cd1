// Finds verdicts that depend on which of two frictional elements slips first.
//
// Where one element begins to slip and another is all but at its own bound (SlipTie), a few digits of a coefficient decide which of
// them gives way; the one that does relieves the other by what its kinetic coefficient takes. The run is then repeated with the same
// settings, but at that instant the other one slips. If this leads to another verdict, neither of the two is known.
#pragma once

#include "mbd/trust/judgement.h"
#include "run/findings.h"
#include "run/run.h"

#include <optional>
#include <vector>

namespace steplap {

struct GlobalErrorEstimate;

/// Of each pair of elements the tie that is nearest: a share of the bound nearer to 1 than 1e-5, or than the share changes by within the
/// error of the event's time. A warning, which forbids "hold", where the other order leads to another verdict; a note where it leads to
/// the same one or could not be run. `errors`: of the run; null: not known. At most `most_runs` runs are made.
[[nodiscard]] std::vector<Finding> slip_ties(const Run& run, const RunOptions& options, const Judgement& judgement,
                                             const GlobalErrorEstimate* errors, int most_runs = 3);

} // namespace steplap
