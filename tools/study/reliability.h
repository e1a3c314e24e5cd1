// Study kind "reliability": estimates the probability of failure.
#pragma once

#include "tools/study/study_kind.h"

#include <optional>

namespace steplap::study {

/// Settings of a "reliability" study.
struct ReliabilitySettings : KindSettings {
  std::vector<std::string> methods{"form", "importance_sampling"};
  std::vector<std::string> limit_states; ///< limit states of the system; all if empty
  std::string combination = "any";       ///< "any": the system fails if any limit state is negative; "all": only if all are
  double cov = 0.05;                     ///< sampling ends at this coefficient of variation of the probability
  long samples = 100000;                 ///< sampling ends at this number of samples, for each method
  std::optional<double> seconds;         ///< sampling ends after this time, s, for each method
  double difference = 1e-3;              ///< difference step in standard normal space
  long starts = 8;                       ///< number of starts of the design point search
  std::optional<long> search_samples;    ///< limit for all searches together; 300 plus 50 per variable if not given
  long subset_samples = 2000;            ///< samples per level of subset simulation
  long repetitions = 4;                  ///< repetitions of subset simulation, whose scatter gives the confidence interval
  double confidence = 0.95;

  [[nodiscard]] bool ends_by_clock() const override { return seconds.has_value(); }
};

} // namespace steplap::study
