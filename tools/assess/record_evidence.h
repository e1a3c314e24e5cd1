// Finds evidence that a single record lacks for the decision "energise".
#pragma once

#include "tools/assess/axis_watch.h"
#include "tools/assess/record_events.h"
#include "tools/assess/signal_watch.h"

namespace steplap::assess {

/// Returns the acceleration, m/s², below which nothing counts as a shock, whatever threshold the user chose.
[[nodiscard]] double shock_level(const EventRules& rules);
/// Adds the evidence that is missing in a record, without regard to its events.
void find_missing_evidence(const AxisWatch& axes, const SignalWatch& signal, RecordEvents& record);
/// Adds evidence for events whose peaks look clipped, although no sample value repeats.
void find_rounded_tops(const std::vector<RecordEvents>& records, std::vector<MissingEvidence>& missing);
/// Returns true if a comment or last line reports a normal end of recording and nothing else.
[[nodiscard]] bool is_ordinary_end(const std::string& remark);

} // namespace steplap::assess
