// Counts the events of each element in a window of time: a storm is where one element has too many.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

class EventStorm {
public:
  /// Notes an event of `element` at t, s; true if it is one of too many within the window.
  bool note(double t, const std::string& element) {
    std::vector<double>& times = times_[element];
    if (times.size() < k_limit) times.push_back(t);
    else times[next_[element]++ % k_limit] = t;
    if (times.size() < k_limit) return false;
    const double oldest = times[next_[element] % k_limit];
    return t - oldest < k_window;
  }
  /// After an interval of time stepping counting begins anew.
  void clear() {
    times_.clear();
    next_.clear();
  }

  static constexpr std::size_t k_limit = 50; ///< a bounce that dies out has some 40 above rounding
  static constexpr double k_window = 1e-3;   ///< s: no machine part goes to and fro 25 times in a millisecond
  static_assert(k_limit == 50 && k_window == 1e-3, "the words of a storm (base/event_kind.cpp) say so");

private:
  std::unordered_map<std::string, std::vector<double>> times_;
  std::unordered_map<std::string, std::size_t> next_;
};

} // namespace steplap
