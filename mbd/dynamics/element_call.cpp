#include "mbd/dynamics/element_call.h"

#include "mbd/system/motion_formula.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace steplap {

namespace {

// Returns NaN as the motion of bodies that the call does not transfer. If an element reads such a body nevertheless, the recorded results
// differ from the evaluation, and the code is not used (StageProgram::record).
Motion<double> unknown_motion() {
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
  return {k_nan, k_nan, k_nan, k_nan, k_nan, k_nan, k_nan, k_nan};
}

} // namespace

ElementCall::ElementCall(const System& system, const Evaluation& live)
    : system_(system), live_(live), motion_(static_cast<std::size_t>(system.links.slot_count()), unknown_motion()), arrays_(system),
      inner_(static_cast<std::size_t>(system.inner_count()), 0.0) {
  motion_[k_ground] = {};
  arrays_.connect(own_, motion_);
  own_.inner = inner_.data();
}

// Passes a number to the call, which finds it at `place`: a constant is stored once, a variable becomes an argument.
void ElementCall::take(const TapeNumber& x, double& place) {
  place = value_of(x);
  if (x.is_constant()) return;
  arguments_.push_back(x);
  places_.push_back(&place);
}

void ElementCall::take(const Motion<TapeNumber>& from, Motion<double>& to) {
  take(from.x, to.x);
  take(from.y, to.y);
  take(from.theta, to.theta);
  take(from.c, to.c);
  take(from.s, to.s);
  take(from.vx, to.vx);
  take(from.vy, to.vy);
  take(from.omega, to.omega);
}

void ElementCall::give(TapeNumber& x, const double& place) {
  results_.push_back(&x);
  found_.push_back(&place);
}

// Lets the call add to x. The present value of x is passed, so that terms are added in the same order as without code.
void ElementCall::add_to(TapeNumber& x, double& place) {
  take(x, place);
  if (x.is_constant()) constants_.push_back({&place, place});
  give(x, place);
}

// Returns the slots of the marked bodies, and of the links between them.
std::vector<int> ElementCall::slots_of(const std::vector<char>& is_used) const {
  std::vector<int> slots;
  for (int body = 0; body < system_.body_count(); ++body)
    if (is_used[static_cast<std::size_t>(body)] != 0) slots.push_back(body);
  for (int i = 0; i < system_.links.size(); ++i) {
    const Link& link = system_.links[i];
    if (is_used[static_cast<std::size_t>(link.a)] != 0 && is_used[static_cast<std::size_t>(link.b)] != 0)
      slots.push_back(system_.links.slot(i));
  }
  return slots;
}

// Passes time and the motions of the marked bodies. Time is always an argument, so that no call has only constant arguments.
void ElementCall::record_surroundings(const std::vector<char>& is_used, TracedEvaluation& e) {
  take(e.record_signal_input({&clock_signal()}), own_.t);
  for (const int slot : slots_of(is_used)) take(e.motion[slot], motion_[static_cast<std::size_t>(slot)]);
  for (std::size_t i = 0; i < inner_.size(); ++i) take(e.inner[i], inner_[i]);
}

void ElementCall::trace(const ForceGroup& group, TracedEvaluation& e) {
  group_ = &group;
  std::vector<char> is_used(system_.bodies.size(), 0);
  group.mark_bodies(is_used);
  record_surroundings(is_used, e);
  for (const int slot : slots_of(is_used)) {
    if (slot == k_ground) continue;
    BodyForceOf<TapeNumber>& force = e.force[slot];
    BodyForce& own = arrays_.force[static_cast<std::size_t>(slot)];
    add_to(force.fx, own.fx);
    add_to(force.fy, own.fy);
    add_to(force.m, own.m);
  }
  add_to(e.dissipation, own_.dissipation);
  add_to(e.work, own_.work);
  for (std::size_t i = 0; i < arrays_.inner_rate.size(); ++i) add_to(e.inner_rate[i], arrays_.inner_rate[i]);
  for (const std::size_t i : contacts_of_group()) give(e.contact_force[i], arrays_.contact_force[i]);
  for (const Unit& unit : system_.units) {
    if (unit.group != &group) continue;
    for (int slot = unit.first_event; slot < unit.first_event + unit.event_count; ++slot) {
      give(e.event_value[slot], arrays_.event_value[static_cast<std::size_t>(slot)]);
      give(e.event_derivative[slot], arrays_.event_derivative[static_cast<std::size_t>(slot)]);
    }
  }
  put_down();
}

