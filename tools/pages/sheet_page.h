// Creates sheets to be signed: one page of A4 as a self-contained HTML file, with drawing, load, limits with their sources and signatures.
#pragma once

#include "mbd/run/loaded_model.h"
#include "mbd/run/ordered_json.h"
#include "mbd/run/results.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// Returns the sheet of load cases of a machine, of which each model shows one plane. `document` are the results, as load_cases_document() returns them (run/summary.h).
[[nodiscard]] std::string cases_sheet(const std::vector<std::shared_ptr<const LoadedModel>>& models, const OrderedJson& document);
/// Returns the sheet of a run: the machine at its worst instant, load case, limits. Throws FileError for damaged results.
[[nodiscard]] std::string run_sheet(Results run);
/// Returns the sheet of an assessment or of a static proof, without the sheets behind it. Throws as assessment_page().
[[nodiscard]] std::string assessment_sheet(const std::string& folder);

} // namespace steplap
