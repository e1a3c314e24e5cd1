// Creates acceleration pulses for recorders that store only the peaks of shocks. Shape and missing data are taken from options. If the list
// leaves the direction open, all possible directions are simulated.
#pragma once

#include "tools/assess/record_events.h"

#include <optional>
#include <string>
#include <string_view>

namespace steplap::assess {

/// Parses "half-sine", "haversine" or "triangle", optionally with the duration for lists that contain none: "half-sine 50 ms". Returns
/// nothing for other texts.
[[nodiscard]] std::optional<AssumedPulse> parse_assumed_pulse(std::string_view text);

/// Adds one event per entry with a peak above the threshold, and one for the largest peak of each axis below it. Peaks without sign give
/// one event per possible direction. Throws FileError if neither the list nor an option gives the duration of a shock, its axis, or whether
/// gravity is included.
void add_assumed_pulses(const EventReading& reading, RecordEvents& record);

} // namespace steplap::assess
