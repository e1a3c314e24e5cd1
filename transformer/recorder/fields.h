// Splits lines of a table into fields, and parses numbers with either decimal sign, missing values, and units as recorders write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace steplap {

[[nodiscard]] std::string_view trimmed_blanks(std::string_view text);
/// Returns the text with ASCII letters in lower case; other characters are unchanged.
[[nodiscard]] std::string lower_case(std::string_view text);

/// Splits a line into fields without surrounding blanks and quotes. Delimiters within quotes are ignored. Delimiter ' ' means any number of
/// blanks and tabs. Returns false if a quote is not closed.
[[nodiscard]] bool split_fields(std::string_view line, char delimiter, std::vector<std::string_view>& fields);

/// Parses the whole field as a finite number with decimal sign '.' or ','. Returns nothing for any other text, including "inf" and "nan".
[[nodiscard]] std::optional<double> parse_number(std::string_view field, char decimal);
/// Returns true for "", "NaN", "N/A", "-", "null" and similar texts, with which recorders mark a missing value.
[[nodiscard]] bool is_missing(std::string_view field);
/// Returns true if the field begins with a digit, or with a sign or decimal sign followed by a digit.
[[nodiscard]] bool begins_like_number(std::string_view field);

/// A unit of acceleration with its factor to m/s². For counts the user must supply the factor.
struct AccelerationUnit {
  std::string name; ///< name for display: "g", "mg", "m/s^2", "counts"
  double factor = 0.0;
  bool is_counts = false;
};
/// Standard gravity, m/s².
inline constexpr double k_gravity = 9.80665;
/// Recognises g, mg (also mG: thousandths of gravity, never gauss or grams), all spellings of m/s², counts, and every unit that UDUNITS can
/// convert to m/s². Returns nothing for other units.
[[nodiscard]] std::optional<AccelerationUnit> acceleration_unit(std::string_view text);
/// Returns the number of seconds in a unit of time: s, ms, us, ns, min, h, days, in several spellings. Returns nothing for other units.
[[nodiscard]] std::optional<double> time_unit(std::string_view text);

/// A column heading split into name and unit: "Acc. X [mG]" gives "Acc. X" and "mG".
struct Heading {
  std::string name, unit;
};
[[nodiscard]] Heading heading_of(std::string_view field);

} // namespace steplap
