#include "mbd/simulation/run_leg.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/base/stop.h"
#include "mbd/integrators/explicit_pair.h"
#include "mbd/model/method.h"
#include "mbd/simulation/arguments.h"
#include "mbd/simulation/check_sticking.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/one_sided_row.h"
#include "mbd/system/own_states.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace steplap {

namespace {

// Relative time difference up to which events count as simultaneous, and the largest number of simultaneous events. More mean that modes alternate without
// progress of the motion.
constexpr double k_same_instant = 1e-13;
constexpr int k_max_events_at_once = 60;
constexpr double k_least_rest = 1e-8; // remaining time, relative to the run, that may be passed in one step (is_sliding_mode_at_end())
constexpr long k_steps_between_checks = 1L << 16;
// Relative amount by which a sticking joint may exceed its limit. Wrenches of the mode problem are accurate to 1e-9 of the capacities, and
// events are located to rounding; a thousand times that is an error.
constexpr double k_held_beyond = 1e-6;
// Number of kinks of force laws after which a run is aborted. Kinks are harmless and cheap, but a longer list is useless.
constexpr long k_least_kinks = 1000000;
constexpr long k_kinks_per_event = 10;
constexpr double k_output_slack = 1e-9; // tolerance of sampling times, relative to the output step

} // namespace

RunLeg::RunLeg(const System& system, const State& initial, SimulationOptions options, ActionTriggers* actions)
    : system_(system), options_(checked(std::move(options), initial.t)), state_(checked(initial, system)), dynamics_(system),
      handler_(system, dynamics_), finder_(system, system.largest_dimension()), swallowed_(system), record_(std::make_shared<RunRecord>()),
      actions_(actions), group_(action_group(system)), y_(static_cast<std::size_t>(system.largest_dimension())), dy_(y_.size()) {
  if (options_.end > system.drives_end)
    throw NumericalFailure("a drive jumps at t = " + number_text(system.drives_end) + " s, before the end of the run");
  refuse_time_stepping();
  integrator_ = make_integrator(options_.integrator, dynamics_, options_.settings);
  record_->trajectory = std::make_unique<Trajectory>(system, options_.channels);
  start_drives(system_, state_);
  dynamics_.set_left_limit_time(next_limit());
  handler_.start(state_);
  handler_.note_start(state_, record_->events);
  keep_blows();
  project_and_set_up(nullptr, system_.initial_impacts);
  if (options_.output_step > 0.0) {
    record_->samples = static_cast<long>(std::floor(state_.t / options_.output_step + k_output_slack)); // no samples before the start
    record_sample(state_.t);
  }
}

// Projects the initial state, and sets up integrator, extremes and energy account. Precondition: the constraints are satisfied to rounding,
// or to the digits of the file.
void RunLeg::project_and_set_up(const PowerLedger* before, const std::vector<Impact>& impacts) {
  dynamics_.set_state(state_);
  dynamics_.pack(state_, y_.data());
  dynamics_.project(state_.t, y_.data(), options_.settings.projection_tolerance);
  dynamics_.unpack(state_.t, y_.data(), state_);
  dynamics_.use_coordinates(chosen_coordinates());
  dynamics_.use_stage_code(options_.stage_code);
  if (options_.kept_layouts > 0) dynamics_.set_layout_capacity(options_.kept_layouts);
  for (std::size_t f = 0; f < system_.frictions.size(); ++f) {
    const FrictionElement& friction = *system_.frictions[f].friction;
    if (friction.dimension() > 1 && !friction.never_slips()) joints_.push_back(static_cast<int>(f));
  }
  if (options_.has_extremes) extremes_ = std::make_unique<ExtremeFinder>(system_, system_.largest_dimension());
  if (!system_.integrands.empty()) {
    ledger_ = std::make_unique<PowerLedger>(system_, system_.largest_dimension(), impacts);
    if (before) ledger_->go_on_from(*before);
    dynamics_.set_snapshot_integrals(ledger_.get());
  }
  formula_search_ = std::make_unique<FormulaPeakSearch>(system_, actions_ ? group_ : nullptr);
  if (formula_search_->is_empty()) formula_search_.reset();
  integrator_->expect_dense_evaluations(extremes_ || ledger_ || options_.output_step > 0.0);
  if (integrator_->is_adaptive()) dynamics_.set_slip_tolerance(options_.settings.tolerance);
  restart();
  energy_.start(dynamics_, state_.t, y_.data(), integrator_->is_adaptive() ? options_.settings.tolerance : 0.0);
}

