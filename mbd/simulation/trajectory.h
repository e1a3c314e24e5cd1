// Samples of a run: channels at uniform times. Memory is bounded for any number of rows (row_store.h).
#pragma once

#include "mbd/base/name_pattern.h"
#include "mbd/simulation/row_store.h"
#include "mbd/system/system.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace steplap {

/// The samples of one run: one row per time, one column per channel.
class Trajectory {
public:
  /// Samples the channels of `system` whose names match one of `patterns` (wildcards * and ?; no patterns: all channels).
  Trajectory(const System& system, const std::vector<std::string>& patterns);

  /// Adds a row. `t` is the sampling time, s; snapshot.t may be slightly before it, left of a breakpoint. `system` is that of the snapshot
  /// and must have the same channels in the same order.
  void add(double t, const Snapshot& snapshot, const System& system);

  /// Returns the sampled channels, in the system's order.
  [[nodiscard]] const std::vector<const Channel*>& channels() const { return channels_; }
  /// Returns the number of rows.
  [[nodiscard]] std::size_t size() const { return rows_->size(); }
  /// Returns the time of a row, s.
  [[nodiscard]] double time(std::size_t row) const { return rows_->row(row)[0]; }
  /// Returns one value, in the unit of the channel. Reading by rows is fast; reading by columns reads rows on disk repeatedly.
  [[nodiscard]] double value(std::size_t row, std::size_t channel) const { return rows_->row(row)[channel + 1]; }
  /// Returns time and values of a row; valid until the next call.
  [[nodiscard]] std::span<const double> row(std::size_t i) const { return {rows_->row(i), channels_.size() + 1}; }
  /// Returns all times.
  [[nodiscard]] const std::vector<double>& times() const;
  /// Returns the column of a channel. Throws std::out_of_range for an unknown name.
  [[nodiscard]] std::size_t column(const std::string& name) const;
  /// Returns all values of a channel in its unit, one per row. Throws std::out_of_range for an unknown name.
  [[nodiscard]] std::vector<double> series(const std::string& name) const;

private:
  std::vector<const Channel*> channels_;
  std::vector<std::size_t> places_;   ///< indices of the channels in System::channels
  std::unique_ptr<RowStore> rows_;    ///< time, then the channels
  mutable std::vector<double> times_; ///< cache of times(), filled on request
};

} // namespace steplap
