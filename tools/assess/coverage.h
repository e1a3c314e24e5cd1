// When the voyage began and ended, as whoever decides says it, and how much of it the records show.
#pragma once

#include "tools/assess/record_events.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// From when to when: on a clock, or in the record's own seconds.
struct Voyage {
  std::string text; ///< as given
  bool is_clock = false, has_zone = false;
  double from = 0.0, to = 0.0;         ///< s, of the record; 0 on a clock
  std::int64_t from_ns = 0, to_ns = 0; ///< since 1970; 0 in the record's seconds
};
/// "FROM,TO": two times of the record in s, or two dates with times of day. Nothing for other text.
[[nodiscard]] std::optional<Voyage> parse_voyage(const std::string& text);

/// What the records cover, a whole sentence.
[[nodiscard]] std::string coverage_text(const std::vector<RecordEvents>& records);
/// Why the voyage is not covered, and what helps; nothing if it is.
[[nodiscard]] std::optional<MissingEvidence> uncovered(const std::vector<RecordEvents>& records, const std::optional<Voyage>& voyage);

} // namespace steplap::assess
