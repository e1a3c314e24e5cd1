// Creates the sheet of load cases as one self-contained HTML file: one page of A4 with drawing, cases, limits and room for signatures.
#pragma once

#include "mbd/run/loaded_model.h"
#include "mbd/run/ordered_json.h"

#include <string>

namespace steplap {

/// `document` are the results, as load_cases_document() returns them (mbd/run/summary.h).
[[nodiscard]] std::string cases_page(const LoadedModel& model, const OrderedJson& document);

} // namespace steplap
