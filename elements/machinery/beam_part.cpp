#include "elements/machinery/beam_part.h"

#include "mbd/formula/formula_program.h"
#include "mbd/system/law_group.h"
#include "mbd/system/system.h"

#include <vector>

namespace steplap {

namespace {

struct PartEntry {
  int a = k_ground, b = k_ground;
  Vec2 point_a, point_b, axis; ///< positions of the markers; unit vector along the beam in the frame of b
  double angle = 0.0;          ///< θ_A − θ_B without load, rad
  double k_x = 0.0, k_v = 0.0, k_theta = 0.0, time = 0.0;
  double by_v = 0.0, by_theta = 0.0; ///< coefficients of v² and θ² in q
  int link = 0;
};

/// Coordinates of the part, and the internal forces along them.
template <class S> struct PartState {
  S u{0}, v{0}, theta{0}, c{1}, s{0}; ///< c, s: cosine and sine of θ/2
  S q{0}, q_rate{0}, v_rate{0}, theta_rate{0};
  S tension{0}, shear{0}, moment{0};
  Pair<S> x_axis, lever_a, lever_b; ///< axis of b's marker; levers from the centres to marker a
};

template <class S, class B> Pair<S> velocity_seen(const Motion<S>& a, const Pair<S>& lever_a, const B& b, const Pair<S>& lever_b) {
  if constexpr (k_is_origin<B>) return point_velocity(a, lever_a);
  else return point_velocity(a, lever_a) - point_velocity(b, lever_b);
}

template <class S, class B> PartState<S> state_of(const PartEntry& entry, const Motion<S>& a, const B& b) {
  PartState<S> p;
  p.lever_a = to_ground(a, entry.point_a);
  p.lever_b = offset(a, b) + p.lever_a;
  const Pair<S> x = to_ground(b, entry.axis), y = perp(x), d = p.lever_b - Pair<S>(to_ground(b, entry.point_b));
  const Pair<S> velocity = velocity_seen(a, p.lever_a, b, p.lever_b);
  p.x_axis = x;
  p.theta = relative_angle(a, b) - S(entry.angle);
  p.theta_rate = relative_spin(a, b);
  formula_math::turn(S(0.5) * p.theta, p.s, p.c);
  const S along = dot(x, d), across = dot(y, d), along_rate = dot(x, velocity), across_rate = dot(y, velocity);
  p.u = p.c * along + p.s * across;
  p.v = p.c * across - p.s * along;
  const S half_rate = S(0.5) * p.theta_rate, u_rate = p.c * along_rate + p.s * across_rate + half_rate * p.v;
  p.v_rate = p.c * across_rate - p.s * along_rate - half_rate * p.u;
  p.q = p.u + S(entry.by_v) * p.v * p.v - S(entry.by_theta) * p.theta * p.theta;
  p.q_rate = u_rate + S(2.0 * entry.by_v) * p.v * p.v_rate - S(2.0 * entry.by_theta) * p.theta * p.theta_rate;
  p.tension = S(entry.k_x) * (p.q + S(entry.time) * p.q_rate);
  p.shear = S(entry.k_v) * (p.v + S(entry.time) * p.v_rate);
  p.moment = S(entry.k_theta) * (p.theta + S(entry.time) * p.theta_rate);
  return p;
}

/// Force on a at its marker, and moment on a.
template <class S> struct PartWrench {
  Pair<S> force;
  S couple{0};
};

template <class S> PartWrench<S> wrench_of(const PartEntry& entry, const PartState<S>& p) {
  const S f_u = -p.tension, f_v = -p.shear - S(2.0 * entry.by_v) * p.tension * p.v;
  const S f_theta = -p.moment + S(2.0 * entry.by_theta) * p.tension * p.theta;
  const Pair<S> y = perp(p.x_axis);
  // The axes rotate with θ/2: ∂u/∂θ = v/2, ∂v/∂θ = −u/2.
  return {(p.c * f_u - p.s * f_v) * p.x_axis + (p.s * f_u + p.c * f_v) * y, f_theta + S(0.5) * (f_u * p.v - f_v * p.u)};
}

class BeamPartGroup final : public ForceGroup {
public:
  using ElementData = PartEntry;
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override { add_forces_to(e); }
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override {
    add_forces_to(e);
    return true;
  }
  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries) {
      const auto p = state_of(entry, motion[entry.a], motion[entry.b]);
      sum += 0.5 * (entry.k_x * p.q * p.q + entry.k_v * p.v * p.v + entry.k_theta * p.theta * p.theta);
    }
    return sum;
  }
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      const auto p = state_of(entry, seeded(e.motion[entry.a], 0), seeded(e.motion[entry.b], 3));
      const auto w = wrench_of(entry, p);
      const Dual<12> on_a = cross(p.lever_a, w.force) + w.couple, on_b = cross(p.lever_b, w.force) + w.couple;
      const Dual<12> rows[6] = {w.force.x, w.force.y, on_a, -w.force.x, -w.force.y, -on_b};
      PairJacobian& j = out.emplace_back();
      j.a = entry.a;
      j.b = entry.b;
      for (int i = 0; i < 6; ++i) {
        j.stiffness.row(i) = rows[i].d.template head<6>().matrix().transpose();
        j.damping.row(i) = rows[i].d.template tail<6>().matrix().transpose();
      }
    }
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
  }
  void register_links(LinkTable& links) override {
    for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
  }
  [[nodiscard]] PartState<double> now(int i, const Evaluation& e) const {
    const ElementData& entry = entries[static_cast<std::size_t>(i)];
    return state_of(entry, e.motion[entry.a], e.motion[entry.b]);
  }

