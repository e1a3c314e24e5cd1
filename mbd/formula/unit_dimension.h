// What a unit is made of: a factor and powers of kg, m and s. For formulas of channels, whose operands have few units; what a
// model file may write for a quantity is read by UDUNITS (mbd/io/units.h), and a test compares the two.
//
// Products with a space, quotients of one factor each ("N m/rad", "kg/m/s"), powers as "m^2" or "m2", SI prefixes from nano to
// giga. Angles count as numbers. "Hz", "rpm" and "g" are no units here: turns or radians, grams or weights is not told.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace steplap {

struct UnitDimension {
  double factor = 1.0;            ///< so many SI units
  std::array<double, 3> powers{}; ///< of kg, m, s

  [[nodiscard]] bool is_number() const { return powers == std::array<double, 3>{}; }
};

/// Nothing for a unit that is not known.
[[nodiscard]] std::optional<UnitDimension> dimension_of(std::string_view unit);

/// The SI unit of these powers as channels write it; "" for a number.
[[nodiscard]] std::string unit_text(const std::array<double, 3>& powers);

} // namespace steplap
