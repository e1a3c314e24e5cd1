// The kind "sensitivity": how much does each variable matter.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

struct SensitivitySettings : KindSettings {
  std::string method = "elasticity"; ///< elasticity, morris, sobol, tornado
  double difference = 1e-3;          ///< relative step of an elasticity
  long samples = 1000;               ///< base size of Sobol indices
  long trajectories = 20;            ///< of Morris
  long levels = 8;
  double confidence = 0.95;
};

[[nodiscard]] StudyKind sensitivity_kind();

/// What a number of a run is known to: by its tolerance; of fixed steps by how events are located, since errors of
/// steps themselves change smoothly with the variables.
[[nodiscard]] double run_error_of(const LoadedStudy& loaded);

} // namespace steplap::study