private:
  template <class S> void add_forces_to(EvaluationData<S>& e) const {
    for (const ElementData& entry : entries) {
      const PartState<S> p = state_of(entry, e.link_motion[entry.link], Origin{});
      const PartWrench<S> w = wrench_of(entry, p);
      BodyForceOf<S>& sum = e.link_force[entry.link];
      sum.fx += w.force.x;
      sum.fy += w.force.y;
      sum.m += cross(p.lever_a, w.force) + w.couple;
      if (entry.time != 0.0)
        e.dissipation += S(entry.time) * (S(entry.k_x) * p.q_rate * p.q_rate + S(entry.k_v) * p.v_rate * p.v_rate +
                                          S(entry.k_theta) * p.theta_rate * p.theta_rate);
    }
  }
};

void compile_beam_part(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const BeamPart&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("joins a body to itself: name markers on two different bodies");
  if (e.axis.norm() == 0.0) return builder.error("'axis' has no direction");
  const double h = e.length, bends = h * h * h / (12.0 * e.bending_stiffness), shears = e.shear_stiffness ? h / *e.shear_stiffness : 0.0;
  const double share = bends / (bends + shears);
  PartEntry entry{a.body, b.body, a.point, b.point, builder.direction(b, e.axis)};
  entry.angle = builder.reference(a.body).theta - builder.reference(b.body).theta;
  entry.k_x = e.axial_stiffness / h;
  entry.k_v = 1.0 / (bends + shears);
  entry.k_theta = e.bending_stiffness / h;
  entry.time = e.damping_time;
  entry.by_v = (0.5 + 0.1 * share * share) / h;
  entry.by_theta = h / 12.0;
  BeamPartGroup& group = builder.group<BeamPartGroup>();
  group.entries.push_back(entry);
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("tension", "N", {"along the beam, in the middle of the part", "positive: it pulls"},
                      [&group, i](const Snapshot& s) { return group.now(i, *s.evaluation).tension; });
  builder.add_channel("shear", "N",
                      {"across the beam, in the middle of the part", "positive: it draws the half ahead to the right of the axis"},
                      [&group, i](const Snapshot& s) { return group.now(i, *s.evaluation).shear; });
  builder.add_channel("moment", "N m", {"bending moment in the middle of the part", "positive: the half ahead is turned counter-clockwise"},
                      [&group, i](const Snapshot& s) { return group.now(i, *s.evaluation).moment; });
}

} // namespace

const ElementKind& beam_part_kind() {
  static const ElementKind kind = [] {
    using T = BeamPart;
    ElementKind k;
    k.name = "beam_part";
    k.doc = "A part of an elastic beam between two bodies that carry its halves: its markers lie together in its middle. "
            "Without load in the reference pose. `[[beam]]` makes a beam of such parts.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("its middle, on the body ahead");
    f.add("b", &T::b).as(FieldType::marker).doc("its middle, on the body behind, whose axes count");
    f.add("axis", &T::axis).doc("direction along the beam from b to a, in marker b's axes");
    f.add("length", &T::length).in("m").positive().required().doc("of the part");
    f.add("axial_stiffness", &T::axial_stiffness).in("N").positive().required().doc("E A: modulus times area");
    f.add("bending_stiffness", &T::bending_stiffness).in("N m^2").positive().required().doc("E I: modulus times second moment of area");
    f.add("shear_stiffness", &T::shear_stiffness).in("N").positive().doc("shear modulus times shear area; not given: it does not shear");
    f.add("damping_time", &T::damping_time).in("s").not_negative().doc("what its dampers have of its stiffnesses");
    k.example = R"([[element]]
name = 'part'
kind = 'beam_part'
a = 'a'
b = 'b'
length = 0.5
axial_stiffness = 1e4
bending_stiffness = 1e3
)";
    k.holds<T>();
    k.compile = compile_beam_part;
    return k;
  }();
  return kind;
}

} // namespace steplap
