// Random numbers of studies, drawn by counter (mbd/base/counter_random.h) from one seed and one purpose.
#pragma once

#include "mbd/base/counter_random.h"

#include <cstdint>

namespace steplap::study {

/// Streams keep apart what one study draws for different purposes.
class CounterRandom {
public:
  CounterRandom(std::uint64_t seed, std::uint32_t stream) : seed_(seed), stream_(stream) {}
  /// In (0, 1), never an end of it; `index` < 2³¹.
  [[nodiscard]] double uniform(std::uint64_t sample, std::uint32_t index) const { return counter_uniform(seed_, stream_, sample, index); }
  [[nodiscard]] double normal(std::uint64_t sample, std::uint32_t index) const;

private:
  std::uint64_t seed_;
  std::uint32_t stream_;
};

} // namespace steplap::study