// Time stepping requires absolute coordinates, in which positions are linear in velocities.
Coordinates RunLeg::chosen_coordinates() const {
  return method(options_.integrator).is_time_stepping ? Coordinates::absolute : options_.coordinates;
}

void RunLeg::refuse_time_stepping() const {
  if (!method(options_.integrator).is_time_stepping) return;
  if (const OneSidedRow* rope = first_one_sided_row(system_))
    throw NumericalFailure("'" + options_.integrator + "' does not locate where the inextensible rope '" +
                           system_.element_names[rope->row.element] +
                           "' becomes taut or slack: choose another integrator, auto for one, or give the rope a stiffness");
  const auto is_own_state = [](const ForceGroup* group) { return dynamic_cast<const OwnStateGroup*>(group) != nullptr; };
  if (std::all_of(system_.inner_groups.begin(), system_.inner_groups.end(), is_own_state)) return;
  throw NumericalFailure(
      "'" + options_.integrator + "' does not follow what '" + system_.element_names[system_.inner_elements[0]] +
      "' remembers (the slid distance of an elastic joint, how far a tyre's tread is bent, whether a tie has broken): choose another "
      "integrator, auto for one");
}

// Returns the next time, s, at which a prescribed motion or a law changes abruptly. No step may cross it.
double RunLeg::next_motion_limit() const {
  const auto next = std::upper_bound(system_.motion_breakpoints.begin(), system_.motion_breakpoints.end(), state_.t);
  return next == system_.motion_breakpoints.end() ? options_.end : std::min(*next, options_.end);
}

// Returns the time, s, at which a step of length `step` must end, for methods that average forces over a step. Breakpoints of forces nearer
// than k_own_step are ignored.
double RunLeg::next_limit_of_steps(double step) const {
  constexpr double k_own_step = 1e-4; // fraction of a step, far above the tolerance for rounding in time stepping
  const auto next = std::upper_bound(system_.breakpoints.begin(), system_.breakpoints.end(), state_.t + k_own_step * step);
  return next == system_.breakpoints.end() ? next_motion_limit() : std::min(*next, next_motion_limit());
}

double RunLeg::next_limit() const {
  if (integrator_->stepped_state()) return next_limit_of_steps(options_.settings.step);
  const auto next = std::upper_bound(system_.breakpoints.begin(), system_.breakpoints.end(), state_.t);
  return next == system_.breakpoints.end() ? options_.end : std::min(*next, options_.end);
}

// Sets the time up to which signals are read as left limits: the next breakpoint.
void RunLeg::approach_limit() {
  limit_ = next_limit();
  dynamics_.set_left_limit_time(limit_);
  const double fastest = system_.fastest_at(0.5 * (state_.t + limit_));
  const double turn = integrator_->is_adaptive() ? Integrator::k_largest_turn : k_turn_of_fixed_steps;
  double longest = fastest > 0.0 ? turn / fastest : std::numeric_limits<double>::infinity();
  const int division = options_.settings.division;
  if (division > 1 && integrator_->is_adaptive()) longest = std::min(longest, limit_ - state_.t) / division;
  integrator_->limit_step(longest);
}

