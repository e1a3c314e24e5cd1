// Grammar of units in quantities given as text. UDUNITS-2 reads more than this, and not always as it was meant: "300'000 N" as arcminutes,
// "N/m^1.5" as 5 N/m, "kg 500" as 500 kg.
//
// A unit is a product and quotient of names: "N m", "N*m", "N·m", "kN/(m s)", "1/s", each with a power from 1 to 9, which may be negative:
// "m^2", "m**2", "m2", "s-1", "m²". It has no other numbers and no signs of minutes and seconds.
#pragma once

#include <string>

namespace steplap {

/// Returns why a text is not a unit of this grammar, or a unit of doubtful meaning such as "ton"; "" if it is one. The message continues
/// "'5 kg 500' …". Whether the names are units is not checked.
[[nodiscard]] std::string unit_text_problem(const std::string& unit);

} // namespace steplap
