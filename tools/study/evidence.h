// Survived loads as evidence: probability of failure if it is known that the system held, or failed, in loads of the past (Bayes).
//
// Let x be the variables that stay, such as friction and clamping, and y those that each load draws anew, such as the shock. With N loads
// that were held, P(failure | evidence) = E[f(x, y_0) L(x)] / E[L(x)], where L = Π_k 1[g(x, y_k) ≥ 0]. Both expectations are means over the
// same samples of x, y_0, …, y_N: every second one is drawn from the distributions of the variables, the others around the design points of
// failure. The weight of a sample is the density of the variables over the sum of both densities, so that none is above 1.
#pragma once

#include "tools/study/samplers.h"

namespace steplap::study {

/// Appends errors of all [[evidence]] to `problems`.
void check_evidence(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);

/// Estimates the probability of failure with and without the evidence of the study, and what the evidence says about its variables, until
/// the target is met. Adds findings and notes to the answer, which is not to be trusted if too few samples agree with the evidence.
void sample_with_evidence(LimitFunction& limit, const DesignPoints& points, const SamplingTarget& target, Answer& answer);

} // namespace steplap::study
