// What a run leaves behind: named channels at uniform times. However many rows there are, the memory they take is bounded
// (row_store.h).
#pragma once

#include "mbd/base/name_pattern.h"
#include "mbd/simulation/row_store.h"
#include "mbd/system/system.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace steplap {

/// The samples of one run: a row per time, a column per channel.
class Trajectory {
public:
  /// The channels of `system` whose names match one of `patterns` (* and ?; none = all).
  Trajectory(const System& system, const std::vector<std::string>& patterns);

  /// `t`: the time the sample is due; snapshot.t may lie a hair before it, left of a breakpoint. `system`: that of the snapshot, with the
  /// same channels in the same order.
  void add(double t, const Snapshot& snapshot, const System& system);

  /// Those sampled, in the system's order.
  [[nodiscard]] const std::vector<const Channel*>& channels() const { return channels_; }
  /// Rows there are.
  [[nodiscard]] std::size_t size() const { return rows_->size(); }
  /// Of a row, s.
  [[nodiscard]] double time(std::size_t row) const { return rows_->row(row)[0]; }
  /// Row after row is fast; column after column reads rows that are on disk again and again.
  [[nodiscard]] double value(std::size_t row, std::size_t channel) const { return rows_->row(row)[channel + 1]; }
  /// Time and values of a row; valid until another is asked for.
  [[nodiscard]] std::span<const double> row(std::size_t i) const { return {rows_->row(i), channels_.size() + 1}; }
  /// All of them at once, in memory.
  [[nodiscard]] const std::vector<double>& times() const;
  /// Column of a channel by name; throws std::out_of_range for an unknown one.
  [[nodiscard]] std::size_t column(const std::string& name) const;
  /// All values of a channel by its name, in its unit, one per row; throws std::out_of_range for an unknown one.
  [[nodiscard]] std::vector<double> series(const std::string& name) const;

private:
  std::vector<const Channel*> channels_;
  std::vector<std::size_t> places_;   ///< of them in System::channels
  std::unique_ptr<RowStore> rows_;    ///< time, then the channels
  mutable std::vector<double> times_; ///< as far as they were asked for
};

} // namespace steplap
