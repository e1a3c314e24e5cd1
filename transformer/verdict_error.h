// A judgement weighed by the errors of its numbers (mbd/analysis/global_error.h): what a criterion is worth whose value is known
// to so many digits only.
//
// A criterion that is met, but whose error reaches the limit, is not: nor is it one to inspect the machine for, since
// nothing is known to be wrong with it. It is *open*, and a run at a smaller tolerance or step decides. The same goes
// for one whose error is unknown, and for one that a finer run does not meet. A criterion that is not met stays so,
// even where the error reaches back to the limit: that is said beside it.
#pragma once

#include "mbd/analysis/global_error.h"
#include "transformer/verdict.h"

namespace steplap {

/// Errors of the figures of a JointAssessment, in their units; not-a-number where unknown.
struct JointErrors {
  double first_slip = 0.0, largest_required_pressure = 0.0, time_of_largest = 0.0, smallest_margin = 0.0;
  double slid_x = 0.0, slid_y = 0.0, slid_angle = 0.0, area_lost = 0.0;
  double slid_share = 0.0, overlap_left = 0.0, clearance_left = 0.0, edge_load = 0.0, edge_share = 0.0;
};

[[nodiscard]] JointErrors joint_errors(const JointAssessment& joint, const System& system, const RunResult& run,
                                       const GlobalErrorEstimate& estimate);

/// Gives every criterion its error, and takes back those that are met within it only. A run whose motion is known to
/// less than a tenth of its range is not to be trusted, nor one in which something slips that holds in the finer run, or
/// the other way round, where a verdict or a tenth of a slid distance depends on it.
void weigh_errors(Judgement& judgement, const Model& model, const System& system, const RunResult& run,
                  const GlobalErrorEstimate& estimate);
/// Of a run whose error should have been estimated and could not: no criterion can be called met.
void leave_open(Judgement& judgement, const std::string& why);

/// The run is not to be trusted: its verdict is open.
void distrust(Judgement& judgement, const std::string& why);

} // namespace steplap
