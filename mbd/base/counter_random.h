// Random numbers by counter: the k-th number of the n-th sample of a stream is a function of (seed, stream, n, k) and
// of nothing that came before. Philox 4x32-10 of Salmon, Moraes, Dror and Shaw, SC 2011, by their library Random123.
#pragma once

#include <array>
#include <cstdint>

namespace steplap {

using PhiloxBlock = std::array<std::uint32_t, 4>;
[[nodiscard]] PhiloxBlock philox(PhiloxBlock counter, std::array<std::uint32_t, 2> key);

/// In (0, 1), never an end of it; `index` < 2³¹. Streams keep apart what is drawn for different purposes.
[[nodiscard]] double counter_uniform(std::uint64_t seed, std::uint32_t stream, std::uint64_t sample, std::uint32_t index);

} // namespace steplap
