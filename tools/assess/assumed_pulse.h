// Shocks of which a recorder tells the peaks alone, as pulses of an assumed shape: what a list of peaks leaves open is asked for, or
// run in all the ways that it may have been.
#pragma once

#include "tools/assess/record_events.h"

#include <optional>
#include <string>
#include <string_view>

namespace steplap::assess {

/// "half-sine", "haversine" or "triangle", and how long where the list does not tell, as in "half-sine 50 ms". Nothing for other text.
[[nodiscard]] std::optional<AssumedPulse> parse_assumed_pulse(std::string_view text);

/// Adds an event for each entry whose peak is beyond the threshold, and for the greatest of each axis below it; where no peak of the
/// list has a sign, one for each of the directions it may have had. Throws FileError if the list does not tell how long a shock
/// lasted, along which axis it was, or whether gravity is in it, and no option does.
void add_assumed_pulses(const EventReading& reading, RecordEvents& record);

} // namespace steplap::assess
