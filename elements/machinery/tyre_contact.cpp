#include "elements/machinery/tyre_contact.h"

#include "mbd/system/law_group.h"
#include "mbd/system/row_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

using D12 = Dual<12>;

// Bits of a mode: two for the contact, two for the tread; one if the wheel rotates as in rolling forward; one if it rotates so fast that
// the damping of its bristles is reduced.
enum Sliding : UnitMode { k_adheres = 0, k_slides_forward = 1, k_slides_backward = 2 };

UnitMode contact_of(UnitMode mode) { return mode & 3U; }
UnitMode sliding_of(UnitMode mode) { return mode >> 2U & 3U; }
bool turns_forward(UnitMode mode) { return (mode >> 4U & 1U) != 0; }
bool turns_fast(UnitMode mode) { return (mode >> 5U & 1U) != 0; }
struct WheelSpin {
  bool is_forward = false, is_fast = false;
};
WheelSpin spin_in(UnitMode mode) { return {turns_forward(mode), turns_fast(mode)}; }
UnitMode mode_of(UnitMode contact, UnitMode sliding, WheelSpin turning) {
  return contact | sliding << 2U | (turning.is_forward ? 1U : 0U) << 4U | (turning.is_fast ? 1U : 0U) << 5U;
}

// Returns the damping b of bristles that pass with the rolling velocity V.
template <class S> S damping_at(const TreadLaw& law, const S& through, UnitMode mode) {
  return turns_fast(mode) ? S(law.slow() * law.damping) / through : S(law.damping);
}

template <class S>
TreadState<S> tread_at(const TyreGroup::ElementData& entry, const WheelMotion<S>& w, const S& p, const S& normal, UnitMode mode) {
  const TreadLaw& law = entry.tread;
  TreadState<S> t;
  t.bent = w.tread.value - p;
  if (!tyre_presses(mode)) { // without contact the bristles straighten
    t.rate = S(-law.stiffness / law.damping) * t.bent;
    return t;
  }
  const S through = turns_forward(mode) ? -w.rolling : w.rolling;
  const S held = w.slip_rate - through * t.bent * S(1.0 / law.relaxation), damping = damping_at(law, through, mode);
  t.most = S(law.friction) * normal;
  t.trial = S(law.stiffness) * t.bent + damping * held;
  if (sliding_of(mode) == k_adheres) {
    t.force = t.trial;
    t.rate = held;
  } else {
    t.force = sliding_of(mode) == k_slides_forward ? t.most : -t.most;
    t.rate = (t.force - S(law.stiffness) * t.bent) / damping;
  }
  return t;
}

UnitMode sliding_at(double trial, double most) {
  if (trial > most) return k_slides_forward;
  return trial < -most ? k_slides_backward : k_adheres;
}

// Returns the complete mode for a given mode of the contact; direction of rotation and sliding follow from the motion.
UnitMode mode_with(const TyreGroup::ElementData& entry, const WheelMotion<double>& w, double p, UnitMode contact) {
  const WheelSpin turning{w.rolling<0.0, std::abs(w.rolling)> entry.tread.slow()};
  if (contact != k_contact_pressed) return mode_of(contact, k_adheres, turning);
  const TreadState<double> t =
      tread_at(entry, w, p, entry.press.force(w.gap.value, w.gap.rate, contact), mode_of(contact, k_adheres, turning));
  return mode_of(contact, sliding_at(t.trial, t.most), turning);
}

WheelMotion<double> wheel_at(const TyreGroup::ElementData& entry, const Motion<double>* motion) {
  return entry.measure.at(motion[entry.a], motion[entry.b]);
}

// Quantities for the Jacobians, as dual numbers of the poses (0–5) and velocities (6–11) of a and b.
struct Derivatives {
  WheelMotion<D12> wheel;
  D12 normal;
  TreadState<D12> tread;
  Derivatives(const TyreGroup::ElementData& entry, const Evaluation& e)
      : wheel(entry.measure.at(seeded(e.motion[entry.a], 0), seeded(e.motion[entry.b], 3))),
        normal(entry.press.force(wheel.gap.value, wheel.gap.rate, contact_of(e.mode[entry.unit]))),
        tread(tread_at(entry, wheel, D12(e.inner[entry.inner]), normal, e.mode[entry.unit])) {}
};

void add_along(const MeasureValue<D12>& m, const D12& force, D12* on) {
  const RowGradient<D12> g = gradient_of(m);
  for (int i = 0; i < 6; ++i) on[i] += force * g.j[i];
}

} // namespace

