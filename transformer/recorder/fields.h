// One line of a table taken apart: fields, numbers with either decimal sign, missing values, and units as recorders write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace steplap {

[[nodiscard]] std::string_view trimmed_blanks(std::string_view text);
/// ASCII letters only.
[[nodiscard]] std::string lower_case(std::string_view text);

/// Fields of a line, blanks and quotes around them left out; a delimiter within quotes does not count. Delimiter ' ': any number of
/// blanks and tabs. Returns false if a quote is opened and not closed.
[[nodiscard]] bool split_fields(std::string_view line, char delimiter, std::vector<std::string_view>& fields);

/// The whole field as a finite number, with the decimal sign '.' or ','; nothing for anything else, "inf" and "nan" among them.
[[nodiscard]] std::optional<double> parse_number(std::string_view field, char decimal);
/// Empty, "NaN", "N/A", "-", "null" and the like: the recorder had no value here.
[[nodiscard]] bool is_missing(std::string_view field);
/// Does it begin with a digit, or with a sign or decimal sign that a digit follows?
[[nodiscard]] bool begins_like_number(std::string_view field);

/// What a unit of acceleration means: its factor to m/s², or counts, whose factor must be said.
struct AccelerationUnit {
  std::string name; ///< as people are shown it: "g", "mg", "m/s^2", "counts"
  double factor = 0.0;
  bool is_counts = false;
};
/// Standard gravity, m/s².
inline constexpr double k_gravity = 9.80665;
/// g, mg (or mG: thousandths of gravity, never gauss or grams), m/s² in all its spellings, counts; then whatever UDUNITS converts to
/// m/s². Nothing if it is no unit of acceleration.
[[nodiscard]] std::optional<AccelerationUnit> acceleration_unit(std::string_view text);
/// Seconds in a unit of time: s, ms, us, ns, min, h, days in their spellings.
[[nodiscard]] std::optional<double> time_unit(std::string_view text);

/// A column's heading taken apart: "Acc. X [mG]" is the name "Acc. X" and the unit "mG".
struct Heading {
  std::string name, unit;
};
[[nodiscard]] Heading heading_of(std::string_view field);

} // namespace steplap
