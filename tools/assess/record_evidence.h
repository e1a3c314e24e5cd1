// What one record lacks of the evidence that a decision to energise needs.
#pragma once

#include "tools/assess/axis_watch.h"
#include "tools/assess/record_events.h"
#include "tools/assess/signal_watch.h"

namespace steplap::assess {

/// Below it nothing counts as a shock, whatever threshold the user chose: m/s².
[[nodiscard]] double shock_level(const EventRules& rules);
/// Of a record that was read, without its events: adds what is missing.
void find_missing_evidence(const AxisWatch& axes, const SignalWatch& signal, RecordEvents& record);
/// Of the records' events: peaks that look cut off though no sample repeats.
void find_rounded_tops(const std::vector<RecordEvents>& records, std::vector<MissingEvidence>& missing);
/// Does a comment or a last line tell of an ordinary end, and of nothing else?
[[nodiscard]] bool is_ordinary_end(const std::string& remark);

} // namespace steplap::assess
