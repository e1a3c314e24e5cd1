// Options for reading recorder files and for finding shocks in them, common to all commands that do this.
#pragma once

#include "tools/steplap/command.h"
#include "transformer/recorder/events.h"
#include "transformer/recorder/option_words.h"

#include <array>

namespace steplap {

/// Values as given on the command line.
struct ReadingOptions {
  using Text = std::optional<std::string>;
  Text x, y, z, time, time_unit, rate, unit, counts_per_g, delimiter, decimal, dates, missing, repeated, backward, gap, range;
  Text quiet, gravity, cfc, resample, threshold, before, after, merge;
  bool holds = false;
};

/// Returns the options, which refer to `o`.
[[nodiscard]] std::vector<Option> reading_options(ReadingOptions& o);

/// Parses a number greater than `least`, in `unit`. Throws UsageError.
[[nodiscard]] double number_of(const ReadingOptions::Text& text, const char* option, double least, const char* unit = "");
/// Returns the value that `words` assigns to `text`. Throws UsageError for other texts.
template <class Words> auto choice(const std::string& text, const char* option, const Words& words) {
  if (const auto meaning = meaning_of(words, text)) return *meaning;
  std::string known;
  for (const std::string& word : words_of(words)) known += (known.empty() ? "" : ", ") + word;
  throw UsageError(std::string(option) + " '" + text + "': give one of " + known);
}

/// Convert the command-line arguments. Throw UsageError for invalid values.
[[nodiscard]] ReadOptions read_options(const ReadingOptions& o);
[[nodiscard]] EventRules event_rules(const ReadingOptions& o);
/// Parses "3 g", "20 m/s^2", or "3" in g; m/s². `option` names it in messages.
[[nodiscard]] double acceleration_of(const std::string& text, const char* option);
/// Parses the two times of --rest, s.
[[nodiscard]] std::array<double, 2> rest_stretch(const std::string& text);

} // namespace steplap
