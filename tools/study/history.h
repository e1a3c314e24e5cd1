// Measured records that a fit compares channels of runs with.
#pragma once

#include "mbd/io/document.h"
#include "mbd/simulation/trajectory.h"
#include "tools/study/study_reader.h"

namespace steplap::study {

/// Reads the record, into seconds and the unit of the channel; `entry` is the [[history]] of the study file. Appends
/// what is wrong with it to `problems`.
void load_history(const Node& entry, const StudyModel& model, History& history, std::vector<Diagnostic>& problems);

/// How runs of a model are sampled for its histories.
struct Sampling {
  double step = 0.0;    ///< s; 0: the model has no history
  bool is_exact = true; ///< every measured time is a multiple of it; else runs are interpolated linearly between samples
};
[[nodiscard]] Sampling sampling_of(const Study& study, const StudyModel& model);

/// The channel at the measured times, from a run sampled so; not-a-number beyond its end.
void compare_times(const History& history, const Sampling& sampling, const Trajectory& trajectory, double* values);

} // namespace steplap::study
