#include "mbd/events/event_handler.h"

#include "mbd/events/blow.h"
#include "mbd/events/rest_rate.h"
#include "mbd/system/approximate_place.h"
#include "mbd/system/evaluation_arrays.h"
#include "mbd/system/one_way_lock.h"
#include "mbd/system/rope_end.h"
#include "mbd/system/rounding.h"
#include "mbd/system/sliding_units.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_projection_tolerance = 1e-12; // largest remaining constraint error, m, rad
// An ended slip is accepted if settle(), which sets its remaining rate ε to zero, changes velocities by at most this multiple of ε. Two
// rows can be nearly parallel, such as those of two feet of a slightly tilted box; setting the rates of both to zero then also stops the
// rotation, which changes velocities by ε divided by the small angle. A larger change is real motion, so the slip has not ended.
constexpr double k_most_taken = 1e3;
// An element certainly sticks if its margin relative to the bound is larger; a thousand times the accuracy of wrenches.
constexpr double k_inside = 1e-9;

// Calls f(row, value and rate of the row) for each sticking element of dimension 1.
template <class F> void for_each_held(const System& system, const State& state, const std::vector<Motion<double>>& motion, const F& f) {
  for (std::size_t i = 0; i < system.frictions.size(); ++i) {
    const FrictionElement& friction = *system.frictions[i].friction;
    if (state.friction[i].phase != FrictionPhase::stick || friction.dimension() != 1) continue;
    const RowSpec& row = *friction.rows(state.friction[i]);
    f(row, evaluate_row<false>(row, motion.data()));
  }
}

// Returns true if settle() changed velocities by at most k_most_taken times the remaining slip rates, so that the elements really came to
// rest. Otherwise the slip continues: its rate changed sign only because velocities have errors.
bool is_slight(const System& system, const State& before, const State& after) {
  std::vector<Motion<double>> motion;
  double left = 0.0, taken = 0.0;
  place_bodies(before.q, before.v, motion);
  for_each_held(system, before, motion, [&](const RowSpec& row, const MeasureValue<double>& m) {
    left = std::max({left, std::abs(m.rate), rest_rate(row, m, motion.data())});
  });
  State change = before;
  for (std::size_t i = 0; i < change.v.size(); ++i) change.v[i] = after.v[i] - before.v[i];
  place_bodies(change.q, change.v, motion);
  for_each_held(system, change, motion, [&](const RowSpec& row, const MeasureValue<double>& m) {
    taken = std::max({taken, point_speed(motion[row.a], m.lever_a, m.couple), point_speed(motion[row.b], m.lever_b, m.couple)});
  });
  return taken <= k_most_taken * left;
}

// Several elements reached their bounds at the same instant and all were released. Those that slide drop from μ_s to μ_k, which may unload
// others. An unloaded element has no slip rate yet and returns to its phase in `before`. If it then exceeds its static bound, it is
// released finally, so no set of modes is tried twice.
void hold_relieved(const System& system, Dynamics& dynamics, FrictionModes& modes, EventTransaction& event) {
  const std::vector<FrictionState>& before = event.friction_before;
  State& state = event.now;
  std::vector<int> begun, relieved;
  const LoadSharing* const sharing = dynamics.sharing();
  for (std::size_t f = 0; f < system.frictions.size(); ++f) {
    const bool is_let_go = before[f].phase == FrictionPhase::stick && state.friction[f].phase == FrictionPhase::slip;
    const bool is_alone = !sharing || sharing->group_of(static_cast<int>(f)) < 0; // elements of a group are released together, not singly
    if (is_let_go && is_alone && system.frictions[f].bounded && !system.frictions[f].rope) begun.push_back(static_cast<int>(f));
  }
  if (begun.size() < 2) return;
  modes.evaluate(state);
  for (const int f : begun) {
    double rate = 0.0, acceleration = 0.0, rounding = 0.0;
    dynamics.relative_motion(f, modes.rates(), &rate, &acceleration, &rounding);
    if (!(state.friction[f].sign * acceleration > rounding)) relieved.push_back(f);
  }
  // no element slides: without a drop from μ_s to μ_k all accelerations at the onset are zero, and all stay released
  if (relieved.size() == begun.size()) return;
  const std::vector<FrictionState> released = state.friction;
  while (!relieved.empty()) {
    state.friction = released;
    for (const int f : relieved) state.friction[f] = before[f];
    modes.evaluate(state);
    const auto is_overloaded = [&](int f) {
      const double* const event_value = &dynamics.event_value()[system.frictions[f].first_event];
      return !(std::min(event_value[0], event_value[1]) > k_inside * std::max(event_value[0], event_value[1]));
    };
    if (std::erase_if(relieved, is_overloaded) == 0) return;
  }
  state.friction = released;
}

} // namespace

