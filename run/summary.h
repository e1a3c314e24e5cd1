// What summary.json says of a run, as a document: the file is written from it, and so is what the screen shows, of a run
// just made as of one read back.
#pragma once

#include "run/ordered_json.h"
#include "run/report.h"
#include "run/shown_quantity.h"

namespace steplap {

/// What a reader wants to know first: model, overview, findings, how many events. `digits`: of the texts of the overview.
[[nodiscard]] OrderedJson summary_head(const Report& report, ShownDigits digits = {});
/// All of it, but for the files and the checksum that the file ends with.
[[nodiscard]] OrderedJson summary_document(const Report& report, ShownDigits digits = {});

} // namespace steplap
