// Time histories of single frictions over an event, for those that models of several planes share (shared_friction.h).
#pragma once

#include "mbd/simulation/run_record.h"
#include "tools/assess/driven_model.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// A coulomb_stick over an event, from the event's begin on.
struct FrictionTrace {
  double step = 0.0;                 ///< s
  std::vector<double> force, normal; ///< N, as the element's channels have them
  std::vector<char> sticks;          ///< it holds: `force` is what the machine asks of it
  double mu_static = 0.0, mu_kinetic = 0.0;
  bool lifts = false; ///< one of its contacts opened
};

/// Step of the traces of an event, s: samples of the record are among its times unless they are closer than 0.5 ms.
[[nodiscard]] double trace_step(const DriveHistory& history);
/// Patterns of the channels that traces of these elements are made of.
[[nodiscard]] std::vector<std::string> traced_channels(const std::vector<std::string>& elements);
/// Traces of `elements` of a run that sampled these channels every trace_step() from `begin` on. `whole`: its completed model.
[[nodiscard]] std::vector<FrictionTrace> friction_traces(const Model& whole, const System& system, const RunResult& result,
                                                         const std::vector<std::string>& elements, double begin, double step);

} // namespace steplap::assess
