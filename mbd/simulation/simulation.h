// A run: steps, events between them, samples, and the account of energy and accuracy.
#pragma once

#include "mbd/simulation/energy_account.h"
#include "mbd/events/event_finder.h"
#include "mbd/events/event_handler.h"
#include "mbd/events/event_storm.h"
#include "mbd/simulation/extremes.h"
#include "mbd/simulation/power_ledger.h"
#include "mbd/simulation/swallowed_check.h"
#include "mbd/integrators/integrator.h"
#include "mbd/integrators/time_stepping.h"
#include "mbd/simulation/trajectory.h"

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// How a run is made. What is wrong with it is thrown as std::invalid_argument when the run begins.
struct SimulationOptions {
  double end = 1.0;                                 ///< s
  std::string integrator = "auto";                  ///< name of a method (mbd/model/method.h)
  IntegratorSettings settings;                      ///< step, tolerance and the like, of the method
  Coordinates coordinates = Coordinates::automatic; ///< moreau: always absolute
  StageCode stage_code = StageCode::when_it_pays;   ///< of explicit methods
  std::size_t kept_layouts = 0;                     ///< at a time (layout_store.h); 0: as memory allows. Changes no result
  double output_step = 0.0;                         ///< s; 0: no samples
  std::vector<std::string> channels;                ///< patterns of those sampled; empty: all
  bool has_extremes = false;                        ///< look for the extremes of all channels, sampled or not
  double storm_step = 1e-2;                         ///< of time stepping through a storm of events, in shares of its window
  long storm_parts = 10000;                         ///< into which these are halved at most: events are the cheaper then
  long max_events = 100000;                         ///< beyond which the run is given up
  std::function<void(double t)> progress;           ///< called now and then, if given
};

/// The options a model asks for.
[[nodiscard]] SimulationOptions options_of(const Model& model);

/// What a run took and how exact it was.
struct RunStatistics {
  long steps = 0, rejections = 0, evaluations = 0, events = 0; ///< steps that counted, tries refused, evaluations of all forces, events
  long coded_stages = 0;               ///< evaluations made by machine code
  long storms = 0;                     ///< stretches that time stepping went over
  double max_position_residual = 0.0;  ///< before projection, m or rad
  double max_velocity_residual = 0.0; ///< the same of velocities, m/s or rad/s
  double energy_residual = 0.0;        ///< largest |E + dissipated − work − E₀| met, J
  double energy_exchanged = 0.0;       ///< largest change of kinetic energy, work, dissipation met at any step, J
  double energy_scale = 0.0;           ///< what the residual is measured against (EnergyAccount::scale), J
  double energy_worst_step = 0.0;      ///< largest energy a step made or lost, of what its tolerance lets it
  double energy_rounding = 0.0;        ///< below this a residual is rounding of the energies, J
  double dissipated = 0.0, work = 0.0; ///< J
  std::optional<double> passed_pulse;  ///< s: where time stepping passed over a part of a load that is far shorter than its step
  double cpu_seconds = 0.0;            ///< of this thread, samples included
};

/// What a run leaves behind. Channels in it belong to the system, which has to outlive it.
struct RunResult {
  std::unique_ptr<Trajectory> trajectory; ///< the samples; never nullptr
  std::vector<ChannelRange> ranges;       ///< of every channel of the system, if they were asked for
  std::vector<Event> events;              ///< ascending in time
  RunStatistics statistics;               ///< what it took, and how exact it was
  State final_state;                      ///< at the end, or where the run stopped
  std::string stop_reason;                ///< empty if it ran to its end; else which element ended it, and why
};

/// Steps through a run; owns everything that changes. One object per thread.
class Simulation {
public:
  /// Starts at `initial`: poses and velocities are first moved onto the constraints.
  Simulation(const System& system, const State& initial, SimulationOptions options);
  Simulation(const Simulation&) = delete; // its parts refer to each other
  Simulation& operator=(const Simulation&) = delete;

  /// To options.end. Throws NumericalFailure (with the state kept in state()).
  void run();
  /// One accepted step, or up to an event and through it. False at the end.
  bool advance();

  [[nodiscard]] const State& state() const { return state_; } ///< at the last event or the end
  /// The state after the last step, whether or not an event ended it.
  [[nodiscard]] State current_state() const;
  /// So far, ascending in time.
  [[nodiscard]] const std::vector<Event>& events() const { return events_; }
  /// The samples so far.
  [[nodiscard]] const Trajectory& trajectory() const { return *trajectory_; }
  /// Not empty if an element ended the run before its time ("'front joint' came apart").
  [[nodiscard]] const std::string& stop_reason() const { return handler_.stop_reason(); }
  /// So far.
  [[nodiscard]] RunStatistics statistics() const;
  /// All that the run leaves behind; of a run that ended or that failed. The Simulation is used up.
  [[nodiscard]] RunResult result() &&;

private:
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
  void pass_event(double t, const double* y, const std::vector<int>& fired);
  void pass_stepped();
  [[nodiscard]] bool are_joints(const std::vector<int>& slots) const;
  void step_through_storm(const std::string& element, double end);
  void note_passed(double t0, double t1);
  [[nodiscard]] std::string owner_of(int slot) const;
  void guard_against_chatter(double t, const std::vector<int>& fired);
  void guard_against_crawl();
  [[noreturn]] void fail_infinite(double t) const;
  void refuse_time_stepping() const;
  [[nodiscard]] bool is_over() const { return state_.t >= options_.end || !handler_.stop_reason().empty(); }
  [[nodiscard]] bool pass_step();
  [[nodiscard]] double next_limit() const;
  [[nodiscard]] double next_motion_limit() const;
  [[nodiscard]] double next_limit_of_steps(double step) const;
  [[nodiscard]] double storm_window() const;
  [[nodiscard]] Coordinates chosen_coordinates() const;
  void approach_limit();

  const System& system_;
  SimulationOptions options_;
  State state_;
  Dynamics dynamics_;
  EventHandler handler_;
  EventFinder finder_;
  SwallowedCheck swallowed_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<Trajectory> trajectory_;
  std::unique_ptr<ExtremeFinder> extremes_; ///< null if they are not asked for
  std::unique_ptr<PowerLedger> ledger_;     ///< null if no channel asks for one
  std::vector<Event> events_;
  EventStorm storm_;
  std::unique_ptr<TimeStepping> stepping_; ///< made where a storm asks for it
  std::vector<double> y_, dy_;
  std::vector<int> joints_; ///< friction elements of several dimensions that may slip
  long sample_ = 0;
  EnergyAccount energy_;
  bool is_between_events_ = false; ///< the integrator and state_ fit each other
  double limit_ = 0.0;             ///< up to which signals are read: the last breakpoint set, or the end
  double last_event_ = -std::numeric_limits<double>::infinity();
  int events_at_once_ = 0;
  long kinks_ = 0;         ///< of characteristics, which long tables have many of: max_events leaves them out
  long next_look_ = 0;     ///< steps at which the pace is looked at
  double last_look_ = 0.0; ///< t at the last look
  RunStatistics statistics_;
  double cpu_start_ = 0.0;
};

/// Compiled, started (from equilibrium if `model` says so) and run to the end.
[[nodiscard]] RunResult simulate(const System& system, const State& initial,
                                 const SimulationOptions& options);

/// CPU time of this thread, s.
[[nodiscard]] double thread_cpu_seconds();

} // namespace steplap
