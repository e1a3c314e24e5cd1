// Dates and times as recorders write them: ISO 8601, local orders of day, month and year, times of day with either decimal sign.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace steplap {

/// In which order a date gives year, month and day. Bits, so that several can be possible.
enum DateOrder : unsigned { k_year_first = 1, k_day_first = 2, k_month_first = 4 };

/// Of a text that begins with a date: the orders in which it is one; 0 if it is none. A year of four digits first, a month's name and
/// dots between the numbers (day first) leave one order.
[[nodiscard]] unsigned possible_date_orders(std::string_view text);

/// An instant or a part of one.
struct Stamp {
  std::int64_t ns = 0; ///< since 1970-01-01 00:00, of the zone given or local; of a time of day alone: since midnight
  bool has_date = false, has_clock = false, has_zone = false;
};
/// The whole text as date, time of day, or both; nothing if it is none in this order, or names a day that does not exist.
[[nodiscard]] std::optional<Stamp> parse_stamp(std::string_view text, unsigned order);

/// "2016-01-04 10:25:14.003"
[[nodiscard]] std::string stamp_text(std::int64_t ns);

inline constexpr std::int64_t k_second_ns = 1'000'000'000, k_day_ns = 86'400 * k_second_ns;

} // namespace steplap
