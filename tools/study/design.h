// Study kind "design": finds the values of one variable with which all limits hold, for certain or with a target reliability, or the cheapest
// combination of several.
#pragma once

#include "tools/study/reliability.h"

namespace steplap::study {

/// Settings of a "design" study. Those of reliability studies control the search for design points and the sampling.
struct DesignSettings : ReliabilitySettings {
  std::optional<double> beta, p; ///< target: reliability index or probability of failure; none: all limits hold for certain
  long points = 21;              ///< number of values of the first look along the range
  double tolerance = 1e-4;       ///< of a border, relative to its value
  std::string cost;              ///< formula of the variables; "": one variable is sought
};

[[nodiscard]] StudyKind design_kind();

} // namespace steplap::study
