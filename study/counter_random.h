// Random numbers by counter: the k-th number of the n-th sample of a stream is a function of (seed, stream, n, k) and
// of nothing that came before. Philox 4x32-10 of Salmon, Moraes, Dror and Shaw, SC 2011.
#pragma once

#include <array>
#include <cstdint>

namespace steplap::study {

using PhiloxBlock = std::array<std::uint32_t, 4>;
[[nodiscard]] PhiloxBlock philox(PhiloxBlock counter, std::array<std::uint32_t, 2> key);

/// Streams keep apart what one study draws for different purposes.
class CounterRandom {
public:
  CounterRandom(std::uint64_t seed, std::uint32_t stream) : seed_(seed), stream_(stream) {}
  /// In (0, 1), never an end of it; `index` < 2³¹.
  [[nodiscard]] double uniform(std::uint64_t sample, std::uint32_t index) const;
  [[nodiscard]] double normal(std::uint64_t sample, std::uint32_t index) const;

private:
  std::uint64_t seed_;
  std::uint32_t stream_;
};

} // namespace steplap::study
