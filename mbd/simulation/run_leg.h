// A leg of a run: as far as the same elements act. Steps, events between them, samples, and the account of energy and accuracy.
//
// A run without actions is one leg. Where an action is due the leg is interrupted: Simulation does what it says, and goes on with
// this leg or with one in another system.
#pragma once

#include "mbd/events/event_finder.h"
#include "mbd/events/event_storm.h"
#include "mbd/integrators/time_stepping.h"
#include "mbd/simulation/action_triggers.h"
#include "mbd/simulation/changeover.h"
#include "mbd/simulation/formula_search.h"
#include "mbd/simulation/energy_account.h"
#include "mbd/simulation/power_ledger.h"
#include "mbd/simulation/run_record.h"
#include "mbd/simulation/swallowed_check.h"

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// Steps through a leg; owns everything that changes. One object per thread.
class RunLeg {
public:
  /// The first one starts at `initial`: poses and velocities are first moved onto the constraints. `actions`: null if the model has none.
  RunLeg(const System& system, const State& initial, SimulationOptions options, ActionTriggers* actions);
  /// Goes on where `before` was interrupted, with what `change` says. Throws ElementFailure for what cannot close.
  RunLeg(RunLeg& before, const Changeover& change);
  RunLeg(const RunLeg&) = delete; // its parts refer to each other
  RunLeg& operator=(const RunLeg&) = delete;

  /// One accepted step, or up to an event and through it. False at the end, or where it is interrupted.
  bool advance();
  /// An action is due: nothing more is done before go_on(), close() or another leg.
  [[nodiscard]] bool is_interrupted() const { return is_interrupted_; }
  /// No action is due any more.
  void go_on();
  /// Its last values, where it was interrupted.
  void close(bool is_end_of_run);
  /// Asks the actions whether one is due at state(), with the events from `known` on.
  void look_for_actions(std::size_t known) { is_interrupted_ = is_action_due(known); }
  /// At the end of the run, or where an element ended it.
  [[nodiscard]] bool is_over() const { return state_.t >= options_.end || !handler_.stop_reason().empty(); }

  [[nodiscard]] const System& system() const { return system_; } ///< that it is computed in
  [[nodiscard]] const State& state() const { return state_; }    ///< at the last event or the end
  /// The state after the last step, whether or not an event ended it.
  [[nodiscard]] State current_state() const;
  /// Writes the state into `into`, which belongs to this leg's system, without allocating.
  void read_state(State& into) const;
  /// Goes on with the bodies displaced by `by` (Simulation::displace).
  void displace(const std::vector<double>& by);
  [[nodiscard]] RunRecord& record() const { return *record_; } ///< of the whole run so far
  /// Not empty if an element ended the run before its time ("'front joint' came apart").
  [[nodiscard]] const std::string& stop_reason() const { return handler_.stop_reason(); }
  /// Of this leg, without its time.
  [[nodiscard]] RunStatistics statistics() const;
  /// Of all channels, if they were asked for; complete behind close() or the end.
  [[nodiscard]] std::vector<ChannelRange> ranges() const { return extremes_ ? extremes_->ranges() : std::vector<ChannelRange>{}; }
  /// Of a run that failed: its last values, as far as they are known.
  void break_off();

private:
  void make_parts(const PowerLedger* before, const std::vector<double>& unhurt); // memory before the blows of the start
  void finish_extremes();
  void keep_growth(double t, bool is_last);
  [[nodiscard]] bool is_action_due(std::size_t known);
  [[nodiscard]] bool begin_advance();
  [[nodiscard]] bool conclude_try();
  void restart(bool is_evaluated = false);
  void end_run();
  void look_for_extremes(long evaluations, bool is_last);
  void sample_until(double t);
  void record_sample(double t);
  void keep_ledger(double t);
  void check_finite();
  void check_holding(double t, const std::vector<double>& watch) const;
  void pass_event(double t, const double* y, const std::vector<int>& fired, const std::vector<double>* watch_before);
  void pass_stepped();
  [[nodiscard]] bool are_joints(const std::vector<int>& slots) const;
  [[nodiscard]] bool pass_storm(double t, std::size_t known);
  void step_through_storm(const std::string& element, double end);
  void note_stepped(const State& before, const State& after, double located_within);
  void note_passed(double t0, double t1);
  [[nodiscard]] std::string owner_of(int slot) const;
  void guard_against_chatter(double t, const std::vector<int>& fired);
  void guard_against_crawl();
  [[noreturn]] void fail_infinite(double t) const;
  void refuse_time_stepping() const;
  [[nodiscard]] bool pass_step();
  [[nodiscard]] bool ends_at_peak();
  [[nodiscard]] double next_limit() const;
  [[nodiscard]] double next_motion_limit() const;
  [[nodiscard]] double next_limit_of_steps(double step) const;
  [[nodiscard]] double storm_window() const;
  [[nodiscard]] Coordinates chosen_coordinates() const;
  void approach_limit();

  // rad, of a harmonic of a load or drive in a step whose error nothing controls: of the fourth order it then takes half a wave
  // to 1e-5.
  static constexpr double k_turn_of_fixed_steps = 0.4;

  const System& system_;
  SimulationOptions options_;
  State state_;
  Dynamics dynamics_;
  EventHandler handler_;
  EventFinder finder_;
  SwallowedCheck swallowed_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<ExtremeFinder> extremes_; ///< null if they are not asked for
  std::unique_ptr<PowerLedger> ledger_;     ///< null if no channel asks for one
  std::shared_ptr<RunRecord> record_;       ///< shared with the legs before and behind
  ActionTriggers* actions_ = nullptr;       ///< of the run; null if the model has none
  const ActionGroup* group_ = nullptr;      ///< of this system; null if the model has none
  /// Null if no condition is a formula that steps may leap over.
  std::unique_ptr<FormulaSearch> formula_search_;
  bool is_interrupted_ = false; ///< some action is due
  EventStorm storm_;
  std::unique_ptr<TimeStepping> stepping_; ///< made where a storm asks for it
  std::vector<double> y_, dy_;
  std::vector<int> joints_; ///< friction elements of several dimensions that may slip
  EnergyAccount energy_;
  bool is_between_events_ = false; ///< the integrator and state_ fit each other
  double limit_ = 0.0;             ///< up to which signals are read: the last breakpoint set, or the end
  double last_event_ = -std::numeric_limits<double>::infinity();
  int events_at_once_ = 0;
  long kinks_ = 0;                  ///< of characteristics, which long tables have many of: max_events leaves them out
  long next_look_ = 0;              ///< steps at which the pace is looked at
  double last_look_ = 0.0;          ///< t at the last look
  long evaluations_behind_end_ = 0; ///< for rates at the end: no part of the motion
  RunStatistics statistics_;
};

} // namespace steplap
