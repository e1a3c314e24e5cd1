// Quantities written as text, "47 t", "0.5 mm", "1.1 km/h", "0.6 gravity", turned into SI values
// and checked for dimension. Unit names are those of UDUNITS-2: products with a space ("N m"),
// powers as "m^2" or "m2", SI prefixes on any unit. Note that "g" is the gram; the acceleration is
// "gravity", 9.80665 m/s².
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// The value in the wanted unit, or what is wrong with the text (`problem` not empty).
struct Quantity {
  double value = 0.0;
  std::string problem;
};

/// Where a unit is looked up: among the few that nearly all files use first, or in UDUNITS' database alone.
enum class UnitSource { usual_first, database };

/// Reads "number unit". `unit` is what the field is kept in (SI, UDUNITS spelling, "" =
/// dimensionless); "*" takes any unit and gives the value in SI base units. Angles count as
/// dimensionless, except that "rad/s" or "rpm" for a unit of "Hz" is divided by 2π, and "Hz" for an
/// angular velocity is refused. Throws ModelError if the unit database is missing. Thread-safe.
[[nodiscard]] Quantity parse_quantity(const std::string& text, const std::string& unit, UnitSource source = UnitSource::usual_first);

/// Powers of kg, m and s in the unit of "number unit"; nothing where the text is no such quantity, or has a unit with other base
/// units in it. Throws ModelError if the unit database is missing. Thread-safe.
[[nodiscard]] std::optional<std::array<double, 3>> powers_in(const std::string& text);

/// The pairs (unit as written, unit of the field) that need no database.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> usual_units();

} // namespace steplap
