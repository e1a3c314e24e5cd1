// Probability of failure given that the system held, or failed, in past loads (Bayesian update).
//
// Let x be the variables that keep their values, such as friction and clamping, and y those that each load draws independently, such as the
// shock. If the system held in N loads, P(failure | evidence) = E[f(x, y_0) L(x)] / E[L(x)], where f is the indicator of failure and L =
// Π_k 1[g(x, y_k) ≥ 0]. Both expectations are means over the same samples of x, y_0, …, y_N. Every second sample is drawn from the
// distributions of the variables, the others around the design points. The weight of a sample is the density of the variables divided by
// the sum of both sampling densities, so it is at most 1.
#pragma once

#include "tools/study/samplers.h"

namespace steplap::study {

/// Appends errors of all [[evidence]] to `problems`.
void check_evidence(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);

/// Estimates the probability of failure with and without the evidence, and the updated means and deviations of its variables, until the
/// target is met. Adds findings and notes to the answer, which is marked as not trusted if too few samples agree with the evidence.
void sample_with_evidence(LimitFunction& limit, const DesignPoints& points, const SamplingTarget& target, Answer& answer);

} // namespace steplap::study
