// A run as its folder would give it back, without a folder: what pages are made of.
#pragma once

#include "run/report.h"
#include "run/results.h"

namespace steplap {

/// Whether `summary` of the results is made: its text takes as long as much of a short run.
enum class SummaryText { made, left_out };

/// What read_results() gives of the folder that Report::write() fills, but for the date of model.toml, which is not known.
[[nodiscard]] Results results_of(const Report& report, SummaryText summary = SummaryText::made);

} // namespace steplap
