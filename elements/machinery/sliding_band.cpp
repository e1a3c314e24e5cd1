#include "elements/machinery/sliding_band.h"

#include "mbd/system/element_failure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap {

namespace {

using D18 = Dual<18>;
using Group = SlidingBandGroup;

double exponential(double x) { return portable::pow(std::numbers::e, x); }
D18 exponential(const D18& x) {
  const double value = exponential(x.v);
  return {value, value * x.d};
}

// Returns the wrap angles α of the drum and of a belt's other wheel, rad.
template <class S> std::array<S, 2> angles_of(const Group::ElementData& entry, const Group::Flow<S>& flow) {
  const WoundMeasure& first = entry.parts[0].measure;
  if (!entry.is_belt) {
    const S turned = entry.parts[1].measure.turned(flow.straight[1].u) - first.turned(flow.straight[0].u);
    return {S(entry.angle) + S(entry.sense) * turned, S(0.0)};
  }
  using portable::atan2;
  const S half_turned = atan2(S(std::abs(first.radius_a) + entry.far_sign * std::abs(first.radius_b)), flow.straight[0].length);
  return {S(std::numbers::pi) + S(2.0) * half_turned, S(std::numbers::pi) + S(2.0 * entry.far_sign) * half_turned};
}

// Returns the ratio E of the drum or wheel on which the band slides first (the smallest μ α).
template <class S> S ratio_of(const Group::ElementData& entry, const std::array<S, 2>& angles) {
  const S at_drum = S(entry.friction[0]) * angles[0];
  if (!entry.is_belt) return exponential(at_drum);
  const S at_other = S(entry.friction[1]) * angles[1];
  return exponential(value_of(at_other) < value_of(at_drum) ? at_other : at_drum);
}

// Computes T_i and ṡ from τ_i and E.
template <class S> void find_tensions(const Group::ElementData& entry, UnitMode mode, Group::Flow<S>& flow) {
  const auto& [first, second] = flow.resting;
  const S c0(entry.time * entry.parts[0].stiffness), c1(entry.time * entry.parts[1].stiffness);
  if (mode == Group::k_to_second) flow.slip = (second - flow.ratio * first) / (c1 + flow.ratio * c0);
  else if (mode == Group::k_to_first) flow.slip = (flow.ratio * second - first) / (c0 + flow.ratio * c1);
  const bool is_taut = mode >= Group::k_sticks;
  flow.tension = is_taut ? std::array<S, 2>{first + c0 * flow.slip, second - c1 * flow.slip} : std::array<S, 2>{S(0.0), S(0.0)};
  if (is_taut) return;
  // Loose band: s follows the value at which both parts have equal tension.
  const S k0(entry.parts[0].stiffness), k1(entry.parts[1].stiffness);
  flow.slip = (k1 * flow.rate[1] - k0 * flow.rate[0]) / (k0 + k1);
}

template <class S>
Group::Flow<S> flow_with(const Group::ElementData& entry, const std::array<Motion<S>, 3>& motion, const S& s, UnitMode mode) {
  Group::Flow<S> flow;
  for (std::size_t i = 0; i < 2; ++i) {
    const Group::Part& part = entry.parts[i];
    flow.straight[i] = part.measure.straight(motion[0], motion[i + 1]);
    flow.measured[i] = part.measure.along(flow.straight[i], motion[0], motion[i + 1]);
    flow.stretch[i] = -flow.measured[i].value - S(part.free) + (i == 0 ? s : -s);
    flow.rate[i] = -flow.measured[i].rate;
    flow.resting[i] = S(part.stiffness) * (flow.stretch[i] + S(entry.time) * flow.rate[i]);
  }
  flow.angles = angles_of(entry, flow);
  flow.ratio = ratio_of(entry, flow.angles);
  find_tensions(entry, mode, flow);
  return flow;
}

Group::Flow<D18> seeded_flow(const Group::ElementData& entry, const Evaluation& e) {
  const std::array<int, 3> bodies = entry.bodies();
  const std::array<Motion<D18>, 3> motion = {seeded_of<3>(e.motion[bodies[0]], 0), seeded_of<3>(e.motion[bodies[1]], 1),
                                             seeded_of<3>(e.motion[bodies[2]], 2)};
  return flow_with<D18>(entry, motion, D18(e.inner[entry.inner]), e.mode[entry.unit]);
}

// Derivatives ∂T_i/∂s and ∂ṡ/∂s. During sliding the tensions depend only on the total elongation, in which s cancels.
struct ByState {
  std::array<double, 2> tension{0.0, 0.0};
  double slip = 0.0;
};
ByState by_state(const Group::ElementData& entry, UnitMode mode) {
  const double k0 = entry.parts[0].stiffness, k1 = entry.parts[1].stiffness;
  ByState by;
  if (mode < Group::k_sticks) return by;
  // Equals −(k_1 + E k_0)/(c_1 + E c_0), or the corresponding value for the other direction.
  if (mode != Group::k_sticks) by.slip = -1.0 / entry.time;
  by.tension = {k0 * (1.0 + entry.time * by.slip), -k1 * (1.0 + entry.time * by.slip)};
  return by;
}

// Returns the stiffness of both parts in series, N/m.
double joint_stiffness(const Group::ElementData& entry) {
  const double k0 = entry.parts[0].stiffness, k1 = entry.parts[1].stiffness;
  return k0 * k1 / (k0 + k1);
}

double stored(const Group::ElementData& entry, const Group::Flow<double>& flow) {
  return 0.5 *
         (entry.parts[0].stiffness * flow.stretch[0] * flow.stretch[0] + entry.parts[1].stiffness * flow.stretch[1] * flow.stretch[1]);
}

} // namespace

