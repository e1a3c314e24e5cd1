// Shows the progress of a study in one line of a terminal: number of samples, rate, remaining time and the present estimate.
#pragma once

#include "tools/steplap/console.h"
#include "tools/study/evaluator.h"

#include <string>

namespace steplap::study {

/// Returns "3200 of about 12000 samples, 380 a second, about 23 s left; monte_carlo: probability 2e-03 [1e-03, 4e-03]".
[[nodiscard]] std::string progress_text(const Pace& pace);

class ProgressLine {
public:
  explicit ProgressLine(Console& console) : console_(console) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// Erases the line.
  ~ProgressLine();
  /// Shows the progress; does nothing without a terminal.
  void operator()(const Pace& pace);

private:
  Console& console_;
  double last_ = -1.0;
  bool is_shown_ = false;
};

} // namespace steplap::study
