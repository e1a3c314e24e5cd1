// Is a core as cores usually are? What is outside of its usual range is allowed, and worth a second look.
//
// Ranges are of power transformers' cores; each names where it comes from. Where nothing is published it says so.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// What a value of a [[core]] usually is.
struct UsualRange {
  const char* field;
  double low, high; ///< SI
  const char* text; ///< "0.18 mm to 0.35 mm"
  const char* source;
};

/// Of all fields that have one.
[[nodiscard]] const std::vector<UsualRange>& usual_ranges();

struct CoreRemark {
  Location where;   ///< in the model's file: of the field if the table gives it, else of the table
  std::string text; ///< without the place
  /// What may well be meant, and is worth knowing: no doubt of the core.
  bool is_note = false;
};

/// Of a completed model: each names the value, what is usual and by which source; given masses that hardly agree
/// with the sheets', too. A mitre that nobody gave and that is not cut at 45° is a note.
[[nodiscard]] std::vector<CoreRemark> implausible_cores(const Model& model);

} // namespace steplap
