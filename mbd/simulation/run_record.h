// Options and results of a run.
#pragma once

#include "mbd/events/event.h"
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

/// Options of a run. Invalid ones are reported by std::invalid_argument at its start.
struct SimulationOptions {
  double end = 1.0;                                 ///< s
  std::string integrator = "auto";                  ///< name of a method (mbd/model/method.h)
  IntegratorSettings settings;                      ///< settings of the method: step, tolerance and others
  Coordinates coordinates = Coordinates::automatic; ///< moreau: always absolute
  StageCode stage_code = StageCode::when_it_pays;   ///< for explicit methods
  std::size_t kept_layouts = 0;                     ///< largest number of cached layouts (layout_store.h); 0: by memory. Does not affect
                                                    ///< results
  double output_step = 0.0;                         ///< s; 0: no samples
  std::vector<std::string> channels;                ///< patterns of the channels to be sampled; empty: all
  bool has_extremes = false;                        ///< compute the extremes of all channels, sampled or not
  bool has_growth = false;                          ///< record the extremes so far at several times (RunResult::growth); needs has_extremes
  bool notes_motion = false;                        ///< keep RunResult::legs. Changes no other result
  std::optional<SimultaneousSlip> other_slip;       ///< at this tie of an earlier, equal run `sticks` slips first instead of `slips`
  double storm_step = 1e-2;                         ///< step of time stepping through a storm of events, as a share of its window
  long storm_parts = 10000;                         ///< extra parts by halving such steps; beyond them, locating the events is cheaper
  long max_events = 100000;                         ///< a run with more events is aborted
  std::function<void(double t)> progress;           ///< called from time to time, if given
};

/// Returns the options given in a model.
[[nodiscard]] SimulationOptions options_of(const Model& model);

/// Effort and accuracy of a run.
struct RunStatistics {
  long steps = 0, rejections = 0, evaluations = 0, events = 0; ///< accepted steps, rejected tries, evaluations of all forces, events
  long coded_stages = 0;                                       ///< evaluations made by machine code
  long storms = 0;                                             ///< intervals of time stepping through storms of events
  double max_position_residual = 0.0;                          ///< before projection, m or rad
  double max_velocity_residual = 0.0;                          ///< before projection, m/s or rad/s
  double energy_residual = 0.0;                                ///< largest |E + dissipated − work − E₀| met, J
  double energy_exchanged = 0.0;                               ///< largest change of kinetic energy, work or dissipation at any step, J
  double energy_scale = 0.0;                                   ///< energy relative to which the residual is judged (EnergyAccount::scale),
                                                               ///< J
  double energy_worst_step = 0.0;                              ///< largest energy error of a step relative to its bound
  double energy_rounding = 0.0;                                ///< rounding error of the energies, J
  double dissipated = 0.0, work = 0.0;                         ///< J
  std::optional<double> passed_pulse;        ///< time, s, at which time stepping passed over part of a load much shorter than its step
  Integrator::DividedSteps divided_steps;    ///< fixed steps that were divided because bodies would have turned too far
  double rounded_tolerance = 0.0;            ///< relative local error of steps where rounding is larger than the tolerance; 0: nowhere
  std::optional<double> undecided_condition; ///< time, s, at which it is unknown whether the condition of an action was briefly true
  double cpu_seconds = 0.0;                  ///< CPU time of this thread, including samples
};

/// Extremes up to some time of a run.
struct ExtremesSoFar {
  double t = 0.0;                               ///< s
  std::vector<std::pair<double, double>> range; ///< per channel: minimum and maximum; NaN: none yet
};

/// Results of a run. Its channels belong to the system, which must outlive it.
struct RunResult {
  std::unique_ptr<Trajectory> trajectory; ///< samples; not null
  std::vector<ChannelRange> ranges;       ///< for every channel of the system, if requested
  /// How far contacts pressed beyond the ends of their parts, leg by leg; with the ranges.
  std::vector<FaceTravel> face_travels;
  std::vector<ExtremesSoFar> growth;  ///< extremes so far, at some tens of times spread over the run, if requested
  std::vector<Event> events;          ///< ascending in time
  std::vector<RigidBlow> blows;       ///< ascending in time; an action that closed joints stands for these
  std::vector<SimultaneousSlip> ties; ///< ascending in time, at most RunRecord::k_most_ties
  RunStatistics statistics;           ///< effort and accuracy
  State final_state;                  ///< at the end, or where the run stopped
  std::string stop_reason;            ///< reason why an element ended the run early; empty if it reached its end
  std::string ended_by;               ///< name of the action that ended the run; empty: none
  /// Motion of each leg (leg_motion.h); null if not requested.
  std::shared_ptr<const std::vector<LegMotion>> legs;
};

/// Record to which all legs of a run contribute.
struct RunRecord {
  std::unique_ptr<Trajectory> trajectory;          ///< never nullptr
  std::vector<Event> events;                       ///< ascending in time
  std::vector<RigidBlow> blows;                    ///< ascending in time
  std::vector<SimultaneousSlip> ties;              ///< the first k_most_ties
  static constexpr std::size_t k_most_ties = 1000; ///< ties kept
  std::vector<ExtremesSoFar> growth;               ///< ascending in time; extremes of a leg count from its beginning
  double growth_step = 0.0;                        ///< s, smallest interval between two entries; 0: no entry yet
  long samples = 0;                                ///< taken so far
};

/// Returns the CPU time of this thread, s.
[[nodiscard]] double thread_cpu_seconds();

} // namespace steplap
