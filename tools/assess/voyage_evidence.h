// What the records and models together lack of the evidence that a decision to energise needs (tools/assess/evidence.h).
#pragma once

#include "tools/assess/assessment.h"

namespace steplap::assess {

/// Letters of the record's axes that drive one of the models.
[[nodiscard]] std::string axes_used(const std::vector<DrivenModel>& models);
/// Axes, coverage and clocks: what is known before a model is run.
void find_unseen(const AssessmentOptions& options, Assessment& assessment);
/// Place and bandwidth, of an assessment that would say "energise": runs the voyage again with other corner frequencies.
void find_undecided(const AssessmentOptions& options, Assessment& assessment);

} // namespace steplap::assess
