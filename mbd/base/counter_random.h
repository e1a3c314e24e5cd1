// Counter-based random numbers: number k of sample n of a stream is a function of (seed, stream, n, k) only. Drawing samples in another
// order, or in several threads, therefore does not change them. Generator: Philox 4x32-10 (J. Salmon, M. Moraes, R. Dror, D. Shaw, SC
// 2011), as in their library Random123.
#pragma once

#include <array>
#include <cstdint>

namespace steplap {

using PhiloxBlock = std::array<std::uint32_t, 4>;
/// Returns the Philox 4x32-10 block (128 random bits) for a counter and a key.
[[nodiscard]] PhiloxBlock philox(PhiloxBlock counter, std::array<std::uint32_t, 2> key);

/// Returns a uniformly distributed number in the open interval (0, 1). Use a different `stream` for each purpose. Precondition: `index` <
/// 2³¹.
[[nodiscard]] double counter_uniform(std::uint64_t seed, std::uint32_t stream, std::uint64_t sample, std::uint32_t index);

} // namespace steplap
