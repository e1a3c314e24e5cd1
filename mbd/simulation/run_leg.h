// A leg of a run: the interval during which the same elements are active, with its steps, events, samples, energy account and accuracy.
//
// A run without actions has one leg. When an action is due the leg is interrupted; Simulation executes the action and continues with this
// leg, or with one in another system.
#pragma once

#include "mbd/events/event_finder.h"
#include "mbd/events/event_handler.h"
#include "mbd/events/event_storm.h"
#include "mbd/integrators/time_stepping.h"
#include "mbd/simulation/action_triggers.h"
#include "mbd/simulation/changeover.h"
#include "mbd/simulation/energy_account.h"
#include "mbd/simulation/extremes.h"
#include "mbd/simulation/formula_search.h"
#include "mbd/simulation/power_ledger.h"
#include "mbd/simulation/run_record.h"
#include "mbd/simulation/swallowed_check.h"

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// Computes one leg. All mutable data belong to this object; one per thread.
class RunLeg {
public:
  /// First leg of a run: starts at `initial`, projected onto the constraints. `actions`: null if the model has none.
  RunLeg(const System& system, const State& initial, SimulationOptions options, ActionTriggers* actions);
  /// Next leg of a run: continues after the interruption of `before`, with the changes in `change`. Throws ElementFailure if an activated
  /// joint or rope does not fit the pose.
  RunLeg(RunLeg& before, const Changeover& change);
  RunLeg(const RunLeg&) = delete; // members refer to each other
  RunLeg& operator=(const RunLeg&) = delete;

  /// Makes one accepted step, or a step up to an event and through it. Returns false at the end, or if the leg is interrupted.
  bool advance();
  /// Returns true if an action is due. The caller must then call go_on() or close(), or continue with another leg.
  [[nodiscard]] bool is_interrupted() const { return is_interrupted_; }
  /// Continues after an interruption. Precondition: no action is due any more.
  void go_on();
  /// Computes the final values of the leg at an interruption.
  void close(bool is_end_of_run);
  /// Sets the interruption if an action is due at state(), given the events from index `known` on.
  void interrupt_if_action_due(std::size_t known) { is_interrupted_ = is_action_due(known); }
  /// Returns true at the end of the run, or after an element has ended the run.
  [[nodiscard]] bool is_over() const { return state_.t >= options_.end || !handler_.stop_reason().empty(); }

  [[nodiscard]] const System& system() const { return system_; } ///< system in which the leg is computed
  [[nodiscard]] const State& state() const { return state_; }    ///< state at the last event or the end
  /// Returns the state after the last step, whether or not an event ended it.
  [[nodiscard]] State current_state() const;
  /// Writes the state to `into`, a state of this leg's system, without allocating.
  void read_state(State& into) const;
  /// Continues with the bodies displaced by `by` (Simulation::displace).
  void displace(const std::vector<double>& by);
  [[nodiscard]] RunRecord& record() const { return *record_; } ///< record of the whole run so far
  /// Returns why an element ended the run ("'front joint' came apart"); empty if none did.
  [[nodiscard]] const std::string& stop_reason() const { return handler_.stop_reason(); }
  /// Returns the statistics of this leg; CPU time is not included.
  [[nodiscard]] RunStatistics statistics() const;
  /// Returns the ranges of all channels, if requested. To be called once, after close() or the end.
  [[nodiscard]] std::vector<ChannelRange> take_ranges() { return extremes_ ? extremes_->take_ranges() : std::vector<ChannelRange>{}; }
  /// Returns by how much contacts pressed beyond the ends of their parts in this leg (face_travel.h); empty without extremes.
  [[nodiscard]] std::vector<FaceTravel> face_travels() const { return extremes_ ? extremes_->face_travels() : std::vector<FaceTravel>{}; }
  /// Computes the final values of a failed run, as far as known.
  void break_off();

private:
  // `impacts`: State::impacts before the impacts at the start
  void project_and_set_up(const PowerLedger* before, const std::vector<Impact>& impacts);
  void finish_extremes();
  void finish_bends(double t, const std::vector<double>& end, const std::vector<double>& rates);
  void keep_growth(double t, bool is_last);
  [[nodiscard]] bool is_action_due(std::size_t known);
  [[nodiscard]] bool try_advance();
  void restart(bool is_evaluated = false);
  void end_run();
  void update_extremes(long evaluations, bool is_last);
  void sample_until(double t);
  void record_sample(double t);
  void keep_ledger(double t);
  void check_finite();
  void check_holding(double t, const std::vector<double>& event_value) const;
  void keep_ties(double t);
  void keep_blows();
  [[nodiscard]] std::vector<int> slots_of_other(double t, const std::vector<int>& fired) const;
  void pass_event(double t, const double* y, const std::vector<int>& fired, const std::vector<double>* event_value_before);
  void pass_stepped();
  [[nodiscard]] bool are_joints(const std::vector<int>& slots) const;
  [[nodiscard]] bool pass_storm(double t, std::size_t known);
  void step_through_storm(const std::string& element, double end);
  void note_stepped(const State& before, const State& after, double located_within);
  void note_passed(double t0, double t1);
  [[nodiscard]] std::string owner_of(int slot) const;
  [[nodiscard]] bool is_sliding_mode_at_end() const;
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

  // Largest angle, rad, by which a harmonic of a load or drive may turn in a step without error control. A method of order 4 then
  // integrates half a wave with an error of 1e-5.
  static constexpr double k_turn_of_fixed_steps = 0.4;

  const System& system_;
  SimulationOptions options_;
  State state_;
  Dynamics dynamics_;
  EventHandler handler_;
  EventFinder finder_;
  SwallowedCheck swallowed_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<ExtremeFinder> extremes_;           ///< null if extremes are not requested
  std::unique_ptr<PowerLedger> ledger_;               ///< null if no channel needs it
  std::shared_ptr<RunRecord> record_;                 ///< shared with the legs before and after
  ActionTriggers* actions_ = nullptr;                 ///< triggers of the run; null if the model has no actions
  const ActionGroup* group_ = nullptr;                ///< actions of this system; null if the model has none
  std::unique_ptr<FormulaPeakSearch> formula_search_; ///< null if no formula can peak within a step
  bool is_interrupted_ = false;                       ///< an action is due
  EventStorm storm_;
  std::unique_ptr<TimeStepping> stepping_; ///< created when the first storm occurs
  std::vector<double> y_, dy_;
  std::vector<int> joints_; ///< friction elements with several rows that may slip
  EnergyAccount energy_;
  bool is_between_events_ = false; ///< integrator and state_ are consistent
  double limit_ = 0.0;             ///< time up to which signals are read as left limits: the next breakpoint, or the end
  double last_event_ = -std::numeric_limits<double>::infinity();
  int events_at_once_ = 0;
  long kinks_ = 0;                   ///< kinks of force laws; not counted in max_events, since tables can have many
  long next_progress_check_ = 0;     ///< number of steps at which guard_against_crawl() checks next
  double last_progress_check_ = 0.0; ///< time of the last progress check, s
  long evaluations_behind_end_ = 0;  ///< evaluations for rates at the end, excluded from the statistics
  RunStatistics statistics_;
};

} // namespace steplap
