// How low the threshold of events has to be: what stays below it is not run, and may shake a machine for long enough to matter.
//
// An event begins and ends where the signal is at rest, a quarter of its threshold, so that sustained vibration is run whole. On an axis
// that drives a model the threshold is the one asked for, or the greatest that the axis reads where that is less, and it is halved until
// the decision, the least margin and, with the same samples, the probability of damage stay the same through two halvings.
#pragma once

#include "tools/assess/assessment.h"

namespace steplap::assess {

/// Thresholds of a record's axes after so many halvings; `used`: letters of the axes that drive a model. The others keep the one asked for.
[[nodiscard]] EventRules rules_at(const RecordEvents& record, const std::string& used, int halvings);

/// Of records without events: fills events, histories and, if they were made for the comparison, samples.
void find_events_that_matter(const AssessmentOptions& options, Assessment& assessment);

} // namespace steplap::assess
