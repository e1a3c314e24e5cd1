// Contents of summary.json as a JSON document. The file contains this document, and the screen shows it, both for a new run and for one
// read from its folder.
#pragma once

#include "mbd/run/ordered_json.h"
#include "mbd/run/report.h"
#include "mbd/run/shown_quantity.h"

namespace steplap {

struct LoadCaseResults;

/// Returns the model's file, name, title, overrides and inputs with their checksums.
[[nodiscard]] OrderedJson model_json(const LoadedModel& loaded);
/// Returns verdict, reasons and criteria.
[[nodiscard]] OrderedJson judgement_json(const Judgement& judgement);
/// Returns the main part: model, overview, findings, number of events. `digits` applies to the texts of the overview.
[[nodiscard]] OrderedJson summary_head(const Report& report, ShownDigits digits = {});
/// Returns the results of all load cases (load_cases.h). "judgement" of a case equals that of a separate run with its overrides.
[[nodiscard]] OrderedJson load_cases_document(const LoadCaseResults& results);
/// Returns the whole document except for the list of files and the checksum.
[[nodiscard]] OrderedJson summary_document(const Report& report, ShownDigits digits = {});

} // namespace steplap