// Returns the contacts of the group: those whose normal force an evaluation changes. An element writes its normal forces in every
// evaluation or never.
std::vector<std::size_t> ElementCall::contacts_of_group() {
  constexpr double k_untouched = std::numeric_limits<double>::lowest();
  std::fill(arrays_.contact_force.begin(), arrays_.contact_force.end(), k_untouched);
  try {
    evaluate_element();
  } catch (...) {
    throw NotTraceable();
  }
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < arrays_.contact_force.size(); ++i)
    if (arrays_.contact_force[i] != k_untouched) found.push_back(i);
  return found;
}

void ElementCall::trace(int f, TracedEvaluation& e, const TapeNumber* rate, TapeNumber* wrench, TapeNumber* event_value) {
  const FrictionElement& friction = *system_.frictions[static_cast<std::size_t>(f)].friction;
  friction_ = f;
  is_sliding_ = rate != nullptr;
  std::vector<char> is_used(system_.bodies.size(), 0);
  friction.mark_bodies(is_used);
  const RowSpec* const rows = friction.rows(e.friction[f]);
  for (int r = 0; r < friction.dimension(); ++r)
    is_used[static_cast<std::size_t>(rows[r].a)] = is_used[static_cast<std::size_t>(rows[r].b)] = 1;
  record_surroundings(is_used, e);
  for (std::size_t i = 0; i < arrays_.contact_force.size(); ++i) take(e.contact_force[i], arrays_.contact_force[i]);
  for (int r = 0; r < friction.dimension(); ++r) {
    if (is_sliding_) take(rate[r], rate_[r]);
    else take(wrench[r], wrench_[r]);
  }
  if (is_sliding_)
    for (int r = 0; r < friction.dimension(); ++r) give(wrench[r], wrench_[r]);
  for (int slot = 0; slot < k_friction_event_count; ++slot) give(event_value[slot], arrays_.event_value[static_cast<std::size_t>(slot)]);
  put_down();
}

void ElementCall::put_down() {
  arguments_.insert(arguments_.begin(), TapeNumber(std::bit_cast<double>(this)));
  std::vector<TapeNumber> made(results_.size());
  TapeNumber::call(&ElementCall::run, arguments_, made);
  if (has_failed()) throw NotTraceable();
  for (std::size_t i = 0; i < made.size(); ++i) *results_[i] = made[i];
  arguments_.clear();
  results_.clear();
}

// Executes a recorded call. Compiled code cannot pass exceptions on, so the caller must check has_failed().
void ElementCall::run(const double* arguments, double* results) {
  ElementCall& call = *std::bit_cast<ElementCall*>(arguments[1]);
  arguments += 2;
  for (double* const place : call.places_) *place = *arguments++;
  for (const Constant& constant : call.constants_) *constant.place = constant.value;
  try {
    call.evaluate_element();
  } catch (...) {
    call.has_failed_ = true;
  }
  for (const double* const found : call.found_) *results++ = *found;
}

void ElementCall::evaluate_element() {
  own_.mode = live_.mode;
  own_.friction = live_.friction;
  own_.bases = live_.bases;
  own_.scratch = live_.scratch;
  own_.averaging_start = live_.averaging_start;
  if (group_) return group_->add_forces(own_);
  const FrictionElement& friction = *system_.frictions[static_cast<std::size_t>(friction_)].friction;
  const FrictionState& state = own_.friction[friction_];
  double* const event_value = arrays_.event_value.data();
  if (is_sliding_) {
    friction.slip_wrench(own_, state, rate_, wrench_);
    friction.slip_events(own_, state, rate_, event_value);
  } else {
    friction.stick_events(own_, state, wrench_, event_value);
  }
  event_value[2] = friction.contact_point_event(own_, state);
}

} // namespace steplap
