// Converts a run to the results from which pages are made, without writing files.
#pragma once

#include "mbd/run/report.h"
#include "mbd/run/results.h"

namespace steplap {

/// Whether the summary's text is needed. Creating it takes much of the time of a short run.
enum class SummaryText { made, left_out };

/// Returns the same results as read_results() for the folder written by Report::write(), but without the date of model.toml.
[[nodiscard]] Results results_of(const Report& report, SummaryText summary = SummaryText::made);

} // namespace steplap
