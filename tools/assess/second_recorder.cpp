#include "tools/assess/second_recorder.h"

#include "tools/assess/assessment.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace steplap::assess {

RecorderFindings findings_of(const Assessment& a) {
  RecorderFindings found;
  found.greatest.fill(std::numeric_limits<double>::quiet_NaN());
  for (const RecordEvents& record : a.records) {
    found.files.push_back(record.file);
    for (std::size_t i = 0; i < record.axes().size(); ++i) {
      double& greatest = found.greatest[static_cast<std::size_t>(record.axes()[i] - 'x')];
      if (!(greatest >= record.greatest[i])) greatest = record.greatest[i];
    }
  }
  found.covered = coverage_text(a.records);
  found.events = a.events.size();
  found.least_margin = a.summary.least_margin;
  found.decision = a.decision;
  found.reason = a.reason;
  found.tests = a.reasons.empty() ? std::vector<std::string>() : a.reasons.front().tests;
  return found;
}

RecorderFindings assess_second(const std::vector<std::string>& records, const std::vector<std::string>& models,
                               const AssessmentOptions& options) {
  AssessmentOptions own = options;
  own.second_records.clear();
  if (!own.sampling.store.empty()) own.sampling.store = std::filesystem::path(own.sampling.store).replace_filename("samples_second.sqlite");
  return findings_of(assess(records, models, own));
}

} // namespace steplap::assess