// In one dimension the two event functions are bound − λ and bound + λ, so the utilisation is |λ|/bound. In three dimensions the first
// event function is 1 − u.
double share_of_bound(const FrictionUnit& unit, const std::vector<double>& event_value) {
  const double one = event_value[unit.slot(FrictionWatch::first)], other = event_value[unit.slot(FrictionWatch::second)];
  return unit.friction->dimension() == 1 ? 1.0 - 2.0 * std::min(one, other) / (one + other) : 1.0 - one;
}

EventHandler::EventHandler(const System& system, Dynamics& dynamics)
    : system_(system), dynamics_(dynamics), modes_(system, dynamics), unit_of_slot_(system.event_count, -1),
      friction_of_slot_(system.event_count, -1), fresh_(system.event_count, 0), y_(static_cast<std::size_t>(system.largest_dimension())),
      dy_(y_.size()) {
  for (std::size_t u = 0; u < system.units.size(); ++u)
    for (int w = 0; w < system.units[u].event_count; ++w) unit_of_slot_[system.units[u].first_event + w] = static_cast<int>(u);
  for (std::size_t f = 0; f < system.frictions.size(); ++f)
    for (int w = 0; w < k_friction_event_count; ++w) friction_of_slot_[system.frictions[f].first_event + w] = static_cast<int>(f);
}

void EventHandler::slip_rates(const State& state, const Motion<double>* motion, int f, double* rate) const {
  const FrictionElement& friction = *system_.frictions[f].friction;
  const RowSpec* rows = friction.rows(state.friction[f]);
  for (int r = 0; r < friction.dimension(); ++r) rate[r] = evaluate_row<false>(rows[r], motion).rate;
}

// Element f has gained its normal force. Sets its contact point for the present pose (it was not monitored without force), its anchor, and
// its phase: stick or slip according to the present velocities.
void EventHandler::load(EventTransaction& event, int f) {
  FrictionState& friction = event.now.friction[f];
  const FrictionElement& element = *system_.frictions[f].friction;
  if (element.contact_point_event(dynamics_.evaluation(), friction) < 0.0) element.switch_contact_point(dynamics_.evaluation(), friction);
  if (friction.phase == FrictionPhase::apart) return;
  modes_.set_anchor(event.now, f);
  double rate[3] = {0, 0, 0};
  const Motion<double>* const motion = event.motion();
  bool is_sliding = false;
  for (int r = 0; r < element.dimension(); ++r) {
    const RowSpec& row = element.rows(friction)[r];
    const auto m = evaluate_row<false>(row, motion);
    rate[r] = m.rate;
    is_sliding = is_sliding || std::abs(m.rate) > (element.dimension() == 1 ? rest_rate(row, m, motion) : k_rest_velocity);
  }
  is_sliding = is_sliding && !element.never_slips();
  friction.phase = is_sliding ? FrictionPhase::slip : FrictionPhase::stick;
  friction.is_onset = false;
  element.aim(friction, rate);
}

// Layouts that merge the two bodies of a rigid joint are invalid after the joint has slid.
void EventHandler::forget_moved_layouts(const State& state) {
  for (std::size_t f = 0; f < system_.frictions.size(); ++f)
    if (state.friction[f].phase == FrictionPhase::slip && system_.frictions[f].friction->is_rigid()) return dynamics_.clear_layouts();
}

// Projects positions and velocities onto joints and drives, with all friction released, because the resulting velocities decide which
// elements slide.
void EventHandler::meet_constraints(State& state) {
  for (FrictionState& friction : state.friction)
    if (friction.phase != FrictionPhase::apart) friction.phase = FrictionPhase::free;
  dynamics_.set_state(state);
  dynamics_.pack(state, y_.data());
  dynamics_.project(state.t, y_.data(), k_projection_tolerance);
  dynamics_.unpack(state.t, y_.data(), state);
}

void EventHandler::begin_units(State& state) const {
  for (std::size_t u = 0; u < system_.units.size(); ++u) {
    const Unit& unit = system_.units[u];
    state.mode[u] = unit.group->initial_mode(unit.index, dynamics_.evaluation());
  }
}

