// Counter-based random numbers of studies (mbd/base/counter_random.h), determined by seed, stream, sample and index.
#pragma once

#include "mbd/base/counter_random.h"

#include <cstdint>

namespace steplap::study {

/// A stream of random numbers. Different purposes within one study use different streams.
class CounterRandom {
public:
  CounterRandom(std::uint64_t seed, std::uint32_t stream) : seed_(seed), stream_(stream) {}
  /// Returns a number in the open interval (0, 1). `index` < 2³¹.
  [[nodiscard]] double uniform(std::uint64_t sample, std::uint32_t index) const { return counter_uniform(seed_, stream_, sample, index); }
  /// Returns a standard normal number.
  [[nodiscard]] double normal(std::uint64_t sample, std::uint32_t index) const;

private:
  std::uint64_t seed_;
  std::uint32_t stream_;
};

} // namespace steplap::study
