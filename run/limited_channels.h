// The channels that criteria bound, with their limits: those of [[acceptance]] and those of elements.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/run_record.h"
#include "mbd/trust/judgement.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
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

/// How near criteria had come to their limits at any time of a run that kept how its extremes grew (RunResult::growth).
class ReserveHistory {
public:
  /// Refers to `result`.
  ReserveHistory(const RunResult& result, std::vector<LimitedChannel> limited) : result_(result), limited_(std::move(limited)) {}

  /// Of the criteria; 0 if nothing was kept.
  [[nodiscard]] std::size_t count() const { return result_.growth.empty() ? 0 : limited_.size(); }
  [[nodiscard]] const LimitedChannel& limited(std::size_t i) const { return limited_[i]; }
  /// Reserve of criterion i at the last time before t, s, that was kept.
  [[nodiscard]] double reserve(std::size_t i, double t) const;
  /// The same at the start.
  [[nodiscard]] double first_reserve(std::size_t i) const;

private:
  const RunResult& result_;
  std::vector<LimitedChannel> limited_;
};

/// All criteria that hold and have values; none for a run without extremes.
[[nodiscard]] std::vector<LimitedChannel> limited_channels(const Model& model, const RunResult& result, const Judgement& judgement);

} // namespace steplap
