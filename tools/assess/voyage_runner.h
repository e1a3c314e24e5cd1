// A whole voyage of one model by one compiled system, for many samples of its uncertain values: events one after the other on one
// axis of time, quiet stretches left out. Slides, verdicts and margins as in the passages in detail, without errors.
#pragma once

#include "mbd/system/instance.h"
#include "tools/assess/driven_model.h"
#include "tools/assess/friction_trace.h"
#include "tools/assess/voyage_summary.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace steplap::assess {

/// What a sample made of a voyage in one model.
struct VoyageOutcome {
  VoyageSummary summary;
  std::vector<char> slips; ///< per event: a joint slipped
  std::size_t events_made = 0;
  std::vector<std::vector<FrictionTrace>> traces; ///< per event made, of DrivenModel::traced
};

/// One object for each thread.
class VoyageRunner {
public:
  /// `histories`: of the events, each from 0. `paths` of the numbers that vary. Throws ModelError for a model that cannot be run.
  VoyageRunner(const DrivenModel& model, const std::vector<DriveHistory>& histories, std::vector<std::string> paths);
  VoyageRunner(const VoyageRunner&) = delete;
  VoyageRunner& operator=(const VoyageRunner&) = delete;
  ~VoyageRunner();

  /// `numbers`: one per path. Never throws for what a sample may do: then `unknown` of the summary says why. `stop`, if given, is
  /// asked between events.
  [[nodiscard]] VoyageOutcome run(const std::vector<double>& numbers, const std::function<bool()>& stop = {});

private:
  struct Course;
  void pass_events(Course& course);
  const DrivenModel& model_;
  std::vector<double> begins_; ///< s, of each event; then the end of the last
  std::vector<double> steps_;  ///< s, of traces in each event
  Model given_;
  std::unique_ptr<Variants> variants_;
};

} // namespace steplap::assess