void TyreGroup::add_forces(Evaluation& e) const {
  for (const ElementData& entry : entries) {
    const UnitMode mode = e.mode[entry.unit], contact = contact_of(mode);
    const WheelMotion<double> w = entry.measure.at(e.link_motion[entry.link], Origin{});
    double* const event_value = e.event_value + entry.first_event;
    std::fill_n(e.event_derivative + entry.first_event, k_event_count, std::numeric_limits<double>::quiet_NaN());
    entry.press.event_value(w.gap.value, w.gap.rate, contact, event_value, e.event_derivative + entry.first_event);
    const double normal = entry.press.force(w.gap.value, w.gap.rate, contact);
    const TreadState<double> t = tread_at(entry, w, e.inner[entry.inner], normal, mode);
    e.contact_force[entry.contact] = normal;
    e.inner_rate[entry.inner] = w.tread.rate - t.rate;
    e.dissipation += (entry.press.elastic_force(w.gap.value, contact) - normal) * w.gap.rate + t.force * w.slip_rate -
                     entry.tread.stiffness * t.bent * t.rate;
    event_value[2] = event_value[3] = event_value[4] = event_value[5] = 1.0;
    if (contact != k_contact_pressed) continue;
    apply_force(e.link_force[entry.link], w.gap, normal);
    apply_force(e.link_force[entry.link], w.tread, -t.force);
    const UnitMode sliding = sliding_of(mode);
    if (sliding == k_adheres) {
      event_value[2] = t.most - t.trial;
      event_value[3] = t.most + t.trial;
    } else {
      event_value[2] = (sliding == k_slides_forward ? t.trial : -t.trial) - t.most;
    }
    const double through = turns_forward(mode) ? -w.rolling : w.rolling;
    event_value[4] = through + k_met + rate_rounding(w.tread, e.motion[entry.a], e.motion[entry.b]);
    event_value[5] = turns_fast(mode) ? through - entry.tread.slow() : entry.tread.slow() - through;
  }
}

double TyreGroup::potential(const Motion<double>* motion) const {
  double sum = 0.0;
  for (const ElementData& entry : entries) sum += entry.press.energy(wheel_at(entry, motion).gap.value);
  return sum;
}

double TyreGroup::inner_energy(const Motion<double>* motion, const double* inner) const {
  double sum = 0.0;
  for (const ElementData& entry : entries) {
    const double bent = wheel_at(entry, motion).tread.value - inner[entry.inner];
    sum += 0.5 * entry.tread.stiffness * bent * bent;
  }
  return sum;
}

void TyreGroup::add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const {
  for (const ElementData& entry : entries) {
    const Derivatives d(entry, e);
    D12 on[6];
    add_along(d.wheel.gap, d.normal, on);
    add_along(d.wheel.tread, -d.tread.force, on);
    PairJacobian& j = out.emplace_back();
    j.a = entry.a;
    j.b = entry.b;
    for (int i = 0; i < 6; ++i) {
      j.stiffness.row(i) = on[i].d.template head<6>().matrix().transpose();
      j.damping.row(i) = on[i].d.template tail<6>().matrix().transpose();
    }
    j.contact = entry.contact;
    j.normal = d.normal.d.matrix();
  }
}

// At given s, T and u̇ depend on p only by u = s − p.
void TyreGroup::add_inner_jacobian(const Evaluation& e, std::vector<InnerJacobian>& out) const {
  for (const ElementData& entry : entries) {
    const UnitMode mode = e.mode[entry.unit];
    const Derivatives d(entry, e);
    const bool adheres = tyre_presses(mode) && sliding_of(mode) == k_adheres;
    const double through = (turns_forward(mode) ? -1.0 : 1.0) * d.wheel.rolling.v, passing = through / entry.tread.relaxation;
    const double damping = tyre_presses(mode) ? damping_at(entry.tread, through, mode) : entry.tread.damping;
    const double rate_by_bent = adheres ? -passing : -entry.tread.stiffness / damping;
    const double force_by_bent = adheres ? entry.tread.stiffness - damping * passing : 0.0;
    const RowGradient<D12> g = gradient_of(d.wheel.tread);
    const D12 rate = d.wheel.tread.rate - d.tread.rate; // rate ṗ of the inner state
    InnerJacobian& j = out.emplace_back();
    j.a = entry.a;
    j.b = entry.b;
    j.first = entry.inner;
    j.count = 1;
    for (int i = 0; i < 6; ++i) j.force(i, 0) = force_by_bent * g.j[i].v;
    j.by_pose.row(0) = rate.d.template head<6>().matrix().transpose();
    j.by_velocity.row(0) = rate.d.template tail<6>().matrix().transpose();
    j.by_inner(0, 0) = rate_by_bent;
  }
}

