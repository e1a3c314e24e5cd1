// The global error of a run, estimated from a second, finer one.
//
// An adaptive method is run again at a hundredth of its tolerance, a fixed-step method with half
// its step. The second run's own error is a small part of the first's (a hundredth where errors
// follow the tolerance, 2⁻ᵖ for a method of order p), so the difference of the two is the error of
// the first, up to that part, which is added: difference / (1 − part). Where the run is at the
// limit of rounding, the second is no better than the first, and the difference tells only how
// large rounding is.
//
// Not seen: an error that both runs share. A motion that depends on its start without bound (an
// unstable rest, chaos) shows as a large difference, as it should; events that one run has and the
// other has not are counted.
#pragma once

#include "mbd/run_comparison.h"

namespace steplap {

struct GlobalErrorEstimate {
  RunDifference error;     ///< scaled as in run_comparison.h
  SimulationOptions finer; ///< how the second run was made
  RunStatistics cost;      ///< of the second run
};

/// The options of the second run.
[[nodiscard]] SimulationOptions finer_options(const System& system,
                                              const SimulationOptions& options);

/// `run` was made from `initial` with `options`, which ask for samples. Throws NumericalFailure if
/// the second run cannot be finished.
[[nodiscard]] GlobalErrorEstimate estimate_global_error(const System& system, const State& initial,
                                                        const SimulationOptions& options,
                                                        const RunResult& run,
                                                        const EventFilter& is_counted = {});

/// Does the method choose its steps by the tolerance? False for fixed steps.
[[nodiscard]] bool is_adaptive(const System& system, const std::string& integrator);

} // namespace steplap
