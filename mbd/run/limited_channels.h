// Channels limited by criteria of [[acceptance]] or of elements, with their limits.
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

/// A channel that must stay between two values.
struct LimitedChannel {
  std::string criterion;                                    ///< name of the criterion
  std::size_t channel = 0;                                  ///< index in RunResult::ranges
  double least = -std::numeric_limits<double>::infinity();  ///< lower limit, in the channel's unit
  double largest = std::numeric_limits<double>::infinity(); ///< upper limit, in the channel's unit

  /// Returns the distance, in the channel's unit, from the range [low, high] to the nearer limit; negative beyond the limit.
  [[nodiscard]] double reserve(double low, double high) const { return std::min(low - least, largest - high); }
};

/// Distance of criteria from their limits during a run, from the running extremes that the run has recorded (RunResult::growth).
class ReserveHistory {
public:
  /// Keeps a reference to `result`.
  ReserveHistory(const RunResult& result, std::vector<LimitedChannel> limited) : result_(result), limited_(std::move(limited)) {}

  /// Returns the number of criteria; 0 if the run recorded no running extremes.
  [[nodiscard]] std::size_t count() const { return result_.growth.empty() ? 0 : limited_.size(); }
  /// Returns limit i.
  [[nodiscard]] const LimitedChannel& limited(std::size_t i) const { return limited_[i]; }
  /// Returns the reserve of criterion i, in the channel's unit, at the last recorded time before t, s.
  [[nodiscard]] double reserve(std::size_t i, double t) const;
  /// Returns the reserve of criterion i at the start.
  [[nodiscard]] double first_reserve(std::size_t i) const;

private:
  const RunResult& result_;
  std::vector<LimitedChannel> limited_;
};

/// Returns the limits of all criteria that are met and have values; none if the run recorded no extremes.
[[nodiscard]] std::vector<LimitedChannel> limited_channels(const Model& model, const RunResult& result, const Judgement& judgement);

} // namespace steplap
