// One line on a terminal that tells how far a study is: how many samples, how fast, how long still, the running
// estimate.
#pragma once

#include "tools/steplap/console.h"
#include "tools/study/evaluator.h"

#include <string>

namespace steplap::study {

/// "3200 of about 12000 samples, 380 a second, about 23 s left; monte_carlo: probability 2e-03 [1e-03, 4e-03]".
[[nodiscard]] std::string progress_text(const Pace& pace);

class ProgressLine {
public:
  explicit ProgressLine(Console& console) : console_(console) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// Wipes the line.
  ~ProgressLine();
  /// Nothing where there is no terminal.
  void operator()(const Pace& pace);

private:
  Console& console_;
  double last_ = -1.0;
  bool is_shown_ = false;
};

} // namespace steplap::study