void EventHandler::start(State& state) {
  blows_.clear();
  dynamics_.clear_layouts();
  meet_constraints(state);
  dynamics_.rates(state.t, y_.data(), dy_.data());
  begin_units(state);
  const bool is_any_tight = set_ropes(system_, state);
  if (is_any_tight || turns_against_lock(system_, state)) {
    apply_impact(system_, dynamics_, state);
    record_blows(system_.initial_impacts, state);
    modes_.evaluate(state);
    begin_units(state); // impact changes velocities, on which the initial modes of dampers and formulas depend
  }
  modes_.evaluate(state);
  const std::vector<int> no_slots;
  std::vector<Event> no_events;
  EventTransaction event(system_, state, no_slots, no_events);
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    FrictionState& friction = state.friction[f];
    if (system_.frictions[f].rope) continue;
    modes_.set_anchor(state, f);
    if (friction.phase != FrictionPhase::apart && system_.frictions[f].friction->is_loaded(dynamics_.evaluation(), friction))
      load(event, f);
  }
  modes_.forget_evaluation();
  (void)modes_.decide(state);
  const auto slips = [](const FrictionState& friction) { return friction.phase == FrictionPhase::slip; };
  if (std::any_of(state.friction.begin(), state.friction.end(), slips))
    modes_.evaluate(state); // necessary because decide() may end with the evaluation of a trial state
  clear_fresh();
}

bool EventHandler::switch_units(EventTransaction& event, const std::vector<int>& slots) {
  State& state = event.now;
  bool is_any = false;
  for (const int slot : slots) {
    const int u = unit_of_slot_[slot];
    if (u < 0) continue;
    const Unit& unit = system_.units[u];
    // Dense output satisfies the joints only to a tolerance. If the event function is clearly positive after projection, there was no
    // event.
    if (unit.group->event_tolerance(slot - unit.first_event) != EventTolerance::none && dynamics_.event_value()[slot] > 0.5 * k_met)
      continue;
    const UnitMode from = state.mode[u];
    const UnitMode to = unit.group->next_mode(unit.index, from, slot - unit.first_event, dynamics_.evaluation());
    if (to == from) continue;
    state.mode[u] = to;
    event.has_switched[slot] = 1;
    state.dissipated += unit.group->jump_inner(unit.index, to, dynamics_.evaluation(), state.inner.data());
    if (unit.group->ends_run_in(unit.index, to))
      stop_reason_ = "'" + system_.element_names[unit.element] + "' " + words_of(unit.group->event_kind(from, to));
    is_any = true;
    for (int w = 0; w < unit.event_count; ++w)
      fresh_[unit.first_event + w] = !unit.group->is_armed_at_entry(unit.index, to, w, dynamics_.evaluation());
    list_unit_change(u, from, to, state.t, event.events);
  }
  event.is_loading_changed = event.is_loading_changed || is_any;
  return is_any;
}

void EventHandler::list_unit_change(int u, UnitMode from, UnitMode to, double t, std::vector<Event>& events) const {
  const Unit& unit = system_.units[u];
  const EventKind kind = unit.group->event_kind(from, to);
  if (kind != EventKind::none) events.push_back({t, system_.element_names[unit.element], kind});
  const EventKind slide = sliding_of(*unit.group, to); // a contact may close and slide at the same time
  if (!is_slip(kind) && slide != EventKind::none && slide != sliding_of(*unit.group, from))
    events.push_back({t, system_.element_names[unit.element], slide});
}

// Applies the transition of element f whose event function `fired` became negative.
void EventHandler::change_phase(EventTransaction& event, int f, FrictionWatch fired) {
  State& state = event.now;
  const FrictionUnit& unit = system_.frictions[f];
  FrictionState& friction = state.friction[f];
  if (unit.rope) { // the rope becomes slack; a rope that becomes taut is handled by an impact
    friction.phase = FrictionPhase::slip;
    friction.sign = 0;
  } else if (fired == FrictionWatch::contact_point) {
    change_foot(event, f);
  } else if (friction.phase == FrictionPhase::stick) {
    friction.phase = FrictionPhase::slip;
    friction.has_slipped = friction.is_onset = true;
    const Snapshot snapshot = dynamics_.snapshot(modes_.rates());
    unit.friction->set_onset_direction(dynamics_.evaluation(), friction, snapshot.friction_force + unit.row);
  } else if (friction.phase == FrictionPhase::slip) {
    double rate[3];
    slip_rates(state, event.motion(), f, rate);
    if (unit.friction->continue_slip(dynamics_.evaluation(), friction, rate, fired)) return;
    modes_.end_slip(state, f);
    friction.phase = FrictionPhase::stick; // provisional: the mode problem decides whether the slip reverses instead
    if (unit.friction->dimension() == 1) modes_.note_rest(f, rate[0]);
  }
}

// Moves element f to its new contact point.
void EventHandler::change_foot(EventTransaction& event, int f) {
  FrictionState& friction = event.now.friction[f];
  const FrictionElement& element = *system_.frictions[f].friction;
  if (friction.phase == FrictionPhase::slip) modes_.end_slip(event.now, f);
  const FrictionState from = friction;
  element.switch_contact_point(dynamics_.evaluation(), friction);
  modes_.set_anchor(event.now, f);
  if (element.dimension() == 1) move_on(event, f, from);
}