// Restarts the integrator at state_. `is_evaluated`: the event handler has just evaluated this state.
void RunLeg::restart(bool is_evaluated) {
  is_evaluated = is_evaluated && next_limit() == limit_;
  if (!is_evaluated) dynamics_.set_state(state_);
  approach_limit();
  if (is_evaluated) {
    integrator_->restart_evaluated(dynamics_, state_.t, handler_.packed(), handler_.rates());
  } else {
    dynamics_.pack(state_, y_.data());
    integrator_->restart(dynamics_, state_.t, y_.data());
  }
  if (!integrator_->stepped_state()) {
    check_holding(state_.t, integrator_->event_value0());
    swallowed_.check(dynamics_, state_.t, integrator_->y0(), state_.mode, integrator_->event_value0());
  }
  if (formula_search_) formula_search_->restart();
  if (ledger_) ledger_->begin(state_.t, dynamics_.snapshot(integrator_->rate0()));
  if (extremes_) extremes_->begin(state_.t, dynamics_.snapshot(integrator_->rate0()), *integrator_, dynamics_);
  if (extremes_ && options_.has_growth) keep_growth(state_.t, false);
  is_between_events_ = true;
}

// Throws if the state at the end of the step contains numbers that are not finite.
void RunLeg::check_finite() {
  const double* y = integrator_->y1();
  for (int i = 0; i < dynamics_.dimension(); ++i)
    if (!std::isfinite(y[i])) fail_infinite(integrator_->t1());
}

void RunLeg::fail_infinite(double t) const {
  std::ostringstream message;
  message << "the motion became infinite at t = " << t << " s: '" << integrator_->name() << "' is unstable with steps of "
          << integrator_->h() << " s here";
  if (!integrator_->is_adaptive()) message << "; try a smaller step, or rodas5p";
  if (!record_->events.empty()) message << ". The last event was of '" << record_->events.back().element << "'";
  if (record_->events.empty()) throw NumericalFailure(message.str());
  throw ElementFailure(message.str(), {std::string(record_->events.back().element)});
}

// Checks that every sticking joint is within its limit. Otherwise the event finder or the mode problem has failed, and the results are
// wrong. For a group that shares a load the event function is that of the group.
void RunLeg::check_holding(double t, const std::vector<double>& event_value) const {
  for (const int f : joints_) {
    const double left = event_value[system_.frictions[f].slot(FrictionWatch::first)];
    if (left >= -k_held_beyond || state_.friction[f].phase != FrictionPhase::stick) continue;
    throw ElementFailure("at t = " + number_text(t) + " s '" + system_.element_names[system_.frictions[f].element] +
                             "' holds with a margin of " + rounded_text(1.0 / (1.0 - left), 12) +
                             ": the run contradicts itself, for below 1 it has to slip. Try a smaller tolerance or step, or "
                             "another integrator",
                         {system_.element_names[system_.frictions[f].element]});
  }
}

// Adds a sample row. Precondition: y_ contains the state to be sampled.
void RunLeg::record_sample(double t) {
  dynamics_.rates(t, y_.data(), dy_.data());
  const Snapshot snapshot = dynamics_.snapshot(dy_.data());
  record_->trajectory->add(t, snapshot, system_);
  ++record_->samples;
  if (options_.progress) options_.progress(t);
}

// Updates the energy integrals (PowerLedger) up to t. To be called before the step is evaluated inside up to t.
void RunLeg::keep_ledger(double t) {
  if (ledger_) ledger_->add_step(t, *integrator_, dynamics_);
}

// Projects a state within a step onto the joints, which dense output in absolute coordinates satisfies only to the accuracy of the step.
// Near a singular position the state is left unchanged.
static void close_joints(Dynamics& dynamics, double t, std::vector<double>& y, double tolerance) {
  const Residual off = dynamics.residual(t, y.data());
  if (!(off.position > tolerance)) return;
  const std::vector<double> before = y;
  try {
    dynamics.project(t, y.data(), tolerance);
  } catch (const NumericalFailure&) {
    y = before;
  }
}

// Takes the samples that are due in the last step, up to time t.
void RunLeg::sample_until(double t) {
  if (options_.output_step <= 0.0) return;
  for (;;) {
    const double due = static_cast<double>(record_->samples) * options_.output_step;
    if (due > t + k_output_slack * options_.output_step) return;
    const double theta = std::clamp((due - integrator_->t0()) / integrator_->h(), 0.0, 1.0);
    integrator_->dense(dynamics_, theta, y_.data());
    close_joints(dynamics_, due, y_, options_.settings.projection_tolerance);
    record_sample(due);
  }
}

