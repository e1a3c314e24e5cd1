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
  double low, high;   ///< SI
  const char* text;   ///< "0.18 mm to 0.35 mm"
  const char* source;
};

/// Of all fields that have one.
[[nodiscard]] const std::vector<UsualRange>& usual_ranges();

/// Of a completed model: each names the value, what is usual and by which source; given masses that hardly agree
/// with the sheets', too.
[[nodiscard]] std::vector<std::string> implausible_cores(const Model& model);

} // namespace steplap
