// All elements with the same measure (measure.h) and the same force law, in one array that is evaluated in one loop.
//
// A law is a value type with
//
//   static constexpr int k_event_count           0: smooth everywhere; n: a unit with n event functions
//   static constexpr bool k_is_contact       true: its force is a normal force, available to friction
//   S force(S value, S rate, mode)           force along the gradient of the measure
//   S elastic_force(S value, mode)           −dU/dvalue of the stored energy, smooth within a mode
//   double energy(value)                     U
//
// and, if k_event_count > 0, initial_mode(), next_mode() (with the rounding error of the value), event_value() and event_kind(); optionally
// is_armed_at_entry(). A law with k_has_events_beyond_rounding also gets the rounding errors of value and rate in event_value(), and
// defines event_tolerance(slot). The law dissipates (elastic_force − force)·rate. A law whose functions take only double instead of S
// cannot be recorded for machine code (mbd/tape/traced.h).
#pragma once

#include "mbd/base/dual.h"
#include "mbd/system/gap_source.h"
#include "mbd/system/roles.h"
#include "mbd/system/rounding.h"
#include "mbd/system/turn_table.h"

#include <type_traits>

namespace steplap {

/// Returns the motion of body j of N bodies as dual numbers. The derivatives by its pose have the indices 3 j …, those by its velocity 3 N
/// + 3 j ….
template <int N> [[nodiscard]] Motion<Dual<6 * N>> seeded_of(const Motion<double>& m, int j) {
  using D = Dual<6 * N>;
  const int pose = 3 * j, velocity = 3 * N + 3 * j;
  Motion<D> s;
  s.x = D::variable(m.x, pose);
  s.y = D::variable(m.y, pose + 1);
  s.theta = D::variable(m.theta, pose + 2);
  s.c = D(m.c);
  s.c.d[pose + 2] = -m.s;
  s.s = D(m.s);
  s.s.d[pose + 2] = m.c;
  s.vx = D::variable(m.vx, velocity);
  s.vy = D::variable(m.vy, velocity + 1);
  s.omega = D::variable(m.omega, velocity + 2);
  return s;
}

/// Returns the motion of one of two bodies as dual numbers: body 0 for `first` = 0, body 1 for `first` = 3.
inline Motion<Dual<12>> seeded(const Motion<double>& m, int first) { return seeded_of<2>(m, first / 3); }

/// Computes a force along a measure from force(value, rate), and appends its derivatives by poses and velocities of a and b. Returns the
/// force with its derivatives.
template <class Measure, class Force>
Dual<12> add_pair_jacobian(int a, int b, const Measure& measure, const Evaluation& e, const Force& force, std::vector<PairJacobian>& out) {
  const auto m = measure.template at<false, Dual<12>>(seeded(e.motion[a], 0), seeded(e.motion[b], 3));
  const Dual<12> f = force(m.value, m.rate);
  const Pair<Dual<12>> d = f * m.direction;
  const Dual<12> couple_a = cross(m.lever_a, d) + f * m.couple;
  const Dual<12> couple_b = cross(m.lever_b, d) + f * m.couple;
  const Dual<12> rows[6] = {d.x, d.y, couple_a, -d.x, -d.y, -couple_b};
  PairJacobian& j = out.emplace_back();
  j.a = a;
  j.b = b;
  for (int i = 0; i < 6; ++i) {
    j.stiffness.row(i) = rows[i].d.template head<6>().matrix().transpose();
    j.damping.row(i) = rows[i].d.template tail<6>().matrix().transpose();
  }
  return f;
}

/// Returns the law's is_armed_at_entry() (ForceGroup); false if the law does not define it.
template <class Law> [[nodiscard]] bool is_armed_at_entry(const Law& law, UnitMode mode, int slot, double value, double rounding) {
  if constexpr (requires { law.is_armed_at_entry(mode, slot, value, rounding); }) return law.is_armed_at_entry(mode, slot, value, rounding);
  return false;
}

template <class Law> inline constexpr bool k_has_events_beyond_rounding = requires { requires Law::k_has_events_beyond_rounding; };

/// Laws whose functions are templates over the number type; these can be recorded for machine code.
template <class Law>
concept TraceableLaw = requires(const Law& law, const TapeNumber& x, TapeNumber* event_value) {
  law.elastic_force(x, UnitMode{});
  requires Law::k_event_count == 0 || k_has_events_beyond_rounding<Law> ||
                   requires { law.event_value(x, x, UnitMode{}, event_value, event_value); };
};

/// Base class of groups that are not contacts, in place of GapSource.
struct NoGaps {};

template <class Measure, class Law>
class LawGroup final : public ForceGroup, public std::conditional_t<Law::k_is_contact, GapSource, NoGaps> {
public:
  struct ElementData {
    int a = k_ground, b = k_ground;
    Measure measure;
    Law law;
    int link = 0;        ///< slot of (a, b) in the arrays of motions and forces
    int unit = 0;        ///< index of its mode
    int first_event = 0; ///< index of its first event function
    int contact = 0;     ///< index of its normal force
  };
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override { add_forces_to(e); }
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override {
    if constexpr (TraceableLaw<Law>) add_forces_to(e);
    return TraceableLaw<Law>;
  }

  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries) sum += energy_of(entry, motion);
    return sum;
  }

  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      const auto law = [&](const Dual<12>& value, const Dual<12>& rate) { return entry.law.force(value, rate, mode_of(entry, e)); };
      const Dual<12> f = add_pair_jacobian(entry.a, entry.b, entry.measure, e, law, out);
      if constexpr (Law::k_is_contact) {
        out.back().contact = entry.contact;
        out.back().normal = f.d.matrix();
      }
    }
  }

  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
  }

  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries) {
      turns.add(entry.a, entry.b, turning_of(entry.measure));
      if constexpr (std::is_same_v<Measure, AngleMeasure> && requires { entry.law.knots(); })
        for (TurnKnots& knots : entry.law.knots()) turns.add(entry.a, entry.b, std::move(knots));
    }
  }
  void register_links(LinkTable& links) override {
    for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
  }

  [[nodiscard]] const GapSource* gap_source() const override {
    if constexpr (Law::k_is_contact) return this;
    else return nullptr;
  }
  /// Overrides GapSource::add_gaps() for laws that are contacts.
  void add_gaps(const Motion<double>* motion, std::vector<GapBounds>& out) const {
    if constexpr (Law::k_is_contact)
      for (const ElementData& entry : entries) {
        out.push_back(gap_bounds(entry.measure, entry.law.offset, motion[entry.a], motion[entry.b]));
        out.back().a = entry.a;
        out.back().b = entry.b;
      }
  }

  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override {
    if constexpr (Law::k_event_count > 0) {
      const auto m = measured(element, e);
      return entries[element].law.initial_mode(m.value, m.rate);
    }
    return 0;
  }
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    if constexpr (Law::k_event_count > 0) {
      const auto m = measured(element, e);
      return entries[element].law.next_mode(mode, slot, m.value, m.rate, rounding_of(element, m, e));
    }
    return mode;
  }
  [[nodiscard]] bool is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    const auto m = measured(element, e);
    return steplap::is_armed_at_entry(entries[element].law, mode, slot, m.value, rounding_of(element, m, e));
  }
  [[nodiscard]] EventTolerance event_tolerance(int slot) const override {
    if constexpr (k_has_events_beyond_rounding<Law>) return Law::event_tolerance(slot);
    return EventTolerance::none;
  }
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override {
    if constexpr (Law::k_event_count > 0) return Law::event_kind(from, to);
    return EventKind::none;
  }

  /// Returns value and rate of one element's measure, for channels.
  [[nodiscard]] MeasureValue<double> measured(int element, const Evaluation& e) const {
    const ElementData& entry = entries[element];
    return entry.measure.template at<false, double>(e.motion[entry.a], e.motion[entry.b]);
  }
  [[nodiscard]] double force_of(int element, const Evaluation& e) const {
    const auto m = measured(element, e);
    return entries[element].law.force(m.value, m.rate, mode_of(entries[element], e));
  }