// Returns the name of the element to which an event function belongs.
std::string RunLeg::owner_of(int slot) const {
  int element = -1;
  for (const Unit& unit : system_.units)
    if (slot >= unit.first_event && slot < unit.first_event + unit.event_count) element = unit.element;
  for (const FrictionUnit& unit : system_.frictions)
    if (slot >= unit.first_event && slot < unit.first_event + k_friction_event_count) element = unit.element;
  return element < 0 ? "" : std::string(system_.element_names[element]);
}

// Returns true if events of a sliding mode of formulas accumulate at the end of the run. The event finder detects the next event only from
// 1e-4 of a step on, and a step of a sliding mode may last to the end of the run, so each event leaves all but 1e-4 of the rest. A rest
// below k_least_rest of the run is passed in one step, with the last modes.
bool RunLeg::is_sliding_mode_at_end() const {
  return events_at_once_ >= k_max_events_at_once && options_.end - last_event_ <= k_least_rest * options_.end;
}

void RunLeg::guard_against_chatter(double t, const std::vector<int>& fired) {
  const bool is_same = t - last_event_ <= k_same_instant * std::max(system_.scale.time(), std::abs(t));
  events_at_once_ = is_same ? events_at_once_ + 1 : 0;
  last_event_ = t;
  ++statistics_.events;
  if (events_at_once_ < k_max_events_at_once && statistics_.events - kinks_ < options_.max_events) return;
  if (is_sliding_mode_at_end()) return;
  std::ostringstream message;
  message.precision(12);
  message << (events_at_once_ >= k_max_events_at_once ? "events repeat without end at t = "
                                                      : "more events than simulation.max_events by t = ")
          << t << " s; ";
  if (record_->events.empty()) { // no event has been reported so far
    message << "a switching value of '" << owner_of(fired.back()) << "' keeps changing its sign";
    throw ElementFailure(message.str(), {owner_of(fired.back())});
  }
  message << "the last ones:";
  const std::size_t shown = std::min<std::size_t>(record_->events.size(), 4);
  for (std::size_t i = record_->events.size() - shown; i < record_->events.size(); ++i)
    message << " '" << record_->events[i].element << "' " << record_->events[i].words() << (i + 1 < record_->events.size() ? ";" : "");
  throw ElementFailure(message.str(), {std::string(record_->events.back().element)});
}

// Throws if the steps have become so small that the run would never end.
void RunLeg::guard_against_crawl() {
  if (integrator_->steps() < next_progress_check_) return;
  const double t = integrator_->t1(), passed = t - last_progress_check_;
  const bool is_first = next_progress_check_ == 0;
  next_progress_check_ = integrator_->steps() + k_steps_between_checks;
  last_progress_check_ = t;
  if (is_first) return;
  const double needed = (options_.end - t) / passed * static_cast<double>(k_steps_between_checks);
  if (!(needed > k_most_steps)) return;
  std::ostringstream message;
  message << "the last " << k_steps_between_checks << " steps to t = " << t << " s passed " << passed << " s; the rest would take "
          << needed << " steps. Something is far stiffer or faster than the run is long: '" << integrator_->name()
          << "' is not made for it, or a stiffness, a mass or the end is mistaken.";
  throw NumericalFailure(message.str());
}

// Returns true if all event functions belong to sliding joints. Such a joint has no force when its sheets separate, and the step has
// continued beyond this kink.
bool RunLeg::are_joints(const std::vector<int>& slots) const {
  return std::all_of(slots.begin(), slots.end(), [this](int slot) {
    return std::any_of(system_.frictions.begin(), system_.frictions.end(), [slot](const FrictionUnit& unit) {
      return slot >= unit.first_event && slot < unit.first_event + k_friction_event_count && unit.friction->dimension() > 1;
    });
  });
}

// Kinks have a separate limit, far above that of other events, because tables with many points cause many kinks.
static void guard_against_kinks(long kinks, long max_events, double t, const std::string& element) {
  const long most = std::max(k_least_kinks, k_kinks_per_event * std::min(max_events, std::numeric_limits<long>::max() / k_kinks_per_event));
  if (kinks <= most) return;
  throw ElementFailure(
      "more than " + std::to_string(most) + " kinks of characteristics by t = " + number_text(t) + " s, the last one of '" + element +
          "'. Thin out its table, end the run earlier, or raise simulation.max_events: " + std::to_string(k_kinks_per_event) +
          " kinks are let pass for each event",
      {element});
}

