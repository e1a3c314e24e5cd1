// Options and results of a run.
#pragma once

#include "mbd/dynamics/evaluation_choices.h"
#include "mbd/events/event.h"
#include "mbd/integrators/integrator_settings.h"
#include "mbd/simulation/channel_range.h"
#include "mbd/simulation/face_travel.h"
#include "mbd/simulation/trajectory.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

struct LegMotion;

/// Options of a run. The run reports invalid ones by std::invalid_argument when it starts.
struct SimulationOptions {
  double end = 1.0;                                 ///< end of the run, s
  std::string integrator = "auto";                  ///< name of a method (mbd/model/method.h)
  IntegratorSettings settings;                      ///< settings of the method: step, tolerance and others
  Coordinates coordinates = Coordinates::automatic; ///< coordinates of the motion; moreau always uses absolute ones
  StageCode stage_code = StageCode::when_it_pays;   ///< compiled stages for explicit methods
  std::size_t kept_layouts = 0;               ///< largest number of cached layouts (layout_store.h); 0: by memory. Does not affect results
  double output_step = 0.0;                   ///< sampling interval, s; 0: no samples
  std::vector<std::string> channels;          ///< patterns of the channels to be sampled; empty: all
  bool has_extremes = false;                  ///< compute the extremes of all channels, sampled or not
  bool has_growth = false;                    ///< record the extremes so far at several times (RunResult::growth); needs has_extremes
  bool notes_motion = false;                  ///< record RunResult::legs; does not change other results
  std::optional<SimultaneousSlip> other_slip; ///< at this tie of an earlier equal run, `sticks` slips first instead of `slips`
  double storm_step = 1e-2;                   ///< step of time stepping in an event storm, relative to the storm window
  long storm_parts = 10000; ///< parts added by halving such steps, above which time stepping ends, because locating the events is cheaper
  long max_events = 100000; ///< a run with more events is aborted
  std::function<void(double t)> progress; ///< called repeatedly with the time reached, s, if given
};

/// Returns the options given in a model.
[[nodiscard]] SimulationOptions options_of(const Model& model);

/// Effort and accuracy of a run.
struct RunStatistics {
  long steps = 0, rejections = 0, evaluations = 0, events = 0; ///< accepted steps, rejected attempts, evaluations of all forces, events
  long coded_stages = 0;                                       ///< evaluations by generated machine code
  long storms = 0;                                             ///< intervals of time stepping through storms of events
  double max_position_residual = 0.0;                          ///< largest position error of joints before projection, m or rad
  double max_velocity_residual = 0.0;                          ///< largest velocity error of joints before projection, m/s or rad/s
  double energy_residual = 0.0;                                ///< largest |E + dissipated − work − E₀|, J
  double energy_exchanged = 0.0;                               ///< largest change of kinetic energy, work or dissipation at any step, J
  double energy_scale = 0.0;                                   ///< energy to which the residual is compared (EnergyAccount::scale), J
  double energy_worst_step = 0.0;                              ///< largest energy error of a step relative to its bound
  double energy_rounding = 0.0;                                ///< rounding error of the energies, J
  double dissipated = 0.0, work = 0.0;                         ///< dissipated energy and work, J
  std::optional<double> passed_pulse;        ///< time, s, at which time stepping averaged a load much shorter than its step; empty: none
  DividedSteps divided_steps;                ///< fixed steps that were divided because of large rotations
  double rounded_tolerance = 0.0;            ///< relative local error of steps where rounding is larger than the tolerance; 0: nowhere
  std::optional<double> undecided_condition; ///< time, s, at which the condition of an action may have been true for a moment; empty: none
  double cpu_seconds = 0.0;                  ///< CPU time of this thread, s, including samples
};

/// Extremes of all channels up to some time of a run.
struct ExtremesSoFar {
  double t = 0.0;                               ///< time, s
  std::vector<std::pair<double, double>> range; ///< per channel: minimum and maximum; NaN: none yet
};

/// Results of a run. Its channels belong to the system, which must outlive it.
struct RunResult {
  std::unique_ptr<Trajectory> trajectory; ///< samples; not null
  std::vector<ChannelRange> ranges;       ///< for every channel of the system, if requested
  /// Distances by which contacts pressed beyond the ends of their parts, leg by leg; empty without extremes.
  std::vector<FaceTravel> face_travels;
  std::vector<ExtremesSoFar> growth;  ///< extremes up to some tens of times distributed over the run, if requested
  std::vector<Event> events;          ///< ascending in time
  std::vector<RigidImpact> blows;     ///< ascending in time; an action that activated joints is named instead of the joints
  std::vector<SimultaneousSlip> ties; ///< ascending in time, at most RunRecord::k_most_ties
  RunStatistics statistics;           ///< effort and accuracy
  State final_state;                  ///< state at the end, or where the run stopped
  std::string stop_reason;            ///< reason why an element ended the run early; empty if none did
  std::string ended_by;               ///< name of the action that ended the run; empty: none
  /// Motion of each leg (leg_motion.h); null if not requested.
  std::shared_ptr<const std::vector<LegMotion>> legs;
};

/// Data to which all legs of a run contribute.
struct RunRecord {
  std::unique_ptr<Trajectory> trajectory;          ///< never nullptr
  std::vector<Event> events;                       ///< ascending in time
  std::vector<RigidImpact> blows;                  ///< ascending in time
  std::vector<SimultaneousSlip> ties;              ///< the first k_most_ties simultaneous slips
  static constexpr std::size_t k_most_ties = 1000; ///< largest number of simultaneous slips kept
  std::vector<ExtremesSoFar> growth;               ///< ascending in time; each entry covers its leg from the start of the leg
  double growth_step = 0.0;                        ///< smallest interval between two entries, s; 0: no entry yet
  long samples = 0;                                ///< number of sampling times so far
};

/// Returns the CPU time of this thread, s.
[[nodiscard]] double thread_cpu_seconds();

} // namespace steplap
