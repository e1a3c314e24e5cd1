// RunLeg: interruption by an action, and the start of the following leg.
#include "mbd/simulation/run_leg.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/events/blow.h"
#include "mbd/system/sliding_units.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace steplap {

namespace {

// Returns true if velocities changed by more than the rounding errors left when joints at rest are activated.
bool jumps(const std::vector<double>& before, const std::vector<double>& after) {
  constexpr double k_share = 1e-6, k_least = 1e-9; // relative to the fastest velocity; absolute, m/s or rad/s
  double fastest = 0.0, most = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    fastest = std::max(fastest, std::abs(before[i]));
    most = std::max(most, std::abs(after[i] - before[i]));
  }
  return most > k_share * fastest + k_least;
}

// Assigns the impact to the last executed action, which activated the joints.
void note_blow(RunRecord& record, std::size_t known, double lost) {
  for (std::size_t i = known; i-- > 0;) {
    Event& event = record.events[i];
    if (event.kind != EventKind::happens) continue;
    event.detail += ", " + rounded_text(lost, 4) + " J lost in a blow";
    record.blows.push_back({event.t, event.element});
    return;
  }
}

} // namespace

RunLeg::RunLeg(RunLeg& before, const Changeover& change)
    : system_(change.to), options_(before.options_), state_(carried(change, before.state_)), dynamics_(change.to),
      handler_(change.to, dynamics_), finder_(change.to, change.to.largest_dimension()), swallowed_(change.to), record_(before.record_),
      actions_(before.actions_), group_(action_group(change.to)), y_(static_cast<std::size_t>(change.to.largest_dimension())),
      dy_(y_.size()) {
  options_.max_events -= before.statistics_.events;
  if (options_.end > system_.drives_end)
    throw NumericalFailure("a drive jumps at t = " + number_text(system_.drives_end) + " s, before the end of the run");
  refuse_time_stepping();
  integrator_ = make_integrator(options_.integrator, dynamics_, options_.settings);
  start_drives(system_, state_, &change.begins);
  place_what_closes(change, state_);
  dynamics_.set_left_limit_time(next_limit());
  dynamics_.set_state(state_);
  dynamics_.pack(state_, y_.data());
  dynamics_.rates(state_.t, y_.data(), dy_.data());
  for (std::size_t u = 0; u < system_.units.size(); ++u) {
    const Unit& unit = system_.units[u];
    if (change.begins[static_cast<std::size_t>(unit.element)] == 0) continue;
    const EventKind was = sliding_of(*unit.group, state_.mode[u]);
    const UnitMode before_it = state_.mode[u];
    state_.mode[u] = unit.group->initial_mode(unit.index, dynamics_.evaluation());
    // The energy lost by the change of mode is part of the difference of stored energies below, hence not added here.
    if (state_.mode[u] != before_it) (void)unit.group->jump_inner(unit.index, state_.mode[u], dynamics_.evaluation(), state_.inner.data());
    if (const EventKind is = sliding_of(*unit.group, state_.mode[u]); is != was)
      record_->events.push_back({state_.t, system_.element_names[unit.element], is == EventKind::none ? EventKind::sticks : is});
  }
  book_stored_energy(change, before.state_, state_);
  const std::vector<Impact> impacts = state_.impacts;
  const std::vector<double> rates = state_.v;
  const std::size_t known = record_->events.size();
  const double dissipated = state_.dissipated;
  handler_.take_over(state_, change.closes_rows(), record_->events);
  if (change.closes_rows() && jumps(rates, state_.v)) note_blow(*record_, known, state_.dissipated - dissipated);
  keep_blows();
  project_and_set_up(before.ledger_.get(), impacts);
}

// Interrupts the leg and returns true if an action is due. `known`: number of events before the present one was handled.
bool RunLeg::is_action_due(std::size_t known) {
  if (!actions_ || is_over()) return false;
  const bool is_stepped = integrator_->stepped_state() != nullptr;
  is_interrupted_ = actions_->update(*group_, system_, state_, is_stepped, std::span(record_->events).subspan(known));
  return is_interrupted_;
}

void RunLeg::go_on() {
  is_interrupted_ = false;
  if (is_between_events_) return;
  dynamics_.set_left_limit_time(next_limit());
  restart();
}

void RunLeg::close(bool is_end_of_run) {
  go_on();
  if (is_end_of_run) return end_run();
  is_between_events_ = false;
  std::copy_n(integrator_->y0(), dynamics_.dimension(), y_.begin());
  finish_extremes();
}

} // namespace steplap