// The contact point of element f has moved to another point of its bodies. If the velocity there is not zero, the element slides with it:
// sticking would require an impact, and a slip may have the opposite direction. If the contact point only approximates a face, the velocity
// error of this approximation counts as zero.
void EventHandler::move_on(EventTransaction& event, int f, const FrictionState& from) {
  FrictionState& friction = event.now.friction[f];
  const FrictionElement& element = *system_.frictions[f].friction;
  const bool is_acting = friction.phase == FrictionPhase::stick || friction.phase == FrictionPhase::slip;
  if (!is_acting || element.never_slips()) return;
  const RowSpec& row = *element.rows(friction);
  const Motion<double>* const motion = event.motion();
  const auto m = evaluate_row<false>(row, motion);
  double at_rest = rest_rate(row, m, motion);
  if (from.phase == FrictionPhase::stick) at_rest += rate_error(element, dynamics_.evaluation(), from, friction);
  if (std::abs(m.rate) <= at_rest) return;
  friction.phase = FrictionPhase::slip;
  friction.has_slipped = true;
  friction.is_onset = false;
  element.aim(friction, &m.rate);
}

// Updates friction elements whose normal force began or ended, or left their contact point, because a contact or a signal changed.
void EventHandler::update_loading(EventTransaction& event) {
  if (!event.is_loading_changed) return;
  State& state = event.now;
  modes_.evaluate(state);
  bool is_any = false;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    FrictionState& friction = state.friction[f];
    if (friction.phase == FrictionPhase::apart) continue;
    const bool is_loaded = system_.frictions[f].friction->is_loaded(dynamics_.evaluation(), friction);
    if (is_loaded && friction.phase == FrictionPhase::free) {
      load(event, f);
      if (friction.phase == FrictionPhase::slip) friction.has_slipped = true;
      is_any = true;
    } else if (!is_loaded && friction.phase != FrictionPhase::free) {
      if (friction.phase == FrictionPhase::slip) modes_.end_slip(state, f);
      friction.phase = FrictionPhase::free;
      is_any = true;
    } else if (const BoundedFriction* const bounded = system_.frictions[f].bounded;
               is_loaded && bounded && bounded->is_foot_wrong(dynamics_.evaluation(), friction)) {
      change_foot(event, f);
      is_any = true;
    }
  }
  if (!is_any) return;
  modes_.forget_evaluation();
  event.is_settled = false;
}

bool EventHandler::is_same_direction(std::size_t f, const FrictionState& a, const FrictionState& b) const {
  if (system_.frictions[f].friction->dimension() == 1) return a.sign == b.sign;
  return !b.is_onset || (a.is_onset && std::equal(a.direction, a.direction + 3, b.direction));
}

EventKind EventHandler::slip_kind(std::size_t f, const FrictionState& old, const FrictionState& now) const {
  if (system_.frictions[f].friction->dimension() == 1) return now.sign > 0 ? EventKind::slips_forward : EventKind::slips_backward;
  return old.phase == FrictionPhase::slip ? EventKind::changes_slip_direction : EventKind::slips;
}

// Returns true if the support function is positive in some direction, that is, sliding meets resistance.
bool EventHandler::has_capacity(const State& state, std::size_t f) const {
  const FrictionElement& friction = *system_.frictions[f].friction;
  for (int r = 0; r < friction.dimension(); ++r) {
    double rate[3] = {0, 0, 0};
    rate[r] = 1.0;
    if (friction.support(dynamics_.evaluation(), state.friction[f], rate) > 0.0) return true;
  }
  return false;
}

void EventHandler::note_start(const State& state, std::vector<Event>& events) const {
  for (std::size_t u = 0; u < system_.units.size(); ++u)
    if (const EventKind slide = sliding_of(*system_.units[u].group, state.mode[u]); slide != EventKind::none)
      events.push_back({state.t, system_.element_names[system_.units[u].element], slide});
  for (std::size_t f = 0; f < state.friction.size(); ++f)
    if (state.friction[f].phase == FrictionPhase::slip && has_capacity(state, f))
      events.push_back({state.t, system_.element_names[system_.frictions[f].element], slip_kind(f, {}, state.friction[f])});
  for (std::size_t f = 0; f < state.friction.size(); ++f)
    if (had_impact(system_, f, system_.initial_impacts, state))
      events.push_back({state.t, system_.element_names[system_.frictions[f].element],
                        system_.frictions[f].rope ? EventKind::closes_gap : EventKind::sticks,
                        impact_text(system_, f, system_.initial_impacts, state)});
}

