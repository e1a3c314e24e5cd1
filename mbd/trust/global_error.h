// The global error of a run, estimated from finer ones: of every number that comes out of it.
//
// An adaptive method is run again at a hundredth of its tolerance, a fixed-step method with half its step and with a
// quarter. A finer run's own error is a small part of the first's (a hundredth where errors follow the tolerance; of
// fixed steps a half and a quarter, as of a method of order 1: an event lies anywhere in a step, and across events no
// method of higher order keeps its 2⁻ᵖ), so what they differ by is the error of the first up to that part, which is
// added: difference / (1 − part). Half as much again is added to that, for no error follows its rule exactly; not for
// rk4, which order 1 does enough wrong. Of several differences the largest counts, for one may be small by chance.
// Stretches that time stepping goes over in storms of events are halved, too, and count as of order 1.
//
// Steps are cut by more than tolerance or step: by breakpoints, harmonics, slips that end. A finer run divides these steps,
// too (IntegratorSettings::division), or it would take the same ones, and their difference would be zero. Of fixed steps the
// part is that of the steps taken, if it is larger than that of the steps asked for. A finer run whose part is beyond nine
// tenths, or that took no more steps than the run, is no estimate; without another one all errors are unknown.
//
// To this comes what the finer runs themselves do not know: their tolerance, of the largest range of channels in the
// same unit; rounding; the resolution of located extremes and what slips that nobody knows the way of add to them
// (mbd/simulation/extremes.h); the step, of times that a method without located events tells. What is the same throughout both runs, and in both, is exact.
//
// The time of an extreme is *a* time at which it was reached: where another peak comes within the error, it may be that.
//
// A number that only one of the runs has (an event without partner, a channel that had no value in one of them) has an
// unknown error: not-a-number, never a small one; so has the extreme of a reaction that diverges at a singular position, and a
// number without a unit beside its pole (1e9). Not seen: an error that all runs share.
#pragma once

#include "mbd/trust/run_comparison.h"

#include <limits>

namespace steplap {

inline constexpr double k_unknown_error =
    std::numeric_limits<double>::quiet_NaN(); ///< Stands for an error that is not known: not-a-number.

/// Errors of what a run tells of a channel (ChannelRange), in its unit. Not-a-number: unknown.
struct ChannelError {
  double low = 0.0, high = 0.0, final = 0.0; ///< of the extremes and of the value at the end
  double t_low = 0.0, t_high = 0.0;          ///< s
  double first_above_one = 0.0;              ///< s
  double curve = 0.0;                        ///< of the samples written; of what jumps, not of those between an event and its partner
  bool is_sampled = false;                   ///< `curve` is known, since the channel was sampled

  /// Of extremes, end and samples.
  [[nodiscard]] double largest() const;
};

/// The errors of all that a run tells.
struct GlobalErrorEstimate {
  RunDifference error;                  ///< by kind, scaled as in run_comparison.h
  std::vector<ChannelError> channels;   ///< of every channel of the system, in its order
  std::vector<double> event_times;      ///< s, of every event of the run
  double dissipated = 0.0, work = 0.0;  ///< J
  std::vector<SimulationOptions> finer; ///< how the finer runs were made, the finest last
  std::string unknown_because;          ///< not empty: no difference is an estimate, and all errors are unknown
  RunResult finest;                     ///< without its samples
  RunStatistics cost;                   ///< of the finer runs together
};

/// The options of the finer runs.
[[nodiscard]] std::vector<SimulationOptions> finer_options(const System& system, const SimulationOptions& options);

/// How many times what the first run took the finer ones take together.
[[nodiscard]] double times_of_finer_runs(const System& system, const SimulationOptions& options);

/// Of a run: its evaluations times the bodies and elements that each of them goes through. The same on every computer.
[[nodiscard]] double parts_evaluated(const System& system, const RunStatistics& run);

/// The finer runs would take more evaluations than were granted.
struct EstimateTooDear : NumericalFailure {
  /// The message.
  using NumericalFailure::NumericalFailure;
};

/// `run` was made from `initial` with `options`, which ask for samples and extremes. Throws NumericalFailure if a finer
/// run cannot be finished, EstimateTooDear if all of them together take more than `most_evaluations`.
[[nodiscard]] GlobalErrorEstimate estimate_global_error(const System& system, const State& initial, const SimulationOptions& options,
                                                        const RunResult& run, const EventFilter& is_counted = {},
                                                        double most_evaluations = std::numeric_limits<double>::infinity());

/// Does the method choose its steps by the tolerance? False for fixed steps.
[[nodiscard]] bool is_adaptive(const System& system, const std::string& integrator);

/// The larger; unknown if one of them is.
[[nodiscard]] double larger_error(double a, double b);

} // namespace steplap
