// All results of one run, as used by the screen, summary.json, pages, studies and programs that link the library.
#pragma once

#include "mbd/run/estimate.h"
#include "mbd/run/finding.h"
#include "mbd/run/run.h"
#include "mbd/run/second_opinion.h"
#include "mbd/trust/joint_assessment.h"
#include "mbd/trust/judgement.h"

#include <map>

namespace steplap {

/// The trajectory as one matrix.
struct Columns {
  std::vector<std::string> names, units; ///< "t" first, then the written channels
  MatX values;                           ///< SI values; one row per sample, one column per name
};

/// All results of one run, made by judged_run() or report_on().
struct Report {
  Run run;                                     ///< the run with its model and, if it failed, its failure
  Estimate estimate;                           ///< estimated errors, or the reason why there are none
  Judgement judgement;                         ///< the verdict and its criteria
  std::vector<JointAssessment> joints;         ///< results of joints that are held by friction, in the order of the model
  std::vector<Finding> findings;               ///< findings before and after the run; those that prevent "hold" are also in the judgement
  std::optional<SecondOpinion> second_opinion; ///< result of a second method, if requested
  std::map<std::string, long> event_counts;    ///< number of events by kind
  double relative_energy_residual = 0.0;       ///< energy residual relative to the energy converted

  /// Returns the ranges of all channels of the system, written or not (mbd/simulation/extremes.h).
  [[nodiscard]] const std::vector<ChannelRange>& ranges() const { return run.result.ranges; }
  /// Returns the range of a channel; nullptr if there is no such channel.
  [[nodiscard]] const ChannelRange* find(const std::string& channel) const;
  /// Returns the estimated error of a range (`which`: minimum, maximum, …); empty without an estimate.
  [[nodiscard]] std::optional<double> error_of(const ChannelRange& range, double ChannelError::*which) const;
  /// Returns the estimated error of the time of event i, s; empty without an estimate.
  [[nodiscard]] std::optional<double> event_error(std::size_t i) const;
  /// Returns the error of the dissipated energy, J; empty without an estimate.
  [[nodiscard]] std::optional<double> dissipated_error() const;
  /// Returns the error of the work of loads and drives, J; empty without an estimate.
  [[nodiscard]] std::optional<double> work_error() const;

  /// Returns all samples as one matrix. It holds rows × names numbers in memory.
  [[nodiscard]] Columns columns() const;
  /// Returns the text of summary.json, except for the list of files that is added when it is written.
  [[nodiscard]] std::string json() const;
  /// Writes all files of the run to a folder, or none of them (result_files.h). Throws FileError.
  void write(const std::string& folder, bool is_overwriting = false) const;
};

/// Runs the model with the settings of `options` and evaluates the run. Throws ModelError if these settings are invalid (with_settings.h),
/// NumericalFailure if the run cannot start.
[[nodiscard]] Report judged_run(std::shared_ptr<const LoadedModel> loaded, const RunOptions& options = {});
/// Evaluates a run that was made with `options`. `before`: findings on its model.
[[nodiscard]] Report report_on(Run run, std::vector<Finding> before, const RunOptions& options);

} // namespace steplap
