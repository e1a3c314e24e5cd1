// Finds evidence that a single record lacks for the decision "energise" (evidence.h).
#pragma once

#include "tools/assess/axis_watch.h"
#include "tools/assess/record_events.h"
#include "tools/assess/signal_watch.h"

namespace steplap::assess {

/// Returns the smallest acceleration of a shock, m/s²: the user's threshold, but at most the default one.
[[nodiscard]] double shock_level(const EventRules& rules);
/// Adds missing evidence that does not depend on the record's events.
void find_missing_evidence(const AxisWatch& axes, const SignalWatch& signal, RecordEvents& record);
/// Adds missing evidence for events with flat tops, which look clipped although no sample value repeats.
void find_rounded_tops(const std::vector<RecordEvents>& records, std::vector<MissingEvidence>& missing);
/// Returns true if a comment or last line reports a normal end of recording and nothing else.
[[nodiscard]] bool is_ordinary_end(const std::string& remark);

} // namespace steplap::assess
