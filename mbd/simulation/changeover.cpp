#include "mbd/simulation/changeover.h"

#include "mbd/base/shown_text.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/one_way_lock.h"
#include "mbd/system/own_states.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap {

namespace {

// Largest gap, relative to the scene's length, with which a joint can be activated. Events and joints are far more accurate.
constexpr double k_fit = 1e-6;

// Calls copy(i, j) for each entry i of `from` and the corresponding entry j of `to`. `of_from` and `of_to` give the element of each entry.
// Only elements flagged in `goes_on` are copied.
template <class F>
void carry(const std::vector<int>& of_from, const std::vector<int>& of_to, const std::vector<char>& goes_on, const F& copy) {
  std::vector<std::vector<std::size_t>> places(goes_on.size());
  for (std::size_t i = 0; i < of_from.size(); ++i) places[static_cast<std::size_t>(of_from[i])].push_back(i);
  std::vector<std::size_t> next(goes_on.size(), 0);
  for (std::size_t i = 0; i < of_to.size(); ++i) {
    const auto element = static_cast<std::size_t>(of_to[i]);
    if (goes_on[element] != 0 && next[element] < places[element].size()) copy(places[element][next[element]++], i);
  }
}

template <class Units> std::vector<int> elements_of(const Units& units) {
  std::vector<int> elements;
  for (const auto& unit : units) elements.push_back(unit.element);
  return elements;
}

// Returns the element of each inner state. Own states of the model get a common index after all elements, because they belong to no
// element: their inner states are consecutive.
std::vector<int> elements_of_inner(const System& system, int own_states) {
  std::vector<int> elements = system.inner_elements;
  if (const OwnStateGroup* const group = own_state_group(system))
    for (int i = 0; i < own_states; ++i)
      elements[static_cast<std::size_t>(group->first_inner + i)] = static_cast<int>(system.element_names.size());
  return elements;
}

double stored_energy(const System& system, const State& state) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  double sum = 0.0;
  for (const auto& group : system.groups) sum += group->potential(motion.data());
  for (const ForceGroup* group : system.inner_groups) sum += group->inner_energy(motion.data(), state.inner.data());
  return sum;
}

[[noreturn]] void fail_to_close(const System& system, const State& state, const RowSpec& row, double off) {
  const std::string& name = system.element_names[static_cast<std::size_t>(row.element)];
  const bool is_angle = row.kind == MeasureKind::angle;
  throw ElementFailure(
      "at t = " + rounded_text(state.t, 12) + " s '" + name + "' cannot close: its " + (is_angle ? "angle" : "markers") +
          " would have to move by " + rounded_text(std::abs(off), 4) + (is_angle ? " rad" : " m") + " at once. " +
          (row.drive ? "A drive that is read as a position begins where its signal is: read it as a velocity, or set it where the two meet"
                     : "Let it close where they meet, or take a weld, which holds the pose that it finds"),
      {name});
}

// Throws if an element with inner states is activated during a run, because these states would have no values.
void refuse_inner(const Changeover& change, const State& state) {
  const OwnStateGroup* const own = own_state_group(change.to);
  for (std::size_t i = 0; i < change.to.inner_elements.size(); ++i) {
    const int element = change.to.inner_elements[i], at = static_cast<int>(i);
    const bool is_state = own && at >= own->first_inner && at < own->first_inner + static_cast<int>(own->entries.size());
    if (is_state || !change.closes(element)) continue;
    const std::string& name = change.to.element_names[static_cast<std::size_t>(element)];
    throw ElementFailure("at t = " + rounded_text(state.t, 12) + " s '" + name +
                             "' cannot begin to act: what it remembers (a slid distance, whether it has broken) begins with a run. " +
                             "Let it act from the start, or take an element that remembers nothing",
                         {name});
  }
}