// Returns the fired slots, except at the tie options_.other_slip: there the slot of `sticks` nearest to its bound replaces those of
// `slips`. Times are compared exactly, because the equal run met the tie at the same time, to the last bit.
std::vector<int> RunLeg::slots_of_other(double t, const std::vector<int>& fired) const {
  const SimultaneousSlip& tie = *options_.other_slip;
  if (t != tie.t) return fired;
  std::vector<int> slots = fired;
  for (std::size_t f = 0; f < system_.frictions.size(); ++f) {
    const FrictionUnit& unit = system_.frictions[f];
    const std::string& name = system_.element_names[unit.element];
    const int first = unit.slot(FrictionWatch::first), second = unit.slot(FrictionWatch::second);
    if (name == tie.slips) std::erase_if(slots, [&](int slot) { return slot == first || slot == second; });
    if (name != tie.sticks) continue;
    const std::vector<double>& event_value = dynamics_.event_value();
    slots.push_back(event_value[first] <= event_value[second] ? first : second);
  }
  return slots;
}

void RunLeg::keep_blows() { record_->blows.insert(record_->blows.end(), handler_.blows().begin(), handler_.blows().end()); }

// Records simultaneous slips of the last event. Precondition: the integrator still has the step that led to the event.
void RunLeg::keep_ties(double t) {
  const double before = t - integrator_->t0();
  for (SimultaneousSlip tie : handler_.ties()) {
    if (record_->ties.size() >= RunRecord::k_most_ties) return;
    for (const FrictionUnit& unit : system_.frictions)
      if (before > 0.0 && system_.element_names[unit.element] == tie.sticks)
        tie.rate = (tie.share - share_of_bound(unit, integrator_->event_value0())) / before;
    record_->ties.push_back(std::move(tie));
  }
}

void RunLeg::pass_event(double t, const double* y, const std::vector<int>& fired, const std::vector<double>* event_value_before) {
  is_between_events_ = false;
  std::copy(y, y + dynamics_.dimension(), y_.begin());
  // The factors are computed at this state: with factors from a sample, the result of projection would differ within its tolerance.
  (void)dynamics_.residual(t, y_.data());
  dynamics_.project(t, y_.data(), options_.settings.projection_tolerance);
  energy_.check_step(dynamics_, t, y_.data());
  dynamics_.unpack(t, y_.data(), state_);
  if (fired.empty()) dynamics_.set_left_limit_time(limit_ = next_limit()); // at a breakpoint, the evaluation after it uses the next limit
  if (ledger_ && ledger_->has_stored()) {
    dynamics_.rates(t, y_.data(), dy_.data());
    ledger_->end(dynamics_.snapshot(dy_.data()));
  }
  const std::size_t known = record_->events.size();
  if (options_.other_slip) handler_.handle(state_, slots_of_other(t, fired), event_value_before, record_->events);
  else handler_.handle(state_, fired, event_value_before, record_->events);
  if (!handler_.ties().empty()) keep_ties(t);
  keep_blows();
  energy_.check_settled(state_.t, handler_.settled());
  const auto is_at_kink = [](const Event& event) { return is_kink(event.kind); };
  const auto first_new = record_->events.begin() + static_cast<std::ptrdiff_t>(known);
  if (first_new != record_->events.end() && std::all_of(first_new, record_->events.end(), is_at_kink))
    guard_against_kinks(++kinks_, options_.max_events, t, std::string(record_->events.back().element));
  if (pass_storm(t, known)) return;
  if (!fired.empty()) guard_against_chatter(t, fired);
  if (is_action_due(known)) return;
  restart(handler_.is_evaluated());
}

