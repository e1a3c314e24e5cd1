// Compares the records of a voyage with those of a second recorder on the same machine. Each recorder is assessed on its own, so that neither
// fills what the other missed, and the less favourable decision counts.
#pragma once

#include "tools/assess/record_events.h"
#include "transformer/decision/criteria.h"

#include <array>
#include <string>
#include <vector>

namespace steplap::assess {

struct Assessment;
struct AssessmentOptions;

/// Results of the assessment by the records of one recorder alone.
struct RecorderFindings {
  std::vector<std::string> files;
  std::string covered;            ///< sentence about the time that its records cover
  std::array<double, 3> greatest; ///< largest magnitude of x, y and z, filtered, m/s²; NaN for an axis that it lacks
  std::size_t events = 0;         ///< that drove the models
  double least_margin = 0.0;      ///< of all joints in all events; infinite without joints
  Decision decision = Decision::open;
  std::string reason;
  std::vector<std::string> tests; ///< that would show the damage
};

/// Returns the findings of an assessment.
[[nodiscard]] RecorderFindings findings_of(const Assessment& assessment);

/// Assesses `records` of a second recorder with the same models and options. Throws as assess() does.
[[nodiscard]] RecorderFindings assess_second(const std::vector<std::string>& records, const std::vector<std::string>& models,
                                             const AssessmentOptions& options);

} // namespace steplap::assess
