// Detects event storms: too many events of one element within a time window. The window is a fraction of the typical time between other
// changes of the model (RunLeg::storm_window). Elements with fewer events are simulated from event to event.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

/// The last k_limit event times of each element.
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
  /// Clears all event times, after an interval of time stepping.
  void clear() {
    times_.clear();
    next_.clear();
  }

  static constexpr std::size_t k_limit = 50; ///< a decaying bounce has about 40 events before they reach rounding

private:
  std::unordered_map<std::string, std::vector<double>> times_;
  std::unordered_map<std::string, std::size_t> next_;
};

} // namespace steplap
