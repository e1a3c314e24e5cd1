// A run, consisting of one or more legs.
//
// The active elements of a compiled system are fixed. When an action changes them, the run continues in another system compiled from the
// same model (run_leg.h, changeover.h).
#pragma once

#include "mbd/simulation/run_record.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap {

class ActionFollower;
class MotionNotes;
class RunLeg;

/// Smallest tolerance of a run. A smaller one in a model is taken as this: no finer run could tell how accurate the run is, because that needs
/// a tenth of its tolerance, and rounding permits no less.
inline constexpr double k_least_run_tolerance = 1e-13;
/// Returns the options given in a model.
[[nodiscard]] SimulationOptions options_of(const Model& model);

/// Computes a run. All mutable data belong to this object; one per thread.
class Simulation {
public:
  /// Starts at `initial`, after projecting positions and velocities onto the constraints.
  Simulation(const System& system, const State& initial, SimulationOptions options);
  Simulation(const Simulation&) = delete; // members refer to each other
  Simulation& operator=(const Simulation&) = delete;
  ~Simulation();

  /// Runs to options.end. Throws NumericalFailure; the state is then that of the last step.
  void run();
  /// Makes one accepted step, or a step up to an event and through it. Returns false at the end.
  bool advance();

  [[nodiscard]] const State& state() const; ///< state at the last event or the end, in the system of the present leg
  /// Returns the state after the last step, whether or not an event ended it.
  [[nodiscard]] State current_state() const;
  /// Displaces the bodies by `by`, (x, y, θ) for each including the ground, in m and rad, and continues from there. Displacements along the
  /// constraints must be small enough for projection. Modes and friction states are kept.
  void displace(const std::vector<double>& by);
  /// Returns the number of legs before the present one.
  [[nodiscard]] std::size_t past_legs() const;
  /// Returns the events so far, in ascending time.
  [[nodiscard]] const std::vector<Event>& events() const;
  /// Returns the samples so far.
  [[nodiscard]] const Trajectory& trajectory() const;
  /// Returns why an element ended the run early ("'front joint' came apart"); empty if none did.
  [[nodiscard]] const std::string& stop_reason() const;
  /// Returns the statistics so far.
  [[nodiscard]] RunStatistics statistics() const;
  /// Returns all results of a run that has ended or failed. The object cannot be used afterwards.
  [[nodiscard]] RunResult result() &&;

private:
  void note_leg();

  double cpu_start_;
  const System& system_;
  std::unique_ptr<ActionFollower> actions_; ///< null if the model has no actions
  std::unique_ptr<RunLeg> leg_;             ///< not null
  std::unique_ptr<MotionNotes> motion_;     ///< null if not requested
};

/// Runs from `initial` to the end and returns the results.
[[nodiscard]] RunResult simulate(const System& system, const State& initial, const SimulationOptions& options);

} // namespace steplap