namespace {

// Adds the events of a rope: it became taut, slack, or taut and immediately slack again.
void note_rope(const System& system, const OneSidedUnit& unit, FrictionPhase phase_before, const std::vector<Impact>& impacts_before,
               const State& state, std::vector<Event>& events) {
  const OneSidedRow& rope = *unit.row;
  const std::string& name = system.element_names[rope.row.element];
  const bool was_taut = phase_before == FrictionPhase::stick, is_taut = state.friction[unit.friction].phase == FrictionPhase::stick;
  const bool is_caught = !was_taut && (is_taut || had_impact(system, unit.friction, impacts_before, state));
  if (is_caught) events.push_back({state.t, name, EventKind::closes_gap, impact_text(system, unit.friction, impacts_before, state)});
  if ((was_taut || is_caught) && !is_taut) events.push_back({state.t, name, EventKind::enters_gap});
}

// Returns the slots that are ≥ 0 in `before` and negative in `now`.
std::vector<int> fallen(const std::vector<double>& before, const std::vector<double>& now) {
  std::vector<int> slots;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (before[i] >= 0.0 && now[i] < 0.0) slots.push_back(static_cast<int>(i));
  return slots;
}

// Computes the event functions of units from the separate motions of the bodies. Dynamics would already use one common motion for bodies
// that a joint is about to connect.
void evaluate_separated_joint_events(const System& system, const State& state, std::vector<double>& event_value) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  motion.resize(static_cast<std::size_t>(system.links.slot_count()));
  place_links(system.links, motion);
  EvaluationArrays arrays(system);
  Evaluation e;
  arrays.connect(e, motion);
  e.t = state.t;
  e.mode = state.mode.data();
  e.friction = state.friction.data();
  e.bases = state.bases.data();
  e.inner = state.inner.data();
  for (const auto& group : system.groups) group->add_forces(e);
  for (const Unit& unit : system.units)
    std::copy_n(arrays.event_value.begin() + unit.first_event, unit.event_count, event_value.begin() + unit.first_event);
}

} // namespace

// Adds events for changes of friction element f. Returns true if its phase, contact point or slip direction has changed. Not for ropes.
bool EventHandler::list_friction_change(std::size_t f, const FrictionState& old, const std::vector<Impact>& impacts_before,
                                        const State& state, std::vector<Event>& events) {
  const FrictionState& now = state.friction[f];
  const bool is_same_slip = now.phase != FrictionPhase::slip || is_same_direction(f, old, now);
  if (old.phase == now.phase && old.foot == now.foot && is_same_slip) return false;
  const FrictionUnit& unit = system_.frictions[f];
  const std::string& name = system_.element_names[unit.element];
  if (old.foot != now.foot && now.phase != FrictionPhase::apart)
    if (const EventKind kind = unit.friction->contact_switch_event(old, now); kind != EventKind::none)
      events.push_back({state.t, name, kind});
  if (old.phase == now.phase && is_same_slip) return true;
  EventKind kind = EventKind::none;
  switch (now.phase) {
  case FrictionPhase::free: kind = EventKind::loses_normal_force; break;
  case FrictionPhase::stick: kind = EventKind::sticks; break;
  case FrictionPhase::slip: kind = slip_kind(f, old, now); break;
  case FrictionPhase::apart: kind = EventKind::comes_apart; break;
  }
  events.push_back({state.t, name, kind, kind == EventKind::sticks ? impact_text(system_, f, impacts_before, state) : std::string()});
  if (now.phase == FrictionPhase::apart && unit.friction->stops_when_apart()) stop_reason_ = "'" + name + "' came apart";
  return true;
}

void EventHandler::list_friction_changes(const std::vector<FrictionState>& before, const std::vector<Impact>& impacts_before,
                                         const State& state, std::vector<Event>& events) {
  for (std::size_t f = 0; f < state.friction.size(); ++f) {
    const FrictionState &old = before[f], &now = state.friction[f];
    const FrictionUnit& unit = system_.frictions[f];
    if (const OneSidedRow* const rope = unit.rope) {
      const std::size_t known = events.size();
      note_rope(system_, {rope, f}, old.phase, impacts_before, state, events);
      for (int w = 0; w < k_friction_event_count && events.size() > known; ++w) fresh_[unit.first_event + w] = 1;
      continue;
    }
    if (!list_friction_change(f, old, impacts_before, state, events)) continue;
    for (int w = 0; w < k_friction_event_count; ++w) fresh_[unit.first_event + w] = 1;
    const bool is_same_slip = now.phase != FrictionPhase::slip || is_same_direction(f, old, now);
    if ((old.phase == now.phase && is_same_slip) || !unit.friction->is_rigid()) continue;
    dynamics_.clear_layouts();
    modes_.forget_evaluation();
  }
}

