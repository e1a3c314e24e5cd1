// The channels that criteria bound, with their limits: those of [[acceptance]] and those of elements.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/run_record.h"
#include "mbd/trust/judgement.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace steplap {

/// A channel that has to stay between two values.
struct LimitedChannel {
  std::string criterion;                                    ///< its name
  std::size_t channel = 0;                                  ///< in RunResult::ranges
  double least = -std::numeric_limits<double>::infinity();  ///< in the channel's unit
  double largest = std::numeric_limits<double>::infinity(); ///< in the channel's unit

  /// How far inside its limits the nearest of two extremes is; negative: beyond.
  [[nodiscard]] double reserve(double low, double high) const { return std::min(low - least, largest - high); }
};

/// All criteria that hold and have values; none for a run without extremes.
[[nodiscard]] std::vector<LimitedChannel> limited_channels(const Model& model, const RunResult& result, const Judgement& judgement);

} // namespace steplap
