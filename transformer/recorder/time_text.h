// Parses dates and times as recorders write them: ISO 8601, local orders of day, month and year, times of day with either decimal sign.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace steplap {

/// Order of year, month and day in a date. Values are bits, so that several possible orders can be combined.
enum DateOrder : unsigned { k_year_first = 1, k_day_first = 2, k_month_first = 4 };

/// Returns all orders in which the beginning of the text is a valid date; 0 if there is none. A four-digit year first, a month's name, or
/// dots between the numbers (day first) determine a single order.
[[nodiscard]] unsigned possible_date_orders(std::string_view text);

/// A date, a time of day, or both.
struct Stamp {
  std::int64_t ns = 0; ///< ns since 1970-01-01 00:00 in the given zone or local time; for a time of day alone, since midnight
  bool has_date = false, has_clock = false, has_zone = false;
};
/// Parses the whole text as date, time of day, or both. Returns nothing if it is invalid in this order, such as a date that does not exist.
[[nodiscard]] std::optional<Stamp> parse_stamp(std::string_view text, unsigned order);

/// Returns "2016-01-04 10:25:14.003".
[[nodiscard]] std::string stamp_text(std::int64_t ns);

inline constexpr std::int64_t k_second_ns = 1'000'000'000, k_day_ns = 86'400 * k_second_ns;

} // namespace steplap
