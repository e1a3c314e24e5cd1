// Converts a run to the results that reading its folder would give, without writing files. Pages are made from these.
#pragma once

#include "mbd/run/report.h"
#include "mbd/run/results.h"

namespace steplap {

/// Whether the text of the summary is created, which takes much of the time of a short run.
enum class SummaryText { made, left_out };

/// Returns the same as read_results() for the folder written by Report::write(), except for the date of model.toml, which is unknown.
[[nodiscard]] Results results_of(const Report& report, SummaryText summary = SummaryText::made);

} // namespace steplap
