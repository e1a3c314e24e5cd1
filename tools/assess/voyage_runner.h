// Simulates the whole voyage in one model for many samples of the uncertain values, with one compiled system. Events follow each other
// without the intervals at rest between them. Slides, verdicts and margins are computed as in passage.h, but without error estimates.
#pragma once

#include "elements/views/friction_plane.h"
#include "mbd/system/instance.h"
#include "tools/assess/driven_model.h"
#include "tools/assess/voyage_summary.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace steplap::assess {

/// Result of one sample for one model.
struct VoyageOutcome {
  VoyageSummary summary;
  std::vector<char> slips; ///< for each event: true if a joint slipped
  std::size_t events_made = 0;
  /// friction histories of the elements in DrivenModel::traced, one list per simulated event
  std::vector<std::vector<SampledFriction>> traces;
};

/// Runs samples. Each thread needs its own object.
class VoyageRunner {
public:
  /// `histories`: those of the events, each starting at time 0. `paths`: model fields that vary. Throws ModelError if the model cannot be
  /// run.
  VoyageRunner(const DrivenModel& model, const std::vector<DriveHistory>& histories, std::vector<std::string> paths);
  VoyageRunner(const VoyageRunner&) = delete;
  VoyageRunner& operator=(const VoyageRunner&) = delete;
  ~VoyageRunner();

  /// Runs one sample. `numbers` has one value per path. Failures of the sample do not throw; they are described in `unknown` of the
  /// summary. `stop`, if given, is polled between events.
  [[nodiscard]] VoyageOutcome run(const std::vector<double>& numbers, const std::function<bool()>& stop = {});

private:
  struct Course;
  void pass_events(Course& course);
  const DrivenModel& model_;
  std::vector<double> begins_; ///< begin of each event, then the end of the last, s
  std::vector<double> steps_;  ///< step of the traces in each event, s
  Model given_;
  std::unique_ptr<Variants> variants_;
};

} // namespace steplap::assess
