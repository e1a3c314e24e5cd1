// Chooses the event threshold of records. Vibration below a threshold is not simulated, but may move the machine if it lasts long.
//
// An event begins and ends where the signal falls below a quarter of its threshold, so that sustained vibration is one event. For an axis
// that drives a model, the first threshold is the requested one, or the largest reading of the axis if this is lower. It is halved until
// two halvings change neither the decision nor the smallest margin nor, for equal samples, the probability of damage. A halving that finds
// no other events counts only if nothing slid, opened or broke: strength then decides, and weaker signals move nothing. From the first
// halving on, a mean over 0.2 s above a quarter of the threshold, but at least 0.1 g, is an event too: braking.
#pragma once

#include "tools/assess/assessment.h"

namespace steplap::assess {

/// Returns the thresholds of a record's axes after `halvings` halvings. `used`: letters of the axes that drive a model; other axes keep the
/// requested threshold.
[[nodiscard]] EventRules rules_at(const RecordEvents& record, const std::string& used, int halvings);

/// Finds the events of records that were read without events, and the required threshold. Fills `events`, `histories` and, if they were
/// needed, samples.
void find_events_that_matter(const AssessmentOptions& options, Assessment& assessment);

} // namespace steplap::assess
