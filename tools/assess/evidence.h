// What "energise" needs: evidence that the whole voyage was seen, in every direction that matters, and that the models were driven by
// it. Each item that is missing makes the decision "open" at best, says what would supply it, and has one word by which whoever decides
// takes it upon himself.
#pragma once

#include <string>
#include <vector>

namespace steplap::assess {

enum class Evidence {
  clipped,   ///< peaks were higher
  gaps,      ///< samples are missing
  peaks,     ///< there is no waveform
  cut,       ///< the record begins or ends too early
  comments,  ///< a line among the rows tells of something that is not understood
  fall,      ///< the recorder read nothing for a time, gravity included
  dead,      ///< an axis did not measure, or stopped measuring
  unit,      ///< what the record reads at rest is neither gravity nor nothing, or a value is none of a transport
  axis,      ///< an axis with shocks drives no model, or is not recorded
  coverage,  ///< the records do not show the voyage from its begin to its end
  clock,     ///< the order of the records is not known
  bandwidth, ///< the decision depends on frequencies that a filter or the rate leaves out
  place,     ///< the margin is smaller than what the place of the recorder may falsify
  vibration  ///< the decision depends on what stays below the lowest threshold that the budget allows
};
/// The word of --accept.
[[nodiscard]] const char* name_of(Evidence item);
[[nodiscard]] const std::vector<Evidence>& all_evidence();

/// An item that is missing: why, and what supplies it; whole sentences.
struct MissingEvidence {
  Evidence item = Evidence::clipped;
  std::string reason, remedy;
};

} // namespace steplap::assess