void EventHandler::settle_phases(State& state) {
  clear_fresh();
  forget_moved_layouts(state);
  settle(state);
  (void)modes_.decide(state);
  std::fill(fresh_.begin(), fresh_.end(), 1); // no event function has been monitored up to this state
}

void EventHandler::note_changes(const State& before, const State& state, std::vector<Event>& events) {
  list_changes_within(before, state, events);
  list_friction_changes(before.friction, before.impacts, state, events);
  clear_fresh();
}

void EventHandler::list_changes(const State& before, const State& state, std::vector<Event>& events) {
  list_changes_within(before, state, events);
  for (std::size_t f = 0; f < state.friction.size(); ++f) (void)list_friction_change(f, before.friction[f], before.impacts, state, events);
}

// Adds changes of units, and slips of elements that stick at the end, slipped in between, and did not slip at the start.
void EventHandler::list_changes_within(const State& before, const State& state, std::vector<Event>& events) const {
  for (std::size_t u = 0; u < system_.units.size(); ++u)
    if (before.mode[u] != state.mode[u]) list_unit_change(static_cast<int>(u), before.mode[u], state.mode[u], state.t, events);
  for (std::size_t f = 0; f < state.friction.size(); ++f) {
    const FrictionState &old = before.friction[f], &now = state.friction[f];
    if (old.phase == FrictionPhase::slip || now.phase != FrictionPhase::stick) continue;
    if (old.slid == now.slid && old.has_slipped == now.has_slipped && std::equal(old.direction, old.direction + 3, now.direction)) continue;
    const std::string& name = system_.element_names[system_.frictions[f].element];
    events.push_back({state.t, name, slip_kind(f, old, now)});
    if (old.phase == FrictionPhase::stick)
      events.push_back({state.t, name, EventKind::sticks}); // else a change of phase, listed with these
  }
}

void EventHandler::fail_on_pulley(EventTransaction& event, int f) const {
  const OneSidedRow& rope = *system_.frictions[f].rope;
  const auto& [one, next] = rope.points.at(rope.shortest_part(event.motion()).place);
  throw rope_has_run_in(event.now.t, system_.element_names[rope.row.element], one, next);
}

// Applies the transition of every friction slot that fired. Ropes that became taut are only flagged; resolve_rope_impacts() computes their
// impact. Throws if a rope has run into a pulley.
void EventHandler::change_phases(EventTransaction& event) {
  const LoadSharing* const sharing = dynamics_.sharing();
  std::vector<char> is_released(sharing ? sharing->groups().size() : 0, 0), has_fired(system_.frictions.size(), 0);
  for (const int slot : event.fired) {
    const int f = friction_of_slot_[slot];
    if (f < 0) continue;
    const FrictionWatch watch = system_.frictions[f].watch_of(slot);
    const OneSidedRow* const rope = system_.frictions[f].rope;
    if (rope && watch == OneSidedRow::k_length_reached) {
      event.is_any_tight = true;
      fresh_[slot] = 1;
      continue;
    }
    if (rope && watch == OneSidedRow::k_on_pulley) fail_on_pulley(event, f);
    const int group = sharing && watch != FrictionWatch::contact_point ? sharing->group_of(f) : -1;
    if (group >= 0 && watch == FrictionWatch::second) continue; // the rows of the group separate; the mode problem decides how
    if (group >= 0) {                                           // the same event fires in the slots of all elements of the group
      if (!is_released[group]) modes_.release(event.now, group);
      is_released[group] = 1;
      continue;
    }
    // If both slots of an element fired, only the first counts: its transition changes the phase to which the second belongs.
    if (watch != FrictionWatch::contact_point) {
      if (has_fired[f]) continue;
      has_fired[f] = 1;
    }
    change_phase(event, f, watch);
    event.is_any_at_rest = event.is_any_at_rest || event.now.friction[f].phase == FrictionPhase::stick;
  }
  if (event.fired.size() > 1) hold_relieved(system_, dynamics_, modes_, event);
  if (!event.fired.empty()) modes_.forget_evaluation();
}