SlidingBandGroup::Flow<double> SlidingBandGroup::flow_of(const ElementData& entry, const Motion<double>* motion, double s, UnitMode mode) {
  return flow_with<double>(entry, {motion[entry.drum], motion[entry.parts[0].end], motion[entry.parts[1].end]}, s, mode);
}

double SlidingBandGroup::balanced(const ElementData& entry, const Flow<double>& flow, double s) {
  const double k0 = entry.parts[0].stiffness, k1 = entry.parts[1].stiffness;
  return s + (k1 * flow.stretch[1] - k0 * flow.stretch[0]) / (k0 + k1);
}

void SlidingBandGroup::check(const ElementData& entry, const Flow<double>& flow) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (flow.straight[i].length < entry.parts[i].shortest)
      throw ElementFailure("what '" + entry.name + "' is fastened to has run onto its drum: a limit keeps it off", {entry.name});
    if (!entry.is_belt && std::abs(entry.parts[i].measure.turned(flow.straight[i].u)) > k_most_turned)
      throw ElementFailure("a free part of '" + entry.name +
                               "' has turned by half a turn against the reference pose: so far it is not followed",
                           {entry.name});
  }
  if (!(flow.angles[0] > 0.0))
    throw ElementFailure("'" + entry.name + "' has come off its drum: its free parts meet no longer there", {entry.name});
}

void SlidingBandGroup::event_value(const ElementData& entry, const Flow<double>& flow, UnitMode mode, Evaluation& e) {
  double* const event_value = e.event_value + entry.first_event;
  double* const rate = e.event_derivative + entry.first_event;
  const double sum = flow.stretch[0] + flow.stretch[1], growth = flow.rate[0] + flow.rate[1];
  rate[0] = rate[1] = std::numeric_limits<double>::quiet_NaN();
  if (!is_taut(mode)) return whole(entry).event_value(-sum, -growth, contact_mode(mode), event_value, rate);
  if (mode == k_sticks) {
    const double slack = slack_of(entry, flow);
    event_value[0] = flow.ratio * flow.resting[0] - flow.resting[1] + slack;
    event_value[1] = flow.ratio * flow.resting[1] - flow.resting[0] + slack;
  } else {
    event_value[0] = mode == k_to_second ? flow.slip : -flow.slip;
    event_value[1] = sum + entry.time * growth;
  }
}

void SlidingBandGroup::add_forces(Evaluation& e) const {
  for (const ElementData& entry : entries) {
    const UnitMode mode = e.mode[entry.unit];
    const Flow<double> flow = flow_of(entry, e.motion, e.inner[entry.inner], mode);
    check(entry, flow);
    event_value(entry, flow, mode, e);
    e.inner_rate[entry.inner] = flow.slip;
    if (!is_taut(mode)) {
      const double sum = flow.stretch[0] + flow.stretch[1];
      if (mode == k_let_go) e.dissipation -= joint_stiffness(entry) * sum * (flow.rate[0] + flow.rate[1]);
      continue;
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const MeasureValue<double>& m = flow.measured[i];
      add_at(e.force[entry.drum], m.lever_a, flow.tension[i] * m.direction);
      add_at(e.force[entry.parts[i].end], m.lever_b, -flow.tension[i] * m.direction);
      const double stretching = flow.rate[i] + (i == 0 ? flow.slip : -flow.slip);
      e.dissipation += flow.tension[i] * flow.rate[i] - entry.parts[i].stiffness * flow.stretch[i] * stretching;
    }
  }
}

