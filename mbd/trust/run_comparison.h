// How far two runs of one system lie apart: positions, velocities, reactions, event times.
//
// A channel's error is its largest difference over the samples, divided by its range in the
// reference: over the whole run where its extremes were looked for, over the samples else; a channel that hardly moves is divided by a thousandth of the largest range of its
// kind instead, so that rounding in it does not pass for an error; for this, angles count as
// lengths and couples as forces at the largest radius of gyration. Where nothing of a kind moves,
// as at rest, the size of the largest value takes the place of the range. What a channel does whose whole range is rounding of
// the largest value of its kind counts only where it differs by more than that. Event times are divided by the duration.
//
// Reactions jump at events. A sample that lies between an event and the same event of the other run
// shows the jump, not an error of the reaction: such samples are left out there, the time of the
// event tells the same.
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
/// "positions", "velocities", "reactions", "event times".
[[nodiscard]] const char* name_of(ErrorKind kind);

struct WorstError {
  double value = 0.0; ///< scaled, see above
  std::string where;  ///< channel, or element and event
  double t = 0.0;     ///< s
};

struct RunDifference {
  std::array<WorstError, k_error_kinds> worst;
  int unmatched_events = 0;    ///< those that one run has and the other has not
  double compared_until = 0.0; ///< s: the last sample both have

  [[nodiscard]] const WorstError& of(ErrorKind kind) const { return worst[static_cast<std::size_t>(kind)]; }
  /// Of all kinds, event times included.
  [[nodiscard]] double largest() const;
};

/// Which events count as such in event times and their number; empty: all.
using EventFilter = std::function<bool(const Event& event)>;

/// Pairs the rows of two runs of which one may have been sampled more sparsely: each row of `mine` belongs to every `stride`-th of
/// `theirs`; the last rows, at the ends of both runs, belong together.
class RowPairs {
public:
  /// Both trajectories have to outlive it.
  RowPairs(const Trajectory& mine, const Trajectory& theirs, std::size_t stride);

  /// How many pairs there are.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The row of `theirs` that belongs to a row of `mine`.
  [[nodiscard]] std::size_t theirs(std::size_t mine) const { return std::min(mine * stride_, last_); }

private:
  std::size_t stride_, size_, last_; ///< last_: row of `theirs`
};

/// Both runs are of `system`, with the same channels; `run` was sampled at every `stride`-th of the times of `reference`.
[[nodiscard]] RunDifference compare_runs(const System& system, const RunResult& run, const RunResult& reference,
                                         const EventFilter& is_counted = {}, std::size_t stride = 1);

/// Time of the first sample, s, at which a position differs by more than `share` of its range, as compare_runs() scales it; empty if none
/// does.
[[nodiscard]] std::optional<double> parts_at(const System& system, const RunResult& run, const RunResult& reference, std::size_t stride,
                                             double share);

} // namespace steplap
