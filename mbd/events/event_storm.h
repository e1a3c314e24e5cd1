// Counts the events of each element in a window of time: a storm is where one element has too many.
//
// The window is a share of the times in which the scene changes otherwise (Simulation::storm_window): what has fewer events
// goes at the scene's own pace, and is followed from one to the next.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

class EventStorm {
public:
  /// Notes an event of `element` at t, s; true if it is one of too many within `window`, s.
  bool note(double t, const std::string& element, double window) {
    std::vector<double>& times = times_[element];
    if (times.size() < k_limit) times.push_back(t);
    else times[next_[element]++ % k_limit] = t;
    if (times.size() < k_limit) return false;
    const double oldest = times[next_[element] % k_limit];
    return t - oldest < window;
  }
  /// After an interval of time stepping counting begins anew.
  void clear() {
    times_.clear();
    next_.clear();
  }

  static constexpr std::size_t k_limit = 50; ///< a bounce that dies out has some 40 above rounding

private:
  std::unordered_map<std::string, std::vector<double>> times_;
  std::unordered_map<std::string, std::size_t> next_;
};

} // namespace steplap
