#include "mbd/simulation/simulation.h"

#include "mbd/simulation/action_follower.h"
#include "mbd/simulation/leg_motion.h"

#include <algorithm>
#include <ctime>
#include <utility>

namespace steplap {

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

SimulationOptions options_of(const Model& model) {
  SimulationOptions options;
  const SimulationSettings& s = model.simulation;
  options.end = s.end;
  options.integrator = s.integrator;
  options.settings.step = s.step.value_or(0.0);
  options.settings.tolerance = std::max(s.tolerance.value_or(1e-8), k_least_run_tolerance);
  options.settings.projection_tolerance = s.projection_tolerance;
  if (s.coordinates != "automatic") options.coordinates = s.coordinates == "joint" ? Coordinates::joint : Coordinates::absolute;
  options.output_step = model.output.step;
  options.channels = model.output.channels;
  options.has_extremes = true;
  options.max_events = s.max_events;
  return options;
}

Simulation::Simulation(const System& system, const State& initial, SimulationOptions options)
    : cpu_start_(thread_cpu_seconds()), system_(system) {
  if (options.notes_motion) motion_ = std::make_unique<MotionNotes>();
  if (action_group(system)) actions_ = std::make_unique<ActionFollower>(system);
  leg_ = std::make_unique<RunLeg>(system, initial, std::move(options), actions_ ? &actions_->triggers() : nullptr);
  if (actions_) {
    leg_->interrupt_if_action_due(0);
    if (leg_->is_interrupted()) actions_->act(leg_);
  }
  if (motion_) note_leg();
}

Simulation::~Simulation() = default;

void Simulation::run() {
  while (advance()) {}
}

bool Simulation::advance() {
  if (actions_ && !actions_->ended_by().empty()) return false;
  const bool goes_on = leg_->advance();
  if (motion_ && (motion_->wants_step() || !goes_on)) {
    leg_->read_state(motion_->scratch());
    motion_->note(motion_->scratch());
  }
  if (!leg_->is_interrupted()) return goes_on;
  const std::size_t legs = past_legs();
  actions_->act(leg_);
  if (motion_ && past_legs() > legs) note_leg();
  return actions_->ended_by().empty() && !leg_->is_over();
}

void Simulation::note_leg() {
  motion_->begin_leg(actions_ ? actions_->made_system(*leg_) : nullptr, leg_->system(), past_legs(), leg_->current_state());
}

void Simulation::displace(const std::vector<double>& by) { leg_->displace(by); }
std::size_t Simulation::past_legs() const { return actions_ ? actions_->past_legs() : 0; }

const State& Simulation::state() const { return leg_->state(); }
State Simulation::current_state() const { return leg_->current_state(); }
const std::vector<Event>& Simulation::events() const { return leg_->record().events; }
const Trajectory& Simulation::trajectory() const { return *leg_->record().trajectory; }
const std::string& Simulation::stop_reason() const { return leg_->stop_reason(); }

RunStatistics Simulation::statistics() const {
  RunStatistics s = leg_->statistics();
  if (actions_) s = actions_->add_statistics(s);
  s.cpu_seconds = thread_cpu_seconds() - cpu_start_;
  return s;
}

RunResult Simulation::result() && {
  leg_->break_off();
  RunResult result;
  result.ranges = leg_->take_ranges();
  if (actions_) result.ranges = actions_->joined_ranges(std::move(result.ranges));
  for (std::size_t c = 0; c < result.ranges.size(); ++c) result.ranges[c].channel = &system_.channels[c];
  if (actions_) result.face_travels = actions_->face_travels();
  for (FaceTravel& travel : leg_->face_travels()) result.face_travels.push_back(std::move(travel));
  result.statistics = statistics();
  result.final_state = actions_ ? actions_->in_first_system(*leg_) : leg_->state();
  result.trajectory = std::move(leg_->record().trajectory);
  result.events = std::move(leg_->record().events);
  result.ties = std::move(leg_->record().ties);
  result.blows = std::move(leg_->record().blows);
  result.growth = std::move(leg_->record().growth);
  result.stop_reason = leg_->stop_reason();
  if (actions_) result.ended_by = actions_->ended_by();
  if (motion_) result.legs = std::make_shared<const std::vector<LegMotion>>(std::move(*motion_).legs());
  return result;
}

RunResult simulate(const System& system, const State& initial, const SimulationOptions& options) {
  Simulation simulation(system, initial, options);
  simulation.run();
  return std::move(simulation).result();
}

} // namespace steplap
