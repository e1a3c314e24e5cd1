// Chooses the threshold above which stretches of a record are simulated, because vibration below it may still move the machine if it lasts
// long.
//
// An event begins and ends where the signal falls below a quarter of its threshold, so that sustained vibration is one event. For an axis
// that drives a model, the first threshold is the requested one, or the largest reading of the axis if this is lower. It is halved until
// the decision, the smallest margin and, with equal samples, the probability of damage do not change over two halvings.
#pragma once

#include "tools/assess/assessment.h"

namespace steplap::assess {

/// Returns the thresholds of a record's axes after `halvings`. `used` are the letters of axes that drive a model; other axes keep the
/// requested threshold.
[[nodiscard]] EventRules rules_at(const RecordEvents& record, const std::string& used, int halvings);

/// Finds the events of records read without events. Fills events, histories and, if needed for the comparison, samples.
void find_events_that_matter(const AssessmentOptions& options, Assessment& assessment);

} // namespace steplap::assess
