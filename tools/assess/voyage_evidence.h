// Finds evidence that records and models together lack for the decision "energise" (tools/assess/evidence.h).
#pragma once

#include "tools/assess/assessment.h"

namespace steplap::assess {

/// Returns the letters of the record's axes that drive one of the models.
[[nodiscard]] std::string axes_used(const std::vector<DrivenModel>& models);
/// Finds missing axes, coverage and clocks, which are known before a model is run.
void find_unseen(const AssessmentOptions& options, Assessment& assessment);
/// Checks position and bandwidth of the recorder if the decision would be "energise": repeats the voyage with other corner frequencies.
void find_undecided(const AssessmentOptions& options, Assessment& assessment);

} // namespace steplap::assess
