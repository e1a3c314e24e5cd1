// Evidence required for the decision "energise": the whole voyage was recorded in every relevant direction, and the models were driven by
// the records. If an item is missing, the decision is at best "open". Each item has a remedy, and a keyword with which the user can accept
// that it is missing.
#pragma once

#include <string>
#include <vector>

namespace steplap::assess {

/// Items of evidence. Each enumerator names what is wrong if the item is missing.
enum class Evidence {
  clipped,   ///< peaks were cut off by the recorder's range
  gaps,      ///< samples are missing
  peaks,     ///< only peaks were recorded, no waveform
  cut,       ///< the record begins or ends too early
  comments,  ///< a comment within the data was not understood
  fall,      ///< the recorder read zero on all axes, including gravity, for a time: it fell freely
  dead,      ///< an axis did not measure, or stopped measuring
  unit,      ///< the reading at rest is neither gravity nor zero, or a value is impossible in a transport
  axis,      ///< an axis with shocks drives no model, or is not recorded
  coverage,  ///< the records do not cover the whole voyage
  clock,     ///< the order of the records is not known
  bandwidth, ///< the decision depends on frequencies above the filter or the sampling rate
  place,     ///< the margin is smaller than the error that the recorder's position on the tank can cause
  vibration, ///< the decision depends on vibration below the lowest threshold that the computing budget permits
  planes     ///< two models rest on friction in different planes, and none of it is shared
};
/// Returns the word used with --accept.
[[nodiscard]] const char* name_of(Evidence item);
/// Returns all items in the order of the enumeration.
[[nodiscard]] const std::vector<Evidence>& all_evidence();

/// A missing item of evidence, with sentences for reason and remedy.
struct MissingEvidence {
  Evidence item = Evidence::clipped;
  std::string reason, remedy;
};

} // namespace steplap::assess
