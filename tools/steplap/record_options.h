// Options by which a recorder's file is read and searched for shocks: those of every command that reads one.
#pragma once

#include "tools/steplap/command.h"
#include "transformer/recorder/events.h"
#include "transformer/recorder/option_words.h"

#include <array>

namespace steplap {

/// As given on the command line.
struct ReadingOptions {
  using Text = std::optional<std::string>;
  Text x, y, z, time, time_unit, rate, unit, counts_per_g, delimiter, decimal, dates, missing, repeated, backward, gap, range;
  Text quiet, gravity, cfc, resample, threshold, before, after, merge;
  bool holds = false;
};

/// They refer to `o`.
[[nodiscard]] std::vector<Option> reading_options(ReadingOptions& o);

/// A number above `least`. Throws UsageError.
[[nodiscard]] double number_of(const ReadingOptions::Text& text, const char* option, double least, const char* unit = "");
/// One of some words. Throws UsageError.
template <class Words> auto choice(const std::string& text, const char* option, const Words& words) {
  if (const auto meaning = meaning_of(words, text)) return *meaning;
  std::string known;
  for (const std::string& word : words_of(words)) known += (known.empty() ? "" : ", ") + word;
  throw UsageError(std::string(option) + " '" + text + "': give one of " + known);
}

/// Throw UsageError.
[[nodiscard]] ReadOptions read_options(const ReadingOptions& o);
[[nodiscard]] EventRules event_rules(const ReadingOptions& o);
/// Two times in s, of --rest.
[[nodiscard]] std::array<double, 2> rest_stretch(const std::string& text);

} // namespace steplap
