// Results to the bit; of NaN neither sign nor payload count.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace steplap::testing {

inline bool are_same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

} // namespace steplap::testing
