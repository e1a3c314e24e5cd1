// Shows the progress of a run in one line of a terminal. Without a terminal it shows nothing.
#pragma once

#include "tools/steplap/console.h"

#include <chrono>
#include <string>

namespace steplap {

/// Progress of one run with the end time `end`, s.
class Progress {
public:
  Progress(Console& console, std::string name, double end);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Erases the line.
  ~Progress();

  /// Shows the progress at time t, s.
  void operator()(double t);

private:
  Console& console_;
  std::string name_;
  double end_ = 0.0;
  bool is_shown_ = false;
  std::chrono::steady_clock::time_point last_;
};

} // namespace steplap
