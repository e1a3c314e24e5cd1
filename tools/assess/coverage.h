// Compares the begin and end of the voyage, as given by the user, with the time covered by the records.
#pragma once

#include "tools/assess/record_events.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// Begin and end of the voyage, as clock times or in the seconds of the record.
struct Voyage {
  std::string text; ///< text as given by the user
  bool is_clock = false, has_zone = false;
  double from = 0.0, to = 0.0;         ///< s in the time of the record; 0 for clock times
  std::int64_t from_ns = 0, to_ns = 0; ///< ns since 1970; 0 for seconds of the record
};
/// Parses "FROM,TO": two times of the record in s, or two dates with times of day. Returns nothing for any other text.
[[nodiscard]] std::optional<Voyage> parse_voyage(const std::string& text);

/// Returns a sentence about the time covered by the records.
[[nodiscard]] std::string coverage_text(const std::vector<RecordEvents>& records);
/// Returns the fraction of the voyage covered by the records, 0 to 1; nothing if it cannot be computed (uncovered() returns the reason).
[[nodiscard]] std::optional<double> covered_share(const std::vector<RecordEvents>& records, const std::optional<Voyage>& voyage);
/// Returns the reason why the voyage is not covered, with a remedy; nothing if it is covered.
[[nodiscard]] std::optional<MissingEvidence> uncovered(const std::vector<RecordEvents>& records, const std::optional<Voyage>& voyage);

} // namespace steplap::assess