// Updates extremes after a step. `evaluations`: number of evaluations when the step was made; if it is unchanged, `dynamics_` is still at
// the end of the step (an adaptive method may have used it otherwise).
void RunLeg::update_extremes(long evaluations, bool is_last) {
  if (!extremes_) return;
  const bool is_at_end = !integrator_->is_adaptive() && dynamics_.evaluations() == evaluations;
  extremes_->add_step(*integrator_, dynamics_, is_at_end, is_last);
  if (options_.has_growth) keep_growth(integrator_->t1(), false);
}

// Records the extremes so far, at times evenly distributed over the run. When there are too many entries, every other one is dropped.
void RunLeg::keep_growth(double t, bool is_last) {
  constexpr std::size_t k_most = 128;
  constexpr double k_finest = 1e-4; // smallest interval between entries, relative to the planned duration; the run may end early
  std::vector<ExtremesSoFar>& kept = record_->growth;
  if (record_->growth_step == 0.0) record_->growth_step = k_finest * options_.end;
  if (!is_last && !kept.empty() && t < kept.back().t + record_->growth_step) return;
  kept.push_back({t, {}});
  for (const ChannelRange& range : extremes_->ranges()) kept.back().range.emplace_back(range.low.value, range.high.value);
  if (kept.size() < k_most) return;
  record_->growth_step *= 2.0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < kept.size(); i += 2) kept[count++] = std::move(kept[i]);
  kept.resize(count);
}

// Attempts a step. Returns false if it is withdrawn. Throws NumericalFailure.
bool RunLeg::try_advance() {
  try {
    integrator_->step(dynamics_, next_limit());
  } catch (const JointsNearSingular&) { // in absolute coordinates rounding errors differ, so the step may succeed there
    state_ = current_state();
    options_.coordinates = Coordinates::absolute;
    dynamics_.use_coordinates(Coordinates::absolute);
    restart();
    return true;
  }
  return pass_step();
}

bool RunLeg::advance() {
  if (is_over()) return false;
  while (!try_advance()) continue;
  return !is_over() && !is_interrupted_;
}

// Looks inside the step for an instant at which the condition of an armed action holds, or a formula leaves the band between two values
// (FormulaPeakSearch). Returns true if the step was undone, to be repeated up to that instant, or if its dense output is too inaccurate to
// tell.
bool RunLeg::ends_at_peak() {
  if (!integrator_->dense_output_is_accurate(dynamics_)) return true;
  const double place = formula_search_->place_of_peak(*integrator_, dynamics_, actions_ ? &actions_->is_armed : nullptr);
  if (place >= 1.0) return false;
  if (integrator_->is_adaptive()) return integrator_->shorten(dynamics_, place);
  (void)integrator_->end_at(dynamics_, place);
  return false;
}

// Handles the events in the last step, its samples and its end. Returns false if the step is withdrawn and must be repeated.
bool RunLeg::pass_step() {
  const double limit = next_limit();
  constexpr long k_now_and_then = 64; // number of steps after which progress is reported even if no sample is due
  if (integrator_->steps() % k_now_and_then == 0) {
    if (options_.progress) options_.progress(state_.t);
    throw_if_stopped("in a simulation"); // for runs without progress reports: error estimates and second methods
  }
  const long evaluations = dynamics_.evaluations();
  guard_against_crawl();
  if (integrator_->stepped_state()) {
    pass_stepped();
    return true;
  }
  check_finite();
  const double share = integrator_->is_adaptive() ? integrator_->fraction_within_turn_limits(dynamics_) : 1.0;
  if ((share < 1.0 && integrator_->shorten(dynamics_, share)) || (formula_search_ && ends_at_peak())) return false;
  const bool is_event = !is_sliding_mode_at_end() && finder_.find(*integrator_, dynamics_, handler_.fresh());
  if (finder_.is_step_withdrawn() || !integrator_->resolves_slips(dynamics_, is_event ? finder_.theta() : 1.0, finder_.state().data()))
    return false;
  if (is_event) {
    const double t = integrator_->t0() + finder_.theta() * integrator_->h();
    const bool is_ended = are_joints(finder_.fired()) && integrator_->end_at(dynamics_, finder_.theta());
    const double* const at_event = is_ended ? integrator_->y1() : finder_.state().data();
    keep_ledger(t);
    if (extremes_) extremes_->end_at(t, *integrator_, dynamics_);
    sample_until(std::nextafter(t, 0.0) - k_output_slack * options_.output_step);
    pass_event(t, at_event, finder_.fired(), nullptr);
    if (!handler_.stop_reason().empty()) end_run();
    return true;
  }
  const double t1 = integrator_->t1();
  keep_ledger(t1);
  update_extremes(evaluations, t1 >= limit);
  sample_until(t1);
  handler_.clear_fresh();
  if (t1 >= limit && limit < options_.end) {
    pass_event(t1, integrator_->y1(), {}, &integrator_->event_value1());
    return true;
  }
  check_holding(t1, integrator_->event_value1());
  check_sticking(system_, state_, dynamics_.sharing(), t1, integrator_->event_value1());
  swallowed_.check(dynamics_, t1, integrator_->y1(), state_.mode, integrator_->event_value1());
  energy_.check_step(dynamics_, t1, integrator_->y1());
  if (t1 >= options_.end) {
    integrator_->accept();
    dynamics_.unpack(t1, integrator_->y0(), state_);
    end_run();
    return true;
  }
  state_.t = t1;
  integrator_->accept();
  return true;
}

