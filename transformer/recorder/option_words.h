// Names of the values of options that resolve ambiguities of a recorder's file, on the command line and in models.
#pragma once

#include "transformer/recorder/read_options.h"
#include "transformer/recorder/time_text.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

template <class Value, std::size_t count> using OptionWords = std::array<std::pair<const char*, Value>, count>;

inline constexpr OptionWords<char, 4> k_delimiters{{{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"blank", ' '}}};
inline constexpr OptionWords<char, 2> k_decimals{{{"point", '.'}, {"comma", ','}}};
inline constexpr OptionWords<unsigned, 3> k_dates{
    {{"day-first", k_day_first}, {"month-first", k_month_first}, {"year-first", k_year_first}}};
inline constexpr OptionWords<IfMissing, 3> k_missing{{{"refuse", IfMissing::refuse}, {"skip", IfMissing::skip}, {"hold", IfMissing::hold}}};
inline constexpr OptionWords<IfRepeated, 3> k_repeated{
    {{"refuse", IfRepeated::refuse}, {"first", IfRepeated::first}, {"last", IfRepeated::last}}};
inline constexpr OptionWords<IfBackward, 3> k_backward{
    {{"refuse", IfBackward::refuse}, {"split", IfBackward::split}, {"drop", IfBackward::drop}}};

/// Returns the value with this name; nothing for an unknown name.
template <class Words> [[nodiscard]] auto meaning_of(const Words& words, const std::string& word) {
  std::optional<decltype(words[0].second)> meaning;
  for (const auto& [known, value] : words)
    if (word == known) meaning.emplace(value);
  return meaning;
}
template <class Words> [[nodiscard]] std::vector<std::string> words_of(const Words& words) {
  std::vector<std::string> texts;
  for (const auto& each : words) texts.emplace_back(each.first);
  return texts;
}

} // namespace steplap
