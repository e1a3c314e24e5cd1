// Study kind "sensitivity": determines the influence of each variable.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

/// Settings of a "sensitivity" study.
struct SensitivitySettings : KindSettings {
  std::string method = "elasticity"; ///< elasticity, morris, sobol, tornado
  double difference = 1e-3;          ///< relative step for elasticities
  long samples = 1000;               ///< base sample size for Sobol indices
  long trajectories = 20;            ///< number of trajectories of Morris' method
  long levels = 8;
  double confidence = 0.95;
};

/// Returns the relative error of a run's results: the tolerance of adaptive methods. With constant steps it is the accuracy of event
/// location, because step errors vary smoothly with the variables and cancel in differences.
[[nodiscard]] double run_error_of(const LoadedStudy& loaded);

} // namespace steplap::study
