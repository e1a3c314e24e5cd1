// A run: its legs, and what happens between them.
//
// Which elements act is fixed in a compiled system. Where an action changes that, the run goes on in another system that is compiled
// from the same model (run_leg.h, changeover.h): whatever holds of a model holds of each leg.
#pragma once

#include "mbd/simulation/run_record.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap {

class ActionFollower;
class MotionNotes;
class RunLeg;

/// The options a model asks for.
[[nodiscard]] SimulationOptions options_of(const Model& model);

/// Steps through a run; owns everything that changes. One object per thread.
class Simulation {
public:
  /// Starts at `initial`: poses and velocities are first moved onto the constraints.
  Simulation(const System& system, const State& initial, SimulationOptions options);
  Simulation(const Simulation&) = delete; // its parts refer to each other
  Simulation& operator=(const Simulation&) = delete;
  ~Simulation();

  /// To options.end. Throws NumericalFailure (with the state kept in state()).
  void run();
  /// One accepted step, or up to an event and through it. False at the end.
  bool advance();

  [[nodiscard]] const State& state() const; ///< at the last event or the end; as the leg has it that the run is in
  /// The state after the last step, whether or not an event ended it.
  [[nodiscard]] State current_state() const;
  /// Goes on with the bodies displaced by `by`: (x, y, θ) of each, the ground included, along the constraints as far as a motion as small
  /// as that feels it. Modes and friction stay as they are.
  void displace(const std::vector<double>& by);
  /// Legs that ended before the present one.
  [[nodiscard]] std::size_t past_legs() const;
  /// So far, ascending in time.
  [[nodiscard]] const std::vector<Event>& events() const;
  /// The samples so far.
  [[nodiscard]] const Trajectory& trajectory() const;
  /// Not empty if an element ended the run before its time ("'front joint' came apart").
  [[nodiscard]] const std::string& stop_reason() const;
  /// So far.
  [[nodiscard]] RunStatistics statistics() const;
  /// All that the run leaves behind; of a run that ended or that failed. The Simulation is used up.
  [[nodiscard]] RunResult result() &&;

private:
  void note_leg();

  double cpu_start_;
  const System& system_;
  std::unique_ptr<ActionFollower> actions_; ///< null if the model has none
  std::unique_ptr<RunLeg> leg_;             ///< never nullptr
  std::unique_ptr<MotionNotes> motion_;     ///< null if nobody asked for it
};

/// Compiled, started (from equilibrium if `model` says so) and run to the end.
[[nodiscard]] RunResult simulate(const System& system, const State& initial, const SimulationOptions& options);

} // namespace steplap
