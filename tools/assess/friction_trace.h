// Time histories of single friction elements during an event, for frictions shared by models of two planes (shared_friction.h).
#pragma once

#include "mbd/simulation/run_record.h"
#include "tools/assess/driven_model.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// A coulomb_stick during an event, from the begin of the event.
struct FrictionTrace {
  double step = 0.0;                 ///< s
  std::vector<double> force, normal; ///< N, as in the channels of the element
  std::vector<char> sticks;          ///< true while it sticks; `force` is then the force required for sticking
  double mu_static = 0.0, mu_kinetic = 0.0;
  bool lifts = false; ///< true if one of its contacts opened
};

/// Returns the step of the traces of an event, s. It is chosen so that the sample times of the record are among its times, unless they are
/// closer than 0.5 ms.
[[nodiscard]] double trace_step(const DriveHistory& history);
/// Returns patterns of the channels needed for traces of these elements.
[[nodiscard]] std::vector<std::string> traced_channels(const std::vector<std::string>& elements);
/// Returns the traces of `elements` from a run that sampled these channels at every trace_step() from `begin` on. `whole` is the completed
/// model.
[[nodiscard]] std::vector<FrictionTrace> friction_traces(const Model& whole, const System& system, const RunResult& result,
                                                         const std::vector<std::string>& elements, double begin, double step);

} // namespace steplap::assess