// Adds the last sample row and the final values of channels, wherever the run ends.
void RunLeg::end_run() {
  if (!is_between_events_) return; // the run was aborted at an event
  is_between_events_ = false;
  const double t = integrator_->t0();
  std::copy_n(integrator_->y0(), dynamics_.dimension(), y_.begin());
  const bool is_sampled = options_.output_step > 0.0;
  const double last = record_->trajectory->size() > 0 ? record_->trajectory->time(record_->trajectory->size() - 1)
                                                      : -std::numeric_limits<double>::infinity();
  if (is_sampled && t > last + k_output_slack * options_.output_step) record_sample(t);
  finish_extremes();
}

// Completes the extremes. Precondition: y_ contains the final state.
void RunLeg::finish_extremes() {
  if (!extremes_) return;
  const double t = integrator_->t0();
  dynamics_.rates(t, y_.data(), dy_.data());
  extremes_->finish(dynamics_.snapshot(dy_.data()));
  if (options_.has_growth) keep_growth(t, true);
  // The state 1e-7 of the run earlier is extrapolated linearly. Velocities change too little in this time to affect a rate, and the change
  // of positions is still accurate to 1e-6.
  constexpr double k_before = 1e-7;
  const double before = k_before * options_.end;
  const std::vector<double> end = y_, rates = dy_;
  const long evaluations = dynamics_.evaluations();
  for (int i = 0; i < dynamics_.dimension(); ++i) y_[static_cast<std::size_t>(i)] -= before * rates[static_cast<std::size_t>(i)];
  dynamics_.rates(t - before, y_.data(), dy_.data());
  extremes_->finish_rates(dynamics_.snapshot(dy_.data()), before);
  if (options_.has_growth) finish_bends(t, end, rates);
  evaluations_behind_end_ += dynamics_.evaluations() - evaluations;
}

// Computes the second derivatives of all channels at the end of the run, from two earlier states that have the same accelerations. `end`,
// `rates`: packed state and its rates at the end, at time t.
void RunLeg::finish_bends(double t, const std::vector<double>& end, const std::vector<double>& rates) {
  // The states are within the last step, over which accelerations change little, unless that step is so short (at the end of the run, at an
  // event) that differences of positions would be rounding, or so long that nothing moves.
  constexpr double k_of_step = 0.1, k_least = 1e-6, k_most = 1e-4; // the last two relative to the run
  const double before = std::clamp(k_of_step * integrator_->h(), k_least * options_.end, k_most * options_.end);
  const auto earlier = [&](double back) {
    const auto n = static_cast<std::size_t>(dynamics_.dimension()), coordinates = static_cast<std::size_t>(dynamics_.coordinate_count());
    for (std::size_t i = 0; i < n; ++i) y_[i] = end[i] - back * rates[i];
    for (std::size_t i = 0; i < coordinates; ++i) y_[i] += 0.5 * back * back * rates[coordinates + i];
    dynamics_.rates(t - back, y_.data(), dy_.data());
    return dynamics_.snapshot(dy_.data());
  };
  const std::vector<double> middle = extremes_->values(earlier(before));
  extremes_->finish_bends(middle, earlier(2.0 * before), before);
}

