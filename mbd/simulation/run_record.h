// What is asked of a run, and what it leaves behind.
#pragma once

#include "mbd/events/event_handler.h"
#include "mbd/integrators/integrator.h"
#include "mbd/simulation/extremes.h"
#include "mbd/simulation/trajectory.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

struct LegMotion;

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
  bool has_growth = false;                          ///< keep how these have grown (RunResult::growth); needs has_extremes
  bool notes_motion = false;                        ///< keep RunResult::legs. Changes no other result
  std::optional<SlipTie> other_slip;                ///< at this tie of an earlier, equal run `sticks` slips first instead of `slips`
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
  long coded_stages = 0;                                       ///< evaluations made by machine code
  long storms = 0;                                             ///< stretches that time stepping went over
  double max_position_residual = 0.0;                          ///< before projection, m or rad
  double max_velocity_residual = 0.0;                          ///< the same of velocities, m/s or rad/s
  double energy_residual = 0.0;                                ///< largest |E + dissipated − work − E₀| met, J
  double energy_exchanged = 0.0;                               ///< largest change of kinetic energy, work, dissipation met at any step, J
  double energy_scale = 0.0;                                   ///< what the residual is measured against (EnergyAccount::scale), J
  double energy_worst_step = 0.0;                              ///< largest energy a step made or lost, of what its tolerance lets it
  double energy_rounding = 0.0;                                ///< below this a residual is rounding of the energies, J
  double dissipated = 0.0, work = 0.0;                         ///< J
  std::optional<double> passed_pulse;        ///< s: where time stepping passed over a part of a load that is far shorter than its step
  Integrator::DividedSteps divided_steps;    ///< fixed steps in which bodies would have turned too far
  std::optional<double> undecided_condition; ///< s: where nobody knows whether the condition of an action was true for an instant
  double cpu_seconds = 0.0;                  ///< of this thread, samples included
};

/// Extremes as they were at some time of a run, of what went before.
struct ExtremesSoFar {
  double t = 0.0;                               ///< s
  std::vector<std::pair<double, double>> range; ///< per channel: least and largest value; not-a-number: none yet
};

/// What a run leaves behind. Channels in it belong to the system, which has to outlive it.
struct RunResult {
  std::unique_ptr<Trajectory> trajectory; ///< the samples; never nullptr
  std::vector<ChannelRange> ranges;       ///< of every channel of the system, if they were asked for
  std::vector<ExtremesSoFar> growth;      ///< of these, at some tens of times spread over the run, if that was asked for
  std::vector<Event> events;              ///< ascending in time
  std::vector<SlipTie> ties;              ///< ascending in time, at most RunRecord::k_most_ties
  RunStatistics statistics;               ///< what it took, and how exact it was
  State final_state;                      ///< at the end, or where the run stopped
  std::string stop_reason;                ///< empty if it ran to its end; else which element ended it, and why
  std::string ended_by;                   ///< name of the action that ended it as the model says; empty: none
  /// How each leg of the run moved (leg_motion.h); null if that was not asked for.
  std::shared_ptr<const std::vector<LegMotion>> legs;
};

/// What all parts of a run add to.
struct RunRecord {
  std::unique_ptr<Trajectory> trajectory; ///< never nullptr
  std::vector<Event> events;              ///< ascending in time
  std::vector<SlipTie> ties;              ///< the first k_most_ties
  static constexpr std::size_t k_most_ties = 1000;
  std::vector<ExtremesSoFar> growth; ///< ascending in time; extremes of a leg count from its beginning
  double growth_step = 0.0;          ///< s, least between two of them; 0: none was kept yet
  long samples = 0;                  ///< taken so far
};

/// CPU time of this thread, s.
[[nodiscard]] double thread_cpu_seconds();

} // namespace steplap
