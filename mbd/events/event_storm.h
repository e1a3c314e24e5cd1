// Detects event storms: too many events of one element in a window of time. The window is a share of the typical time between other changes
// of the model (Simulation::storm_window). An element with fewer events is simulated from event to event.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

/// Event times of each element, the last k_limit of them.
class EventStorm {
public:
  /// Records an event of `element` at t, s. Returns true if the last k_limit events of the element lie within `window`, s.
  bool note(double t, const std::string& element, double window) {
    std::vector<double>& times = times_[element];
    if (times.size() < k_limit) times.push_back(t);
    else times[next_[element]++ % k_limit] = t;
    if (times.size() < k_limit) return false;
    const double oldest = times[next_[element] % k_limit];
    return t - oldest < window;
  }
  /// Resets the count, after an interval of time stepping.
  void clear() {
    times_.clear();
    next_.clear();
  }

  static constexpr std::size_t k_limit = 50; ///< a decaying bounce has about 40 events above rounding

private:
  std::unordered_map<std::string, std::vector<double>> times_;
  std::unordered_map<std::string, std::size_t> next_;
};

} // namespace steplap
