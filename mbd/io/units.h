// Converts quantities given as text, "47 t", "0.5 mm", "1.1 km/h", "0.6 gravity", to SI values and checks their dimension. Unit names are
// those of UDUNITS-2: products with a blank ("N m"), powers as "m^2" or "m2" (unit_text.h), SI prefixes on any unit. "g" is the gram; the
// acceleration is "gravity", 9.80665 m/s².
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// A value in the required unit, or an error message in `problem`.
struct Quantity {
  double value = 0.0;
  std::string problem;
};

/// Where a unit is looked up: first in the table of frequent units, or only in the UDUNITS database. Both give the same result.
enum class UnitSource { usual_first, database };

/// Reads "number unit" and converts it to `unit`, the unit of a field (SI, UDUNITS spelling, "" = dimensionless); "*" accepts any unit and
/// returns the value in SI base units. Angles count as dimensionless, with two exceptions: for a field in "Hz", "rad/s" and "rpm" are
/// divided by 2π, and "Hz" and "1/min" are refused for an angular velocity. Throws ModelError if the unit database is missing. Thread-safe.
[[nodiscard]] Quantity parse_quantity(const std::string& text, const std::string& unit, UnitSource source = UnitSource::usual_first);

/// Returns the exponents of kg, m and s in the unit of "number unit"; nothing if the text is not a quantity or its unit contains other base
/// units. Throws ModelError if the unit database is missing. Thread-safe.
[[nodiscard]] std::optional<std::array<double, 3>> powers_in(const std::string& text);

/// Returns the pairs (unit as written, unit of the field) that are converted without the database.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> usual_units();

} // namespace steplap
