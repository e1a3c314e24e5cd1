// Dimensions of units for formulas: a factor and powers of kg, m and s. Units in model files are read by UDUNITS (mbd/io/units.h); a test
// compares both.
//
// Accepted are products with a space, quotients by one factor each ("N m/rad", "kg/m/s"), powers as "m^2" or "m2", and SI prefixes from
// nano to giga. Angles are dimensionless. "Hz", "rpm" and "g" are not accepted because they are ambiguous: turns or radians, grams or the
// acceleration of gravity.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace steplap {

/// Dimension of a unit, and its size in SI.
struct UnitDimension {
  double factor = 1.0;            ///< SI value of one unit
  std::array<double, 3> powers{}; ///< exponents of kg, m, s

  [[nodiscard]] bool is_number() const { return powers == std::array<double, 3>{}; }
};

/// Returns the dimension of a unit; nothing if the unit is unknown.
[[nodiscard]] std::optional<UnitDimension> dimension_of(std::string_view unit);

/// Returns the SI unit with exponents `powers` of kg, m, s in the form used for channels; "" for a dimensionless number.
[[nodiscard]] std::string unit_text(const std::array<double, 3>& powers);

} // namespace steplap
