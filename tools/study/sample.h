// Study kind "sample": draws samples from the distributions and describes the responses.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

/// Settings of a "sample" study.
struct SampleSettings : KindSettings {
  std::string design = "monte_carlo"; ///< monte_carlo, latin_hypercube, sobol, halton
  long samples = 1000;
};

[[nodiscard]] StudyKind sample_kind();

} // namespace steplap::study
