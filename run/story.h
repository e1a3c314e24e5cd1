// What happened in a run, in few entries: who slipped, lifted, tipped, broke, when and how far.
//
// Events of one element that repeat are one entry: a foot that lifts 14 times is told of once. Where more than a handful of elements
// do the same, they are one entry, too. Changes that only the integrator needs (a change of foot, a kink of a table) are left out.
#pragma once

#include "run/range_index.h"
#include "run/report.h"
#include "run/shown_quantity.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// How far, or how hard: SI.
struct StoryAmount {
  double value = 0.0;               ///< in `unit`
  std::string unit;                 ///< "m", "N", "rad"
  std::optional<double> error = {}; ///< in `unit`, if it was estimated
};

/// m: by which lengths are measured that may be rounding, as places are known to 1e-12 m.
constexpr double k_least_length_scale = 1e-3;

/// One thing that happened, once or several times.
struct StoryEntry {
  double from = 0.0;                 ///< s, when it began for the first time
  std::optional<double> to;          ///< s, when it was over for the last time; none: an instant, or it lasts to the end of the run
  std::string what;                  ///< "slips", "lifts", "opens", "closes", "tips", "breaks", "strikes", …
  std::vector<std::string> who;      ///< names of elements; of what tips, of bodies
  std::size_t count = 1;             ///< how often
  std::optional<StoryAmount> amount; ///< how far at most
  std::string text;                  ///< a sentence: "Front joint slips from 0.122 s to 0.15 s and slides 46 mm."
};

/// In order of their begin.
[[nodiscard]] std::vector<StoryEntry> story_of(const Report& report, const RangeIndex& ranges, ShownDigits digits = {});
/// Does such an entry tell that elements moved that could have held (slipped, opened, broke)?
[[nodiscard]] bool tells_of_motion(const StoryEntry& entry);
/// The name as a sentence begins with it: "Front joint".
[[nodiscard]] std::string sentence_name(std::string name);

} // namespace steplap
