// Event storms: when the events of one element are too dense, time stepping is used for an interval.
//
// All other elements move in this interval, too. A change of mode of any element is reported as an event at the end of the part of a step
// in which the change appears. It occurred in this part or in the previous one: parts average loads, so a rising load reaches a limit half
// a part late.
#include "mbd/base/shown_text.h"
#include "mbd/model/method.h"
#include "mbd/simulation/run_leg.h"
#include "mbd/system/one_sided_row.h"

#include <algorithm>
#include <numbers>

namespace steplap {

namespace {

// Length of a storm window: relative to √(L/g) (1 ms for L = 1 m), and at most 1/1000 of the run. An element may have up to 50 events in
// each window, that is 50 000 in a run, before time stepping is used.
constexpr double k_storm_window = 1e-3 * std::numbers::pi;
constexpr double k_storm_windows = 2.0; // length of an interval of time stepping, in windows

} // namespace

// Returns the length of the storm window, s. Events are a storm if they are dense compared with all other time scales: falling bodies, the
// duration of the run, and the period of the fastest harmonic of a load or drive.
double RunLeg::storm_window() const {
  const SceneUnits& scale = system_.scale;
  const double window = k_storm_window / std::max(scale.rate, std::numbers::pi / scale.duration);
  const double fastest = system_.fastest_at(state_.t);
  return fastest > 0.0 ? std::min(window, 2.0 * std::numbers::pi / fastest) : window;
}

// Counts the events from index `known` on. If one of them completes a storm, passes an interval by time stepping and returns true.
bool RunLeg::pass_storm(double t, std::size_t known) {
  if (!method(options_.integrator).may_step_over_storms || actions_ || system_.inner_count() > 0 || first_one_sided_row(system_) ||
      !handler_.stop_reason().empty())
    return false;
  const double window = storm_window();
  for (std::size_t i = known; i < record_->events.size(); ++i) {
    if (is_kink(record_->events[i].kind) || !storm_.note(t, record_->events[i].element, window)) continue;
    const double step = options_.storm_step * window;
    const double end = std::min(next_motion_limit(), t + k_storm_windows * window);
    if (!(end - t > step)) continue;
    step_through_storm(std::string(record_->events[i].element), end);
    return true;
  }
  return false;
}

void RunLeg::note_stepped(const State& before, const State& after, double located_within) {
  const std::size_t known = record_->events.size();
  handler_.list_changes(before, after, record_->events);
  for (std::size_t i = known; i < record_->events.size(); ++i) record_->events[i].located_within = located_within;
}

// Passes the interval up to `end` by time stepping, in which modes change without locating events. The selected method continues from
// `end`.
void RunLeg::step_through_storm(const std::string& element, double end) {
  if (!stepping_) stepping_ = std::make_unique<TimeStepping>(system_);
  is_between_events_ = false;
  ++statistics_.storms;
  const double begin = state_.t;
  record_->events.push_back({begin, element, EventKind::storm, "for " + rounded_text(1e3 * (end - begin)) + " ms"});
  dynamics_.use_coordinates(Coordinates::absolute);
  dynamics_.set_left_limit_time(end);
  const double step = options_.storm_step * storm_window();
  const long parts = stepping_->extra_parts();
  const int division = options_.settings.division;
  double whole = 0.0, t_whole = begin; // length of the step being divided, s, and its end
  int part = division;
  double last = begin; // start of the previous part, s
  const auto observe = [&](const State& before, const State& after) {
    note_stepped(before, after, after.t - last);
    last = before.t;
  };
  while (state_.t < end && stepping_->extra_parts() - parts < options_.storm_parts && handler_.stop_reason().empty()) {
    const double due = static_cast<double>(record_->samples) * options_.output_step;
    if (part == division) { // next step; samples shorten it before it is divided
      part = 0;
      t_whole = std::min({end, state_.t + division * step, next_limit_of_steps(division * step)});
      if (const double fastest = system_.fastest_at(0.5 * (state_.t + t_whole)); fastest > 0.0)
        t_whole = std::min(t_whole, state_.t + k_turn_of_fixed_steps / fastest);
      if (options_.output_step > 0.0 && due > state_.t && due <= t_whole) t_whole = due;
      whole = t_whole - state_.t;
    }
    ++part;
    const double t1 = part == division ? t_whole : t_whole - (division - part) * whole / division;
    const bool is_sample = options_.output_step > 0.0 && due == t1;
    note_passed(state_.t, t1);
    stepping_->step(dynamics_, state_, t1, options_.settings.projection_tolerance, observe);
    ++statistics_.steps;
    if (!is_sample && !extremes_ && !ledger_) continue;
    dynamics_.pack(state_, y_.data());
    if (extremes_ || ledger_) dynamics_.rates(t1, y_.data(), dy_.data());
    if (ledger_) ledger_->add_stepped(t1, dynamics_.snapshot(dy_.data()));
    if (extremes_) extremes_->begin(t1, dynamics_.snapshot(dy_.data()));
    if (is_sample) record_sample(t1);
  }
  dynamics_.use_coordinates(chosen_coordinates());
  const State stepped = state_;
  handler_.settle_phases(state_);
  note_stepped(stepped, state_, state_.t - last);
  record_->events.push_back({state_.t, element, EventKind::event_storm_ends});
  storm_.clear();
  events_at_once_ = 0;
  dynamics_.set_left_limit_time(next_limit());
  restart();
  energy_.note(dynamics_, state_.t, y_.data()); // first-order steps have no energy bound, so they are not checked
}

} // namespace steplap
