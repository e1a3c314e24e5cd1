// Study kind "design": finds the values of one variable for which all limits hold, with certainty or with a target reliability, or the
// cheapest combination of several variables.
#pragma once

#include "tools/study/reliability.h"

namespace steplap::study {

/// Settings of a "design" study. The inherited settings control the search for design points and the sampling.
struct DesignSettings : ReliabilitySettings {
  /// target: reliability index or probability of failure; if neither is given, all limits must hold in the run with nominal values
  std::optional<double> beta, p;
  long points = 21;        ///< number of values in the first scan of the range
  double tolerance = 1e-4; ///< tolerance of the ends of intervals, relative to their values
  std::string cost;        ///< cost as a formula of the variables; "": the study searches one variable
};

} // namespace steplap::study
