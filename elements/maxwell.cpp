#include "elements/maxwell.h"

#include "elements/space_distance.h"
#include "mbd/system/law_group.h"
#include "mbd/system/row_gradient.h"
#include "mbd/system/system.h"

namespace steplap {

namespace {

template <class Measure> class MaxwellGroup final : public ForceGroup {
public:
  struct ElementData {
    int a = k_ground, b = k_ground;
    Measure measure;
    double k = 0.0, c = 0.0;
    int inner = 0; ///< stretch of the spring, m
    int link = 0;
  };
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override { add_forces_to(e); }
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override {
    add_forces_to(e);
    return true;
  }
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  [[nodiscard]] double inner_energy(const Motion<double>*, const double* inner) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries) sum += 0.5 * entry.k * inner[entry.inner] * inner[entry.inner];
    return sum;
  }
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      const double f = force(entry, e.inner[entry.inner]);
      add_pair_jacobian(
          entry.a, entry.b, entry.measure, e, [f](const Dual<12>&, const Dual<12>&) { return Dual<12>(f); }, out);
    }
  }
  void add_inner_jacobian(const Evaluation& e, std::vector<InnerJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      const auto m = entry.measure.template at<false, Dual<12>>(seeded(e.motion[entry.a], 0), seeded(e.motion[entry.b], 3));
      const RowGradient<Dual<12>> gradient = gradient_of(m);
      InnerJacobian& j = out.emplace_back();
      j.a = entry.a;
      j.b = entry.b;
      j.first = entry.inner;
      j.count = 1;
      for (int i = 0; i < 6; ++i) j.force(i, 0) = -entry.k * gradient.j[i].v;
      j.by_pose.row(0) = m.rate.d.template head<6>().matrix().transpose();
      j.by_velocity.row(0) = m.rate.d.template tail<6>().matrix().transpose();
      j.by_inner(0, 0) = -entry.k / entry.c;
    }
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
  }
  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries) turns.add(entry.a, entry.b, turning_of(entry.measure));
  }
  void register_links(LinkTable& links) override {
    for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
  }

  template <class S> [[nodiscard]] static S force(const ElementData& entry, const S& stretch) { return S(-entry.k) * stretch; }

private:
  template <class S> void add_forces_to(EvaluationData<S>& e) const {
    for (const ElementData& entry : entries) {
      const auto m = entry.measure.template at<false, S>(e.link_motion[entry.link], Origin{});
      const S f = force(entry, e.inner[entry.inner]), flow = S(-1.0 / entry.c) * f;
      e.inner_rate[entry.inner] = m.rate - flow;
      e.dissipation += S(entry.c) * flow * flow;
      apply_force(e.link_force[entry.link], m, f);
    }
  }
};

template <class Measure> void add(const Maxwell& e, SystemBuilder& builder, int a, int b, const Measure& measure) {
  using Group = MaxwellGroup<Measure>;
  Group& group = builder.group<Group>();
  const double n = static_cast<double>(e.count);
  typename Group::ElementData entry{a, b, measure, n * e.stiffness, n * e.damping};
  entry.inner = builder.add_inner(group, -e.preload / entry.k);
  group.entries.push_back(entry);
  builder.add_channel("stretch", "m", {"of its spring; the damper takes the rest", "positive: it pulls"},
                      [i = entry.inner](const Snapshot& s) { return s.evaluation->inner[i]; });
  builder.add_channel("force", "N", {"what it acts with on a along its axis, away from b", "negative: it pulls a towards b"},
                      [entry](const Snapshot& s) { return Group::force(entry, s.evaluation->inner[entry.inner]); });
}

void compile_maxwell(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Maxwell&>(element);
  if (refuses_across(builder, e.axis.has_value(), e.across)) return;
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (!e.axis) return with_distance(builder, a, b, e.across, [&](const auto& measure) { add(e, builder, a.body, b.body, measure); });
  if (e.axis->norm() == 0.0) return builder.error("'axis' has no direction");
  add(e, builder, a.body, b.body, AxisMeasure{a.point, b.point, builder.direction(b, *e.axis)});
}

} // namespace

const ElementKind& maxwell_kind() {
  static const ElementKind kind = [] {
    using T = Maxwell;
    ElementKind k;
    k.name = "maxwell";
    k.doc = "Spring and damper in series between two markers: its force relaxes with the time damping/stiffness. Beside a spring_damper it "
            "makes a pad that creeps. A search for equilibrium keeps its force.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker on the first body");
    f.add("b", &T::b).as(FieldType::marker).doc("marker on the second body");
    f.add("axis", &T::axis).doc("direction in marker b's axes; without it, from point to point");
    f.add("across", &T::across).in("m").not_negative().doc("distance of its ends across the plane; its length is that in space");
    f.add("stiffness", &T::stiffness).in("N/m").positive().required().doc("k of one element");
    f.add("damping", &T::damping).in("N s/m").positive().required().doc("c of one element");
    f.add("count", &T::count).at_least(1).doc("equal elements side by side");
    f.add("preload", &T::preload).in("N").doc("force of all on a at the start, along the axis away from b; it relaxes");
    k.example = R"([[element]]
name = 'creep'
kind = 'maxwell'
a = { body = 'a', point = [0.0, -0.5] }
b = { body = 'b', point = [0.0, 0.5] }
stiffness = 1e6
damping = 1e6
)";
    k.holds<T>();
    k.compile = compile_maxwell;
    return k;
  }();
  return kind;
}

} // namespace steplap
