// The kind "reliability": how likely is failure.
#pragma once

#include "tools/study/study_kind.h"

#include <optional>

namespace steplap::study {

struct ReliabilitySettings : KindSettings {
  std::vector<std::string> methods{"form", "importance_sampling"};
  std::vector<std::string> limit_states; ///< all if none
  std::string combination = "any";       ///< the system fails where any, or where all of them are negative
  double cov = 0.05;                     ///< sampling stops at this coefficient of variation of the probability
  long samples = 100000;                 ///< and at this number of samples for each method
  std::optional<double> seconds;         ///< and at this time for each method
  double difference = 1e-3;              ///< step of difference in standard normal space
  long starts = 8;                       ///< of the search for design points
  std::optional<long> search_samples;    ///< for all searches together; 300 and 50 for each variable if not given
  long subset_samples = 2000;            ///< a level
  long repetitions = 4;                  ///< of subset simulation: its interval comes from their scatter
  double confidence = 0.95;

  [[nodiscard]] bool ends_by_clock() const override { return seconds.has_value(); }
};

[[nodiscard]] StudyKind reliability_kind();

} // namespace steplap::study
