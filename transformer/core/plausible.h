// Remarks on cores with unusual values. Values outside the usual range are permitted. Ranges are those of power transformers' cores; each
// names its source, or states that nothing is published.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// Usual range of a field of [[core]].
struct UsualRange {
  const char* field;
  double low, high; ///< limits of the range, SI
  const char* text; ///< text of the range: "0.18 mm to 0.35 mm"
  const char* source;
};

/// Returns the ranges of all fields that have one.
[[nodiscard]] const std::vector<UsualRange>& usual_ranges();

struct CoreRemark {
  Location where;   ///< location of the field if given, otherwise of the table
  std::string text; ///< text without location
  /// true: the value may well be intended, so the remark is only information
  bool is_note = false;
};

/// Returns the remarks for a completed model. Each names the value, the usual range and its source. Masses that disagree with the sheets
/// are included. A mitre angle that was not given and is not 45° is a note.
[[nodiscard]] std::vector<CoreRemark> implausible_cores(const Model& model);

} // namespace steplap