private:
  [[nodiscard]] double rounding_of(int element, const MeasureValue<double>& m, const Evaluation& e) const {
    return value_rounding(m, e.motion[entries[element].a], e.motion[entries[element].b]);
  }
  template <class S> STEPLAP_INLINE void add_forces_to(EvaluationData<S>& e) const {
    S dissipation{0.0}; // a local variable, since a sum in memory would make each element wait for the one before
    for (const ElementData& entry : entries) dissipation += add_force_to(entry, e);
    e.dissipation += dissipation;
  }

  /// Adds the force of one element and writes its event functions. Returns the dissipated power, W.
  template <class S> STEPLAP_INLINE static S add_force_to(const ElementData& entry, EvaluationData<S>& e) {
    const auto m = entry.measure.template at<false, S>(e.link_motion[entry.link], Origin{});
    const S f = entry.law.force(m.value, m.rate, mode_of(entry, e));
    if constexpr (Law::k_is_contact) e.contact_force[entry.contact] = f;
    if constexpr (k_has_events_beyond_rounding<Law>) {
      const Motion<S>&a = e.motion[entry.a], &b = e.motion[entry.b];
      entry.law.event_value(m.value, m.rate, mode_of(entry, e), S(k_met) + value_rounding(m, a, b), S(k_met) + rate_rounding(m, a, b),
                            e.event_value + entry.first_event, e.event_derivative + entry.first_event);
    } else if constexpr (Law::k_event_count > 0) {
      entry.law.event_value(m.value, m.rate, mode_of(entry, e), e.event_value + entry.first_event, e.event_derivative + entry.first_event);
    }
    if (!is_structural_zero(f)) apply_force(e.link_force[entry.link], m, f);
    return (entry.law.elastic_force(m.value, mode_of(entry, e)) - f) * m.rate;
  }

  static double energy_of(const ElementData& entry, const Motion<double>* motion) {
    return entry.law.energy(entry.measure.template at<false, double>(motion[entry.a], motion[entry.b]).value);
  }

  template <class S> static UnitMode mode_of(const ElementData& entry, const EvaluationData<S>& e) {
    if constexpr (Law::k_event_count > 0) return e.mode[entry.unit];
    return 0;
  }
};

} // namespace steplap
