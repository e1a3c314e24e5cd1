// Exports samples and findings as CSV. The same study gives identical bytes however it was run, because computing times are not exported.
#pragma once

#include "tools/study/store.h"

#include <iosfwd>

namespace steplap::study {

/// Writes one row per sample.
void export_samples(Store& store, std::ostream& out);
/// Writes one row per measured value.
void export_histories(const std::vector<Store::CurvePoint>& points, std::ostream& out);
/// Writes one row per sample that agrees with the evidence, with the values of the random variables that the evidence updates. Returns the
/// number of rows; writes nothing if it is zero.
[[nodiscard]] long export_posterior(const std::vector<Finding>& findings, std::ostream& out);
/// Writes one row per finding.
void export_findings(const std::vector<Finding>& findings, std::ostream& out);

} // namespace steplap::study