// Applies an impact, and updates modes of contacts and phases of friction for the new velocities.
void EventHandler::strike(EventTransaction& event, Blow blow) {
  State& state = event.now;
  modes_.evaluate(state);
  std::vector<double> event_value = dynamics_.event_value();
  const State unhurt = state;
  if (blow == Blow::rows) {
    evaluate_separated_joint_events(system_, state, event_value);
    close_rows(system_, dynamics_, state);
  }
  apply_impact(system_, dynamics_, state);
  event.velocities_changed();
  modes_.evaluate(state);
  std::fill(event.has_switched.begin(), event.has_switched.end(), 0);
  switch_units(event, fallen(event_value, dynamics_.event_value()));
  follow_jumps(event);
  std::vector<Motion<double>> motion_before;
  place_bodies(unhurt.q, unhurt.v, motion_before);
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    const FrictionPhase phase = state.friction[f].phase;
    if ((phase != FrictionPhase::stick && phase != FrictionPhase::slip) || system_.frictions[f].rope) continue;
    double rate_before[3] = {0, 0, 0}, rate[3] = {0, 0, 0};
    slip_rates(unhurt, motion_before.data(), f, rate_before);
    slip_rates(state, event.motion(), f, rate);
    if (std::equal(rate, rate + 3, rate_before, [](double x, double y) { return std::abs(x - y) <= k_rest_velocity; })) continue;
    if (phase == FrictionPhase::slip) modes_.end_slip(state, f);
    load(event, f);
    if (state.friction[f].phase == FrictionPhase::slip) state.friction[f].has_slipped = true;
  }
  modes_.forget_evaluation();
  record_blows(event.impacts_before, state);
}

void EventHandler::resolve_rope_impacts(EventTransaction& event) {
  if (event.is_any_tight) strike(event, Blow::ropes);
}

// Returns the slots that became negative by a jump, of units with discontinuous event functions. Units that have already switched in this
// event are excluded, so that they do not switch back.
std::vector<int> EventHandler::slots_made_negative_by_jump(const EventTransaction& event, const std::vector<double>& before) const {
  std::vector<int> slots = fallen(before, dynamics_.event_value());
  std::erase_if(slots, [&](int slot) {
    const int u = unit_of_slot_[slot];
    return u < 0 || event.has_switched[slot] != 0 || !system_.units[u].group->has_discontinuous_events();
  });
  return slots;
}

// At a breakpoint a signal jumps. Units whose event functions become negative by this switch their mode.
void EventHandler::follow_breakpoint(EventTransaction& event) {
  if (event.event_value_before) switch_units(event, slots_made_negative_by_jump(event, *event.event_value_before));
}

// A formula jumps where one of its comparisons changes, and other comparisons may change as a consequence. The state is therefore evaluated
// in the new modes, and units switch, until none switches any more. Each comparison switches at most once, so this ends.
void EventHandler::follow_jumps(EventTransaction& event) {
  const auto has_jumped = [&] {
    for (std::size_t slot = 0; slot < event.has_switched.size(); ++slot)
      if (event.has_switched[slot] != 0 && system_.units[unit_of_slot_[slot]].group->has_discontinuous_events()) return true;
    return false;
  };
  if (!has_jumped()) return;
  std::vector<double> before;
  do {
    before = dynamics_.event_value();
    modes_.evaluate(event.now);
  } while (switch_units(event, slots_made_negative_by_jump(event, before)));
}

// Sets the remaining rates of ended slips to zero, because the mode problem assumes elements at rest.
void EventHandler::stop_ended_slips(EventTransaction& event) {
  if (!event.is_any_at_rest) return;
  const State unsettled = event.now;
  const double settled = settled_;
  settle(event);
  if (is_slight(system_, unsettled, event.now)) {
    event.is_settled = !modes_.rejoin(event.now);
  } else {
    event.now = unsettled;
    event.velocities_changed();
    settled_ = settled;
  }
}

// Friction that comes to rest at the same instant as other elements, and would reverse, becomes a candidate of the mode problem.
void EventHandler::catch_reversals(EventTransaction& event) {
  if (!modes_.catch_reversals(event.now, event.friction_before)) return;
  settle(event);
  event.is_settled = true;
}

void EventHandler::decide_phases(EventTransaction& event) {
  if (!modes_.decide(event.now)) event.is_settled = false;
}

// Projects the state onto the rows of elements that began to stick in this event.
void EventHandler::meet_new_rows(EventTransaction& event) {
  if (!event.is_settled && has_new_rows(event.friction_before, event.now)) settle(event);
}

void EventHandler::record_blows(const std::vector<Impact>& impacts_before, const State& state) {
  for (std::size_t f = 0; f < system_.frictions.size(); ++f)
    if (had_impact(system_, f, impacts_before, state)) blows_.push_back({state.t, system_.element_names[system_.frictions[f].element]});
}

