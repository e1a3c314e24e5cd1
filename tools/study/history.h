// Measured records that a fit compares with channels of runs.
#pragma once

#include "mbd/io/document.h"
#include "mbd/simulation/trajectory.h"
#include "tools/study/study_reader.h"

namespace steplap::study {

/// Reads a record and converts it to seconds and the unit of the channel. `entry` is the [[history]] of the study file. Errors are appended
/// to `problems`.
void load_history(const Node& entry, const StudyModel& model, History& history, std::vector<Diagnostic>& problems);

/// Sampling of runs for comparison with the histories of a model.
struct Sampling {
  double step = 0.0;    ///< s; 0: the model has no history
  bool is_exact = true; ///< true if every measured time is a multiple of `step`; otherwise runs are interpolated linearly
};
/// Returns the sampling needed for the histories of this model.
[[nodiscard]] Sampling sampling_of(const Study& study, const StudyModel& model);

/// Writes the channel's values at the measured times, from a run with this sampling. NaN after the end of the run.
void compare_times(const History& history, const Sampling& sampling, const Trajectory& trajectory, double* values);

} // namespace steplap::study
