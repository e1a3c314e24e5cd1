// Samples and findings as CSV: the same bytes for the same study, however it was run. What computing cost in seconds is
// in the store only.
#pragma once

#include "tools/study/store.h"

#include <iosfwd>

namespace steplap::study {

void export_samples(Store& store, std::ostream& out);
void export_histories(const std::vector<Store::CurvePoint>& points, std::ostream& out);
void export_findings(const std::vector<Finding>& findings, std::ostream& out);

} // namespace steplap::study
