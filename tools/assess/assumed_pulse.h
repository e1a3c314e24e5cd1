// Creates acceleration pulses of an assumed shape for recorders that store only the peaks of shocks. Data missing in the list is taken from
// options; all directions that the list leaves possible are simulated.
#pragma once

#include "tools/assess/record_events.h"

#include <optional>
#include <string>
#include <string_view>

namespace steplap::assess {

/// Parses "half-sine", "haversine" or "triangle", optionally with a duration for lists without one, as in "half-sine 50 ms". Returns
/// nothing for any other text.
[[nodiscard]] std::optional<AssumedPulse> parse_assumed_pulse(std::string_view text);

/// Adds an event for each entry whose peak exceeds the threshold, and for the largest peak of each axis below it. If peaks have no sign,
/// one event is added for each possible direction. Throws FileError if neither the list nor an option gives the duration of a shock, its
/// axis, or whether gravity is included.
void add_assumed_pulses(const EventReading& reading, RecordEvents& record);

} // namespace steplap::assess