double SlidingBandGroup::inner_energy(const Motion<double>* motion, const double* inner) const {
  double sum = 0.0;
  for (const ElementData& entry : entries) {
    // For s in balance, as in a loose band, the energy is that of both parts in series.
    const Flow<double> flow = flow_of(entry, motion, inner[entry.inner], k_sticks);
    if (flow.stretch[0] + flow.stretch[1] > 0.0) sum += stored(entry, flow);
  }
  return sum;
}

// Corrects s. In a loose band its rate follows the motion only within the error of the method. A taut band at rest beyond its bound is
// moved to the bound, as if it had slid, because an equilibrium requires this.
double SlidingBandGroup::project_inner(const Evaluation& e, double* inner) const {
  double dissipated = 0.0;
  for (const ElementData& entry : entries) {
    const UnitMode mode = e.mode[entry.unit];
    double& s = inner[entry.inner];
    const Flow<double> flow = flow_of(entry, e.motion, s, mode);
    if (!is_taut(mode)) {
      s = balanced(entry, flow, s);
      continue;
    }
    if (flow.rate[0] != 0.0 || flow.rate[1] != 0.0) continue;
    const double over_second = flow.resting[1] - flow.ratio * flow.resting[0], over_first = flow.resting[0] - flow.ratio * flow.resting[1];
    const double k0 = entry.parts[0].stiffness, k1 = entry.parts[1].stiffness;
    double moved = 0.0;
    if (over_second > 0.0) moved = over_second / (k1 + flow.ratio * k0);
    else if (over_first > 0.0) moved = -over_first / (k0 + flow.ratio * k1);
    if (moved == 0.0) continue;
    dissipated += stored(entry, flow) - stored(entry, flow_of(entry, e.motion, s + moved, mode));
    s += moved;
  }
  return dissipated;
}

double SlidingBandGroup::jump_inner(int element, UnitMode to, const Evaluation& e, double* inner) const {
  const ElementData& entry = entries[static_cast<std::size_t>(element)];
  if (is_taut(to)) return 0.0;
  double& s = inner[entry.inner];
  const Flow<double> before = flow_of(entry, e.motion, s, to);
  s = balanced(entry, before, s);
  const Flow<double> after = flow_of(entry, e.motion, s, to);
  const auto energy = [&](const Flow<double>& flow) { return flow.stretch[0] + flow.stretch[1] > 0.0 ? stored(entry, flow) : 0.0; };
  return energy(before) - energy(after);
}

void SlidingBandGroup::add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const {
  for (const ElementData& entry : entries) {
    const Flow<D18> flow = seeded_flow(entry, e);
    std::array<BodyForceOf<D18>, 3> forces;
    for (std::size_t i = 0; i < 2; ++i) {
      const MeasureValue<D18>& m = flow.measured[i];
      add_at(forces[0], m.lever_a, flow.tension[i] * m.direction);
      add_at(forces[i + 1], m.lever_b, -flow.tension[i] * m.direction);
    }
    add_body_blocks<3>(entry.bodies(), forces, out);
  }
}

void SlidingBandGroup::add_state_jacobian(const Evaluation& e, StateJacobian& out) const {
  for (const ElementData& entry : entries) {
    const Flow<D18> flow = seeded_flow(entry, e);
    const ByState by = by_state(entry, e.mode[entry.unit]);
    add_rate_by_motion<3>(entry.inner, entry.bodies(), flow.slip, out);
    out.by_state.push_back({entry.inner, entry.inner, by.slip});
    for (std::size_t i = 0; i < 2; ++i) {
      const MeasureValue<D18>& m = flow.measured[i];
      const Vec3 on_drum(m.direction.x.v, m.direction.y.v, cross(m.lever_a, m.direction).v);
      const Vec3 on_end(-m.direction.x.v, -m.direction.y.v, -cross(m.lever_b, m.direction).v);
      if (entry.drum != k_ground) out.forces.push_back({entry.drum, entry.inner, by.tension[i] * on_drum});
      if (entry.parts[i].end != k_ground) out.forces.push_back({entry.parts[i].end, entry.inner, by.tension[i] * on_end});
    }
  }
}

