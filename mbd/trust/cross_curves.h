// Runs of one method at several settings, and the error estimates that follow from their differences: for every channel as a function of
// time, and for every event. Part of cross_check.h.
#pragma once

#include "mbd/trust/cross_check.h"

#include <array>
#include <string>
#include <vector>

namespace steplap {

/// A channel in which runs are compared.
struct ComparedChannel {
  const Channel* channel = nullptr;
  std::size_t column = 0;
  ErrorKind kind = ErrorKind::position;
  double arm = 1.0;            ///< factor from angles to lengths, m
  double scale = 1.0;          ///< range over the run, or a part of the largest range of its kind; unit of the channel
  double wide_scale = 1.0;     ///< larger scale: if the error reaches it, the motion is not known at all
  int body = 0, mechanism = 0; ///< body of the channel, and number of its mechanism; bodies that act on each other belong to one mechanism
  int shares = -1;             ///< column that is 1 where a friction force is not unique (audit.h, "shares"); −1: none
};

/// Returns true if the channel is a friction force that the laws of friction leave undetermined at this sample.
[[nodiscard]] inline bool is_share(const ComparedChannel& channel, const Trajectory& run, std::size_t row) {
  return channel.shares >= 0 && run.value(row, static_cast<std::size_t>(channel.shares)) != 0.0;
}

/// Returns the largest radius of gyration, m; 1 if no body has one.
[[nodiscard]] double size_of_bodies(const System& system);

/// Returns the channels to compare. Ranges are medians over all runs, so that one wrong run does not set the scale.
[[nodiscard]] std::vector<ComparedChannel> compared_channels(const System& system, const std::vector<const RunResult*>& runs);

struct TimedEvent {
  std::string element;
  EventKind kind = EventKind::none;
  bool is_at_start = false;
  double t = 0.0;
  double shift = 0.0; ///< uncertainty of the event's time, s; infinite if another setting lacks the event
  double alone = 0.0; ///< time to the nearest other event of the element, s; a method with longer steps may miss both events
  double lasts = 0.0; ///< time to the next event of the element or to the end, s
  bool is_counted = true;
};

class MethodCurves {
public:
  /// `levels`: two or three runs of the method, from coarse to fine. `step`: step of the finest run if it is fixed, else 0.
  MethodCurves(const std::vector<ComparedChannel>& channels, const std::vector<const RunResult*>& levels, double step, double end,
               const EventFilter& is_counted);

  [[nodiscard]] const RunResult& run() const { return *levels_.back(); }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Returns the largest estimated error of the finest run up to this sample, in the channel's unit.
  [[nodiscard]] double estimate(std::size_t channel, std::size_t row) const { return estimate_[channel][row]; }
  /// Returns the uncertainty of event times near this sample, s.
  [[nodiscard]] double slack(std::size_t row) const { return slack_[row]; }
  [[nodiscard]] const std::vector<TimedEvent>& events() const { return events_; }
  [[nodiscard]] double known_until() const { return known_until_; }
  /// Sets the time until which the run is known to zero, because its energy does not balance.
  void distrust() { known_until_ = 0.0; }
  /// Returns the energy that friction of the element dissipates from t to t + span, J.
  [[nodiscard]] double friction_energy(const std::string& element, double t, double span) const;
  [[nodiscard]] double step() const { return step_; }
  /// Returns the largest estimated error of a kind at the end, relative to the channels' scales, and its channel.
  [[nodiscard]] WorstError largest(ErrorKind kind) const;
  /// Return the estimated errors of dissipated energy and of work at the end, J.
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

/// Returns the distance of two curves at a sample: |x − y|, or less if the graphs come nearer to each other within ± `slack` seconds. For
/// reactions, which jump, at least the next sample on both sides is included.
[[nodiscard]] double distance_at(const ComparedChannel& channel, const Trajectory& x, const Trajectory& y, std::size_t row, double slack);

/// Returns the estimated error of the finest run, given the largest differences of successive runs.
[[nodiscard]] double extrapolated_error(const std::vector<double>& differences);

} // namespace steplap
