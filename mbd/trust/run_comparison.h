// Difference between two runs of one system, in positions, velocities, reactions and event times.
//
// The error of a channel is its largest difference over the samples, divided by its range in the reference. The range is that of the whole
// run if extremes were located, else that of the samples.
// - If a channel hardly moves, the divisor is a thousandth of the largest range of its kind, so that rounding does not appear as an error.
//   For this, angles are converted to lengths, and torques to forces, at the largest radius of gyration.
// - If nothing of a kind moves, the largest value replaces the range.
// - If the whole range of a channel is rounding of the largest value of its kind, only larger differences count.
// - Errors of event times are divided by the duration.
//
// Reactions jump at events. A sample between an event and the same event of the other run shows the jump, not an error of the reaction.
// Such samples are left out; the error of the event time covers them.
#pragma once

#include "mbd/simulation/simulation.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

enum class ErrorKind { position, velocity, reaction, event_time };
inline constexpr std::size_t k_error_kinds = 4;
/// Returns "positions", "velocities", "reactions" or "event times".
[[nodiscard]] const char* name_of(ErrorKind kind);

struct WorstError {
  double value = 0.0; ///< scaled as described above
  std::string where;  ///< channel, or element and event
  double t = 0.0;     ///< s
};

struct RunDifference {
  std::array<WorstError, k_error_kinds> worst;
  int unmatched_events = 0;    ///< number of events that only one of the runs has
  double compared_until = 0.0; ///< time of the last sample that both have, s

  [[nodiscard]] const WorstError& of(ErrorKind kind) const { return worst[static_cast<std::size_t>(kind)]; }
  /// Returns the largest error over all kinds, event times included.
  [[nodiscard]] double largest() const;
};

/// Function that selects the events which count in event times and in the number of unmatched events; empty: all.
using EventFilter = std::function<bool(const Event& event)>;

/// Assigns the rows of two trajectories to each other if one may have been sampled more sparsely: row i of `mine` belongs to row i · stride
/// of `theirs`. The last rows, at the ends of the runs, belong together.
class RowPairs {
public:
  /// Keeps references to both trajectories.
  RowPairs(const Trajectory& mine, const Trajectory& theirs, std::size_t stride);

  /// Returns the number of pairs.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Returns the row of `theirs` that belongs to row `mine`.
  [[nodiscard]] std::size_t theirs(std::size_t mine) const { return std::min(mine * stride_, last_); }

private:
  std::size_t stride_, size_, last_; ///< last_: row of `theirs`
};

/// Returns the difference of the two runs. Preconditions: both are of `system` and have the same channels; `run` has samples at every
/// stride-th sample time of `reference`.
[[nodiscard]] RunDifference compare_runs(const System& system, const RunResult& run, const RunResult& reference,
                                         const EventFilter& is_counted = {}, std::size_t stride = 1);

/// Returns the time, s, of the first sample at which a position differs by more than the fraction `share` of its range, scaled as in
/// compare_runs(); nothing if there is none.
[[nodiscard]] std::optional<double> parts_at(const System& system, const RunResult& run, const RunResult& reference, std::size_t stride,
                                             double share);

} // namespace steplap
