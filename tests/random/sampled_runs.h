// One run sampled often and one that is not sampled: steps, events and motion are to be the same bits, and no sample lies beyond
// the extremes that are told of its channel.
#pragma once

#include "mbd/simulation/simulation.h"

#include <string>
#include <vector>

namespace steplap::random {

/// What a sample was beyond.
struct Beyond {
  std::string channel;
  double t = 0.0;      ///< s
  double excess = 0.0; ///< in the channel's unit
  double range = 0.0;  ///< that was told
  double allowed = 0.0;
};

struct Sampled {
  std::string difference; ///< of the two runs; empty: none
  std::vector<Beyond> beyond;
  std::size_t samples = 0;
  std::string failure; ///< of both
};

/// `options` have an end; `count` samples are taken on the way there.
[[nodiscard]] Sampled sampled(const System& system, const State& start, SimulationOptions options, int count);

} // namespace steplap::random