void place_rope(const Changeover& change, const OneSidedUnit& unit, const std::vector<Motion<double>>& motion, State& state) {
  const OneSidedRow& rope = *unit.row;
  const std::string& name = change.to.element_names[static_cast<std::size_t>(rope.row.element)];
  const double length = rope.measured(motion.data()).value;
  if (length > rope.length * (1.0 + OneSidedRow::k_too_long))
    throw ElementFailure("at t = " + rounded_text(state.t, 12) + " s the ends of rope '" + name + "' are " +
                             rounded_text(length - rope.length, 4) +
                             " m farther apart than its length lets them be: let it begin to act where they are nearer, or make it longer",
                         {name});
  state.friction[unit.friction].phase =
      length >= rope.length * (1.0 - OneSidedRow::k_at_length) ? FrictionPhase::stick : FrictionPhase::slip;
}

} // namespace

bool Changeover::closes_rows() const {
  const auto is_new = [this](int element) { return begins[static_cast<std::size_t>(element)] != 0; };
  return std::any_of(to.rows.begin(), to.rows.end(), [&](const RowSpec& row) { return is_new(row.element); }) ||
         std::any_of(to.frictions.begin(), to.frictions.end(),
                     [&](const FrictionUnit& unit) { return is_new(unit.element) && impact_index(unit) >= 0; });
}

State carried(const Changeover& change, const State& state) {
  State next = change.to.initial_state();
  next.t = state.t;
  next.q = state.q;
  next.v = state.v;
  next.dissipated = state.dissipated;
  next.work = state.work;
  std::vector<char> goes_on = change.acts;
  for (std::size_t i = 0; i < goes_on.size(); ++i) goes_on[i] = static_cast<char>(goes_on[i] != 0 && change.acted[i] != 0);
  goes_on.push_back(1);                                                               // entry for own states (elements_of_inner())
  for (FrictionState& friction : next.friction) friction.phase = FrictionPhase::free; // provisional, until the pressed contacts are known
  carry(elements_of(change.from.units), elements_of(change.to.units), goes_on,
        [&](std::size_t a, std::size_t b) { next.mode[b] = state.mode[a]; });
  carry(elements_of(change.from.frictions), elements_of(change.to.frictions), goes_on,
        [&](std::size_t a, std::size_t b) { next.friction[b] = state.friction[a]; });
  carry(change.from.base_elements, change.to.base_elements, goes_on, [&](std::size_t a, std::size_t b) {
    next.bases[b].rate = state.bases[a].rate;
    // a change of the length of a rod or rope
    const bool is_set_anew = change.from.initial_bases[a].value != change.to.initial_bases[b].value;
    if (!is_set_anew) next.bases[b].value = state.bases[a].value;
  });
  carry(change.from.impact_elements, change.to.impact_elements, goes_on,
        [&](std::size_t a, std::size_t b) { next.impacts[b] = state.impacts[a]; });
  const OwnStateGroup *const had = own_state_group(change.from), *const has = own_state_group(change.to);
  const int own_states = had && has ? static_cast<int>(has->entries.size()) : 0;
  carry(elements_of_inner(change.from, own_states), elements_of_inner(change.to, own_states), goes_on,
        [&](std::size_t a, std::size_t b) { next.inner[b] = state.inner[a]; });
  return next;
}

void place_what_closes(const Changeover& change, State& state) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  refuse_inner(change, state);
  for (const RowSpec& row : change.to.rows) {
    if (change.begins[static_cast<std::size_t>(row.element)] == 0) continue;
    const double now = evaluate_row<false>(row, motion.data()).value;
    if (change.closes(row.element) && row.base >= 0 && !row.drive) state.bases[static_cast<std::size_t>(row.base)].value = now;
    const double off = off_target(row, now, row_target(row, state.bases.data(), state.t).value);
    const double fits = k_fit * (row.kind == MeasureKind::angle ? 1.0 : change.to.scale.length);
    if (std::abs(off) > fits) fail_to_close(change.to, state, row, off);
  }
  for (const OneSidedUnit& rope : one_sided_rows(change.to))
    if (change.begins[static_cast<std::size_t>(rope.row->row.element)] != 0)
      place_rope(change, rope, motion, state); // includes ropes whose length was changed
}

void book_stored_energy(const Changeover& change, const State& before, State& after) {
  const double gained = stored_energy(change.to, after) - stored_energy(change.from, before);
  if (gained > 0.0) after.work += gained;
  else after.dissipated -= gained;
}

} // namespace steplap