void TyreGroup::relax_inner(const Motion<double>* motion, double* inner) const {
  for (const ElementData& entry : entries) inner[entry.inner] = wheel_at(entry, motion).tread.value;
}

void TyreGroup::mark_bodies(std::vector<char>& is_used) const {
  for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
}

void TyreGroup::register_turns(TurnTable& turns) const {
  for (const ElementData& entry : entries) turns.add(entry.a, entry.b, Turning{moves_by_turning(entry.measure.centre), true});
}

void TyreGroup::register_links(LinkTable& links) {
  for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
}

// If the wheel is higher above the road than the radius of its hollows, another road point may be nearest, but no nearer than this bound.
void TyreGroup::add_gaps(const Motion<double>* motion, std::vector<GapBounds>& out) const {
  for (const ElementData& entry : entries) {
    const WheelMotion<double> w = wheel_at(entry, motion);
    GapBounds bounds;
    bounds.a = entry.a;
    bounds.b = entry.b;
    bounds.gap = w.gap.value - entry.press.offset;
    if (const double hollowest = entry.measure.road->hollowest(); hollowest > 0.0)
      bounds.gap = std::min(bounds.gap, 1.0 / hollowest - entry.press.offset);
    bounds.normal = w.gap.direction;
    bounds.reach_a = entry.measure.centre.norm();
    bounds.reach_b = portable::hypot(w.gap.lever_b.x, w.gap.lever_b.y) + std::max(0.0, bounds.gap);
    out.push_back(bounds);
  }
}

UnitMode TyreGroup::initial_mode(int element, const Evaluation& e) const {
  const ElementData& entry = entries[element];
  const WheelMotion<double> w = measured(element, e);
  return mode_with(entry, w, e.inner[entry.inner], entry.press.initial_mode(w.gap.value, w.gap.rate));
}

UnitMode TyreGroup::next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const {
  const ElementData& entry = entries[element];
  const UnitMode contact = contact_of(mode), sliding = sliding_of(mode);
  if (slot < 2) {
    const WheelMotion<double> w = measured(element, e);
    const double rounding = value_rounding(w.gap, e.motion[entry.a], e.motion[entry.b]);
    const UnitMode next = entry.press.next_mode(contact, slot, w.gap.value, w.gap.rate, rounding);
    return next == contact ? mode : mode_with(entry, w, e.inner[entry.inner], next);
  }
  const WheelSpin turning = spin_in(mode);
  if (slot == 4) return mode_of(contact, sliding, {!turning.is_forward, turning.is_fast});
  if (slot == 5) return mode_of(contact, sliding, {turning.is_forward, !turning.is_fast});
  if (sliding != k_adheres) return mode_of(contact, k_adheres, turning);
  return mode_of(contact, slot == 2 ? k_slides_forward : k_slides_backward, turning);
}

bool TyreGroup::is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const {
  if (slot > 1) return false;
  const ElementData& entry = entries[element];
  const WheelMotion<double> w = measured(element, e);
  return entry.press.is_armed_at_entry(contact_of(mode), slot, w.gap.value, value_rounding(w.gap, e.motion[entry.a], e.motion[entry.b]));
}

EventTolerance TyreGroup::event_tolerance(int slot) const { return slot == 4 ? EventTolerance::velocity : EventTolerance::none; }

EventKind TyreGroup::event_kind(UnitMode from, UnitMode to) const {
  if (contact_of(from) != contact_of(to)) return KelvinVoigtContact::event_kind(contact_of(from), contact_of(to));
  if (sliding_of(from) == sliding_of(to)) return EventKind::none;
  return sliding_of(to) == k_adheres ? EventKind::sticks : sliding_in(to);
}

EventKind TyreGroup::sliding_in(UnitMode mode) const {
  if (!tyre_presses(mode) || sliding_of(mode) == k_adheres) return EventKind::none;
  return sliding_of(mode) == k_slides_forward ? EventKind::slips_forward : EventKind::slips_backward;
}

WheelMotion<double> TyreGroup::measured(int element, const Evaluation& e) const { return wheel_at(entries[element], e.motion); }

double TyreGroup::normal_force(int element, const Evaluation& e) const {
  const ElementData& entry = entries[element];
  const WheelMotion<double> w = measured(element, e);
  return entry.press.force(w.gap.value, w.gap.rate, contact_of(e.mode[entry.unit]));
}

TreadState<double> TyreGroup::tread_state(int element, const Evaluation& e) const {
  const ElementData& entry = entries[element];
  return tread_at(entry, measured(element, e), e.inner[entry.inner], normal_force(element, e), e.mode[entry.unit]);
}

} // namespace steplap
