// What a run leaves behind: named channels at uniform times.
#pragma once

#include "mbd/base/name_pattern.h"
#include "mbd/system/system.h"

#include <string>
#include <vector>

namespace steplap {

class Trajectory {
public:
  /// The channels of `system` whose names match one of `patterns` (* and ?; none = all).
  Trajectory(const System& system, const std::vector<std::string>& patterns);

  /// `t`: the time the sample is due; snapshot.t may lie a hair before it, left of a breakpoint.
  void add(double t, const Snapshot& snapshot);

  [[nodiscard]] const std::vector<const Channel*>& channels() const { return channels_; }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] std::size_t size() const { return times_.size(); }
  [[nodiscard]] double value(std::size_t row, std::size_t channel) const {
    return values_[row * channels_.size() + channel];
  }
  /// Column of a channel by name; throws std::out_of_range for an unknown one.
  [[nodiscard]] std::size_t column(const std::string& name) const;
  [[nodiscard]] std::vector<double> series(const std::string& name) const;

private:
  std::vector<const Channel*> channels_;
  std::vector<double> times_, values_;
};


} // namespace steplap