// Records pairs of which one element began to slip while the other stuck close to its bound. Ropes and locked clutches have no bound and
// are excluded, as are elements that shared a load, because all elements of a group have the same event functions.
void EventHandler::record_simultaneous_slips(const EventTransaction& event) {
  if (event.event_value_at.empty()) return;
  const std::vector<FrictionState>&before = event.friction_before, &now = event.now.friction;
  const auto stuck = [&](std::size_t f) {
    const FrictionUnit& unit = system_.frictions[f];
    return before[f].phase == FrictionPhase::stick && !unit.friction->never_slips() && impact_index(unit) < 0;
  };
  const auto began = [&](std::size_t f) { return now[f].phase == FrictionPhase::slip && stuck(f); };
  std::size_t first = 0;
  while (first < before.size() && !began(first)) ++first;
  if (first == before.size()) return;
  for (std::size_t f = 0; f < before.size(); ++f) {
    const FrictionUnit& unit = system_.frictions[f];
    if (now[f].phase != FrictionPhase::stick || event.shares_load_at[f] != 0 || !stuck(f)) continue;
    const double share = share_of_bound(unit, event.event_value_at);
    if (!(share > 1.0 - k_near_bound)) continue;
    for (std::size_t g = first; g < before.size(); ++g)
      if (began(g))
        ties_.push_back({event.now.t, system_.element_names[system_.frictions[g].element], system_.element_names[unit.element], share});
  }
}

// Clears the results of the last event.
void EventHandler::begin_event() {
  clear_fresh();
  settled_ = 0.0;
  ties_.clear();
  blows_.clear();
  modes_.begin_event();
}

// Rules of an event, in their order. Units switch first, because their forces load friction. Friction that fired or came to rest changes
// its phase next. Finally the mode problem decides all friction together. The state is evaluated and projected once for each set of modes
// that is tried, in most events twice. The next step starts from the last evaluation.
void EventHandler::handle(State& state, const std::vector<int>& fired, const std::vector<double>* event_value_before,
                          std::vector<Event>& events) {
  begin_event();
  EventTransaction event(system_, state, fired, events);
  event.event_value_before = event_value_before;
  event.is_loading_changed = fired.empty(); // at a breakpoint the normal force of a signal may begin or end
  forget_moved_layouts(state);
  modes_.evaluate(state);
  const auto sticks = [](const FrictionState& friction) { return friction.phase == FrictionPhase::stick; };
  if (std::count_if(state.friction.begin(), state.friction.end(), sticks) > 1) {
    event.event_value_at = dynamics_.event_value();
    const LoadSharing* const sharing = dynamics_.sharing();
    for (std::size_t f = 0; f < state.friction.size(); ++f)
      event.shares_load_at.push_back(sharing && sharing->group_of(static_cast<int>(f)) >= 0 ? 1 : 0);
  }

  switch_units(event, fired);
  follow_breakpoint(event);
  follow_jumps(event);
  change_phases(event);
  resolve_rope_impacts(event);
  stop_ended_slips(event);
  conclude(event);
  record_simultaneous_slips(event);
}

// Elements activated by an action have their initial mode and do not stick. Modes and phases of all elements are decided here.
void EventHandler::take_over(State& state, bool closes_rows, std::vector<Event>& events) {
  begin_event();
  const std::vector<int> no_slots;
  EventTransaction event(system_, state, no_slots, events);
  event.is_loading_changed = true;
  dynamics_.clear_layouts();
  if (closes_rows) strike(event, Blow::rows);
  conclude(event);
}

// Decides all friction. Precondition: modes of units are set and ended slips are at rest.
void EventHandler::conclude(EventTransaction& event) {
  update_loading(event);
  catch_reversals(event);
  decide_phases(event);
  list_friction_changes(event.friction_before, event.impacts_before, event.now, event.events);
  meet_new_rows(event);
}

// Returns true if an element sticks that did not stick before, or did so at another contact point: the state must then be projected onto
// its rows.
bool EventHandler::has_new_rows(const std::vector<FrictionState>& before, const State& state) {
  for (std::size_t f = 0; f < state.friction.size(); ++f) {
    const FrictionState &old = before[f], &now = state.friction[f];
    if (now.phase == FrictionPhase::stick && (old.phase != now.phase || old.foot != now.foot)) return true;
  }
  return false;
}

// Projects the state onto the sticking rows. Their residual velocities are of the order of errors; the kinetic energy lost is added to the
// dissipation.
void EventHandler::settle(EventTransaction& event) {
  settle(event.now);
  event.velocities_changed();
}

void EventHandler::settle(State& state) {
  modes_.forget_evaluation();
  dynamics_.set_state(state);
  dynamics_.pack(state, y_.data());
  const double energy = system_.kinetic_energy(state);
  dynamics_.project(state.t, y_.data(), k_projection_tolerance);
  dynamics_.project_velocities(state.t, y_.data());
  dynamics_.unpack(state.t, y_.data(), state);
  const double lost = energy - system_.kinetic_energy(state);
  state.dissipated += lost;
  settled_ += lost;
}

} // namespace steplap