void SlidingBandGroup::mark_bodies(std::vector<char>& is_used) const {
  for (const ElementData& entry : entries)
    for (const int body : entry.bodies()) is_used[body] = 1;
}

void SlidingBandGroup::register_turns(TurnTable& turns) const {
  for (const ElementData& entry : entries)
    for (const Part& part : entry.parts) turns.add(entry.drum, part.end, turning_of(part.measure));
}

// --- modes ------------------------------------------------------------------------------------------

UnitMode SlidingBandGroup::contact_mode(UnitMode mode) {
  if (mode == k_loose) return k_contact_open;
  return mode == k_let_go ? k_contact_released : k_contact_pressed;
}

UnitMode SlidingBandGroup::mode_by_ratio(const ElementData& entry, const Flow<double>& flow) {
  const double slack = slack_of(entry, flow);
  if (flow.resting[1] > flow.ratio * flow.resting[0] + slack) return k_to_second;
  return flow.resting[0] > flow.ratio * flow.resting[1] + slack ? k_to_first : k_sticks;
}

double SlidingBandGroup::rounding_of(const ElementData& entry, const Evaluation& e, const Flow<double>& flow) {
  double sum = 0.0;
  const Motion<double>& drum = e.motion[entry.drum];
  for (std::size_t i = 0; i < 2; ++i) {
    const WoundMeasure& m = entry.parts[i].measure;
    const Motion<double>& end = e.motion[entry.parts[i].end];
    const double wound =
        std::abs(m.taken) + std::abs(m.radius_a * drum.theta) + std::abs(m.radius_b * end.theta) + std::abs(e.inner[entry.inner]);
    sum += value_rounding(flow.measured[i], drum, end) + k_rounded_sum * wound;
  }
  return sum;
}

UnitMode SlidingBandGroup::initial_mode(int element, const Evaluation& e) const {
  const ElementData& entry = entries[static_cast<std::size_t>(element)];
  const Flow<double> flow = flow_of(entry, e.motion, e.inner[entry.inner], k_sticks);
  const UnitMode mode = whole(entry).initial_mode(-(flow.stretch[0] + flow.stretch[1]), -(flow.rate[0] + flow.rate[1]));
  if (mode != k_contact_pressed) return mode == k_contact_open ? k_loose : k_let_go;
  return mode_by_ratio(entry, flow);
}

UnitMode SlidingBandGroup::next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const {
  const ElementData& entry = entries[static_cast<std::size_t>(element)];
  const Flow<double> flow = flow_of(entry, e.motion, e.inner[entry.inner], mode);
  const double value = -(flow.stretch[0] + flow.stretch[1]), rate = -(flow.rate[0] + flow.rate[1]), rounding = rounding_of(entry, e, flow);
  const KelvinVoigtContact law = whole(entry);
  const auto of_contact = [&](UnitMode contact) {
    if (contact == k_contact_pressed) return mode_by_ratio(entry, flow);
    return contact == k_contact_open ? k_loose : k_let_go;
  };
  if (!is_taut(mode)) return of_contact(law.next_mode(contact_mode(mode), slot, value, rate, rounding));
  // At zero tension both bounds coincide.
  const bool is_without = law.unclamped_force(value, rate) <= rounding;
  if (is_without || (mode != k_sticks && slot == 1)) return of_contact(law.next_mode(k_contact_pressed, 0, value, rate, rounding));
  if (mode == k_sticks) return slot == 0 ? k_to_second : k_to_first;
  return k_sticks;
}

bool SlidingBandGroup::is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const {
  if (is_taut(mode)) return false;
  const ElementData& entry = entries[static_cast<std::size_t>(element)];
  const Flow<double> flow = flow_of(entry, e.motion, e.inner[entry.inner], mode);
  return whole(entry).is_armed_at_entry(contact_mode(mode), slot, -(flow.stretch[0] + flow.stretch[1]), rounding_of(entry, e, flow));
}

EventKind SlidingBandGroup::event_kind(UnitMode from, UnitMode to) const {
  if (is_taut(from) && is_taut(to)) {
    if (to == k_sticks) return EventKind::sticks;
    return to == k_to_second ? EventKind::slips_forward : EventKind::slips_backward;
  }
  if (to == k_loose) return EventKind::enters_gap;
  if (from == k_loose) return EventKind::closes_gap;
  return to == k_let_go ? EventKind::force_reaches_zero : EventKind::force_returns;
}

} // namespace steplap
