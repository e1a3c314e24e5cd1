// What a run came to: the same for the screen, for summary.json, for pages, for studies and for programs that link the library.
#pragma once

#include "elements/step_lap/step_lap_assessment.h"
#include "mbd/trust/judgement.h"
#include "run/estimate.h"
#include "run/finding.h"
#include "run/run.h"
#include "run/second_opinion.h"

#include <map>

namespace steplap {

/// Rows of a trajectory as one block, for programs that calculate with all of it.
struct Columns {
  std::vector<std::string> names, units; ///< "t" first, then the channels written
  MatX values;                           ///< SI; a row a sample, a column a name
};

/// Everything that is known about one run, as judged_run() and report_on() make it.
struct Report {
  Run run;                                     ///< the run itself, with its model and its failure, if there was one
  Estimate estimate;                           ///< errors of its numbers, or why there are none
  Judgement judgement;                         ///< the verdict and all that it was made of
  std::vector<JointAssessment> joints;         ///< of all step-lap joints
  std::vector<Finding> findings;               ///< before and after the run: those that forbid "hold" stand in the judgement, too
  std::optional<SecondOpinion> second_opinion; ///< if one was asked for
  std::map<std::string, long> event_counts;    ///< by the words of the kind
  double relative_energy_residual = 0.0;       ///< of the energy exchanged

  /// Of all channels of the system, written or not (mbd/simulation/extremes.h).
  [[nodiscard]] const std::vector<ChannelRange>& ranges() const { return run.result.ranges; }
  /// nullptr if there is no such channel.
  [[nodiscard]] const ChannelRange* find(const std::string& channel) const;
  /// Of one of the ranges; empty without an estimate.
  [[nodiscard]] std::optional<double> error_of(const ChannelRange& range, double ChannelError::*which) const;
  /// Of the i-th event of the run.
  [[nodiscard]] std::optional<double> event_error(std::size_t i) const;
  /// Of the dissipated energy, J; empty without an estimate.
  [[nodiscard]] std::optional<double> dissipated_error() const;
  /// Of the work of loads and drives, J; empty without an estimate.
  [[nodiscard]] std::optional<double> work_error() const;

  /// All rows that were sampled, in memory: as many numbers as rows times names.
  [[nodiscard]] Columns columns() const;
  /// The text of summary.json, without the files that it lists where it is written.
  [[nodiscard]] std::string json() const;
  /// All files of the run into a folder, or none of them (result_files.h). Throws FileError.
  void write(const std::string& folder, bool is_overwriting = false) const;
};

/// Runs the model, with the settings of `options` laid over it, and finds out all that is known about the run. Throws ModelError for
/// settings that it cannot be run with (with_settings.h), NumericalFailure if nothing could be run.
[[nodiscard]] Report judged_run(std::shared_ptr<const LoadedModel> loaded, const RunOptions& options = {});
/// The same of a run that has been made with `options`. `before`: what was found in its model.
[[nodiscard]] Report report_on(Run run, std::vector<Finding> before, const RunOptions& options);

} // namespace steplap
