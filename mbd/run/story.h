// Summarises the events of a run in few entries: what slipped, lifted, tipped or broke, when and how far.
//
// Repeated events of one element are one entry: a foot that lifts 14 times is reported once. If many elements do the same, they share one
// entry. Events that concern only the integrator (change of contact point, kink of a table) are omitted.
#pragma once

#include "mbd/run/range_index.h"
#include "mbd/run/report.h"
#include "mbd/run/shown_quantity.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Largest motion or load of an occurrence, SI.
struct StoryAmount {
  double value = 0.0;               ///< amount, in `unit`
  std::string unit;                 ///< "m", "N", "rad"
  std::optional<double> error = {}; ///< error of the value, in `unit`, if estimated
};

/// Smallest reference length, m. Lengths below 1e-9 of the reference length are rounding, because positions are accurate to 1e-12 m.
constexpr double k_least_length_scale = 1e-3;

/// Subject of an entry. If an element opens and closes repeatedly, its first event decides whether the entry says "opens" or "closes": a
/// resting foot lifts, a flying ball touches.
enum class StorySubject : std::uint8_t {
  slips,       ///< friction or a joint begins to slip
  would_slip,  ///< a monitored joint beyond its capacity
  lifts,       ///< a foot that carried its body opens
  opens,       ///< another contact opens
  touches,     ///< an open contact closes
  slack,       ///< a rope loses its tension
  taut,        ///< a rope becomes taut
  leaves_gap,  ///< an arresting device leaves contact
  closes_gap,  ///< an arresting device comes into contact
  strikes,     ///< a stop is reached
  leaves_stop, ///< a stop is left
  tips,        ///< a body tips
  breaks,      ///< a tie breaks
  apart,       ///< a joint comes apart
  interface,   ///< a joint loses an interface
  storm,       ///< an element changes too often to be followed
  happens      ///< an action is executed
};
/// Returns the key of a subject in summary.json: "slips", "lifts", "opens", "closes", "tips", "breaks", "strikes", …
[[nodiscard]] const char* key_of(StorySubject what);

/// An occurrence, single or repeated.
struct StoryEntry {
  double from = 0.0;                       ///< begin of the first occurrence, s
  std::optional<double> to;                ///< end of the last occurrence, s; empty for an instant, or if it lasts until the end of the run
  StorySubject what = StorySubject::slips; ///< the kind of occurrence
  std::vector<std::string> who;            ///< names of elements; for "tips", of bodies
  std::size_t count = 1;                   ///< number of occurrences
  std::optional<StoryAmount> amount;       ///< largest amount
  std::string text;                        ///< sentence: "Block slides 46 mm on deck from 0.122 s to 0.15 s."
};

/// Returns the entries in order of their begin.
[[nodiscard]] std::vector<StoryEntry> story_of(const Report& report, const RangeIndex& ranges, ShownDigits digits = {});
/// Returns true if the entry reports that an element slipped, opened or broke.
[[nodiscard]] bool describes_motion(const StoryEntry& entry);
/// Returns the name with a capital first letter: "Front joint".
[[nodiscard]] std::string sentence_name(std::string name);

} // namespace steplap