// Records in statistics_ that a time step has averaged part of a load: bodies receive its impulse, but no force or acceleration shows its
// peak.
void RunLeg::note_passed(double t0, double t1) {
  if (statistics_.passed_pulse) return;
  // Relative tolerance for times that were meant to be equal.
  constexpr double k_same_time = 64.0 * std::numeric_limits<double>::epsilon();
  const std::vector<double>& times = system_.breakpoints;
  for (auto next = std::lower_bound(times.begin(), times.end(), t0); next != times.end() && next + 1 != times.end() && *(next + 1) < t1;
       ++next)
    if (*(next + 1) - *next > k_same_time * *(next + 1)) statistics_.passed_pulse = *next;
}

// Adopts the modes at the end of the step from a method that determines them itself, and reports the changes.
void RunLeg::pass_stepped() {
  const double t1 = integrator_->t1();
  note_passed(state_.t, t1);
  if (ledger_) {
    dynamics_.rates(t1, integrator_->y1(), dy_.data());
    ledger_->add_stepped(t1, dynamics_.snapshot(dy_.data()));
  }
  sample_until(t1);
  energy_.note(dynamics_, t1, integrator_->y1()); // must precede the next statement, which may discard the layout of the step
  const std::size_t known = record_->events.size();
  handler_.note_changes(state_, *integrator_->stepped_state(), record_->events);
  state_ = *integrator_->stepped_state();
  statistics_.events += static_cast<long>(record_->events.size() - known);
  if (is_action_due(known)) return;
  dynamics_.set_left_limit_time(next_limit());
  restart();
  if (t1 >= options_.end) end_run();
}

State RunLeg::current_state() const {
  State state = state_;
  dynamics_.unpack(integrator_->t0(), integrator_->y0(), state);
  return state;
}

void RunLeg::read_state(State& into) const {
  into = state_; // same size, so no allocation
  dynamics_.unpack(integrator_->t0(), integrator_->y0(), into);
}

// Layouts are recomputed, because they contain the relative poses of merged bodies. A displacement along the constraints violates them only
// by its square.
void RunLeg::displace(const std::vector<double>& by) {
  state_ = current_state();
  for (std::size_t i = 0; i < by.size(); ++i) state_.q[i] += by[i];
  dynamics_.clear_layouts();
  dynamics_.use_coordinates(Coordinates::absolute);
  dynamics_.set_state(state_);
  dynamics_.pack(state_, y_.data());
  dynamics_.project(state_.t, y_.data(), options_.settings.projection_tolerance);
  dynamics_.unpack(state_.t, y_.data(), state_);
  dynamics_.use_coordinates(chosen_coordinates());
  restart();
  energy_.start(dynamics_, state_.t, integrator_->y0(), integrator_->is_adaptive() ? options_.settings.tolerance : 0.0);
}

RunStatistics RunLeg::statistics() const {
  RunStatistics s = statistics_;
  s.steps += integrator_->steps();
  s.rejections = integrator_->rejections();
  s.divided_steps = integrator_->divided_steps();
  s.rounded_tolerance = integrator_->rounded_tolerance();
  if (formula_search_) s.undecided_condition = formula_search_->undecided();
  s.evaluations = dynamics_.evaluations() - evaluations_behind_end_;
  s.coded_stages = dynamics_.coded_stages();
  s.max_position_residual = integrator_->max_position_residual();
  s.max_velocity_residual = integrator_->max_velocity_residual();
  s.energy_residual = energy_.residual();
  s.energy_exchanged = energy_.exchanged();
  s.energy_scale = energy_.scale();
  s.energy_worst_step = energy_.worst_step();
  s.energy_rounding = energy_.rounding();
  s.dissipated = state_.dissipated;
  s.work = state_.work;
  return s;
}

void RunLeg::break_off() {
  if (!is_between_events_) return;
  state_ = current_state();
  dynamics_.set_state(state_);
  end_run();
}

} // namespace steplap
