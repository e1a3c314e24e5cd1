// Creates sheets to be signed: one page of A4 as a self-contained HTML file, with drawing, loads, limits with their sources, and space for
// signatures.
#pragma once

#include "mbd/run/loaded_model.h"
#include "mbd/run/ordered_json.h"
#include "mbd/run/results.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// Returns the sheet of a machine's load cases; each model shows one plane of the machine. `document`: the results from
/// load_cases_document() (run/summary.h).
[[nodiscard]] std::string cases_sheet(const std::vector<std::shared_ptr<const LoadedModel>>& models, const OrderedJson& document);
/// Returns the sheet of a run: the machine at its worst instant, load case, limits. Throws FileError for damaged results.
[[nodiscard]] std::string run_sheet(Results run);
/// Returns the first sheet of an assessment or of a static proof. Throws as assessment_page().
[[nodiscard]] std::string assessment_sheet(const std::string& folder);

} // namespace steplap
