// The runs of one method at several settings, with what they tell of their own error: for every channel as a
// function of time, and for every event. Part of cross_check.h.
#pragma once

#include "mbd/trust/cross_check.h"

#include <array>
#include <string>
#include <vector>

namespace steplap {

/// A channel that runs are compared in.
struct ComparedChannel {
  const Channel* channel = nullptr;
  std::size_t column = 0;
  ErrorKind kind = ErrorKind::position;
  double arm = 1.0;            ///< m: makes a length of an angle
  double scale = 1.0;          ///< its range over the run, or a part of the largest range of its kind; in its own unit
  double wide_scale = 1.0;     ///< a greater part: what a motion is lost by
  int body = 0, mechanism = 0; ///< of a body's channel: bodies that act on each other have the same mechanism
  int shares = -1;             ///< of a friction's force: column that tells where it is only a share (audit.h); -1: nowhere
};

/// At the sample, is it a force that friction laws leave open?
[[nodiscard]] inline bool is_share(const ComparedChannel& channel, const Trajectory& run, std::size_t row) {
  return channel.shares >= 0 && run.value(row, static_cast<std::size_t>(channel.shares)) != 0.0;
}

/// m: the largest radius of gyration; 1 where no body has one.
[[nodiscard]] double size_of_bodies(const System& system);

/// Ranges are the middle ones of those of all runs: a single one that has gone astray does not set the scale.
[[nodiscard]] std::vector<ComparedChannel> compared_channels(const System& system, const std::vector<const RunResult*>& runs);

struct TimedEvent {
  std::string element;
  EventKind kind = EventKind::none;
  bool is_at_start = false;
  double t = 0.0;
  double shift = 0.0; ///< s: what its time is uncertain by; infinite where another setting has it not
  double alone = 0.0; ///< s: to the next change of the element, before or after: who looks coarser may see nothing of it
  double lasts = 0.0; ///< s: to the next change of the element, or the end
  bool is_counted = true;
};

class MethodCurves {
public:
  /// `levels`: coarse to fine, two or three. `step`: the finest level's, if fixed.
  MethodCurves(const std::vector<ComparedChannel>& channels, const std::vector<const RunResult*>& levels, double step, double end,
               const EventFilter& is_counted);

  [[nodiscard]] const RunResult& run() const { return *levels_.back(); }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Largest own error up to the sample, in the channel's unit.
  [[nodiscard]] double estimate(std::size_t channel, std::size_t row) const { return estimate_[channel][row]; }
  /// s: what times are uncertain by near the sample.
  [[nodiscard]] double slack(std::size_t row) const { return slack_[row]; }
  [[nodiscard]] const std::vector<TimedEvent>& events() const { return events_; }
  [[nodiscard]] double known_until() const { return known_until_; }
  /// Its energy does not balance: nothing it says is known.
  void distrust() { known_until_ = 0.0; }
  /// J that friction of the element takes from t on for so long.
  [[nodiscard]] double friction_energy(const std::string& element, double t, double span) const;
  [[nodiscard]] double step() const { return step_; }
  /// Largest own error of a kind at the end, of the channels' scales, and in which channel.
  [[nodiscard]] WorstError largest(ErrorKind kind) const;
  /// Own errors of dissipated energy and work at the end, J.
  [[nodiscard]] double dissipated_error() const { return dissipated_error_; }
  [[nodiscard]] double work_error() const { return work_error_; }

private:
  void estimate_events(const EventFilter& is_counted);
  void spread_slack(double end);
  void estimate_channels();
  void add_step_of_motion(std::size_t channel);
  void share_estimates();
  void find_known();

  const std::vector<ComparedChannel>& channels_;
  std::vector<const RunResult*> levels_;
  double step_ = 0.0;
  std::size_t rows_ = 0;
  std::vector<std::vector<double>> estimate_; ///< [channel][row]
  std::vector<double> slack_;
  std::vector<TimedEvent> events_;
  double known_until_ = 0.0, dissipated_error_ = 0.0, work_error_ = 0.0;
};

/// |x − y| at the sample, or the distance of the two graphs within `slack` seconds; for a reaction also within a
/// sample.
[[nodiscard]] double distance_at(const ComparedChannel& channel, const Trajectory& x, const Trajectory& y, std::size_t row, double slack);

/// What is left of the error in the last of the levels, from the largest differences of neighbours.
[[nodiscard]] double extrapolated_error(const std::vector<double>& differences);

} // namespace steplap
