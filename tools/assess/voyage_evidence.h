// Finds evidence for the decision "energise" that is missing in the records and models together (tools/assess/evidence.h).
#pragma once

#include "tools/assess/assessment.h"

namespace steplap::assess {

/// Returns the letters of the record's axes that drive one of the models.
[[nodiscard]] std::string axes_used(const std::vector<DrivenModel>& models);
/// Finds missing axes, coverage and clocks, which require no run of a model.
void find_gaps_before_runs(const AssessmentOptions& options, Assessment& assessment);
/// Checks whether position and bandwidth of the recorder could change the decision "energise". Repeats the voyage with other corner
/// frequencies.
void check_bandwidth_and_position(const AssessmentOptions& options, Assessment& assessment);

} // namespace steplap::assess
