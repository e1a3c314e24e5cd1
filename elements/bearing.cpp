#include "elements/bearing.h"

#include "elements/coulomb_friction.h"
#include "elements/polygon_contact.h"
#include "elements/share_channel.h"
#include "mbd/system/law_group.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"

#include <cmath>

namespace steplap {

namespace {

// The springs of all bearings. The reaction of each is a normal force that always presses, so that friction follows it as that of a contact.
class BearingGroup final : public ForceGroup {
public:
  struct ElementData {
    int a = k_ground, b = k_ground;
    AxisMeasure x, y; ///< displacement of the journal along marker b's axes
    double k = 0.0, c = 0.0;
    int link = 0, unit = 0, first_event = 0, contact = 0;
  };
  template <class S> struct Reaction {
    MeasureValue<S> x, y;
    S along_x{0.0}, along_y{0.0}; ///< on a

    [[nodiscard]] S size() const {
      using std::sqrt;
      return sqrt(along_x * along_x + along_y * along_y);
    }
  };
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override { add_forces_to(e); }
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override {
    add_forces_to(e);
    return true;
  }
  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries) {
      const auto r = reaction<double>(entry, motion[entry.a], motion[entry.b]);
      sum += 0.5 * entry.k * (r.x.value * r.x.value + r.y.value * r.y.value);
    }
    return sum;
  }
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    using D12 = Dual<12>;
    for (const ElementData& entry : entries) {
      const auto law = [&entry](const D12& value, const D12& rate) { return D12(-entry.k) * value - D12(entry.c) * rate; };
      Reaction<D12> r;
      r.along_x = add_pair_jacobian(entry.a, entry.b, entry.x, e, law, out);
      r.along_y = add_pair_jacobian(entry.a, entry.b, entry.y, e, law, out);
      PairJacobian& last = out.back();
      last.contact = entry.contact;
      last.normal.setZero();
      if (r.along_x.v != 0.0 || r.along_y.v != 0.0) last.normal = r.size().d.matrix();
    }
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
  }
  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries) turns.add(entry.a, entry.b, turning_of(entry.x));
  }
  void register_links(LinkTable& links) override {
    for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
  }
  [[nodiscard]] UnitMode initial_mode(int, const Evaluation&) const override { return k_contact_pressed; }

  [[nodiscard]] Reaction<double> reaction_of(int element, const Motion<double>* motion) const {
    const ElementData& entry = entries[static_cast<std::size_t>(element)];
    return reaction<double>(entry, motion[entry.a], motion[entry.b]);
  }

private:
  template <class S, class B> static Reaction<S> reaction(const ElementData& entry, const Motion<S>& a, const B& b) {
    Reaction<S> r{entry.x.at<false, S>(a, b), entry.y.at<false, S>(a, b)};
    r.along_x = S(-entry.k) * r.x.value - S(entry.c) * r.x.rate;
    r.along_y = S(-entry.k) * r.y.value - S(entry.c) * r.y.rate;
    return r;
  }
  template <class S> void add_forces_to(EvaluationData<S>& e) const {
    for (const ElementData& entry : entries) {
      const Reaction<S> r = reaction<S>(entry, e.link_motion[entry.link], Origin{});
      e.contact_force[entry.contact] = r.size();
      e.dissipation += S(entry.c) * (r.x.rate * r.x.rate + r.y.rate * r.y.rate);
      apply_force(e.link_force[entry.link], r.x, r.along_x);
      apply_force(e.link_force[entry.link], r.y, r.along_y);
    }
  }
};

void add_reaction(const Bearing& e, const CompiledMarker& a, const CompiledMarker& b, SystemBuilder& builder) {
  BearingGroup& group = builder.group<BearingGroup>();
  BearingGroup::ElementData entry;
  entry.a = a.body;
  entry.b = b.body;
  entry.x = {a.point, b.point, builder.direction(b, {1.0, 0.0})};
  entry.y = {a.point, b.point, builder.direction(b, {0.0, 1.0})};
  entry.k = e.stiffness;
  entry.c = e.damping;
  group.entries.push_back(entry);
  builder.add_unit(group, 0);
  group.entries.back().contact = builder.add_contact(group.entries.back().unit);
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("force_x", "N", {"reaction on a", "along x of marker b's axes"},
                      [&group, i](const Snapshot& s) { return group.reaction_of(i, s.motion).along_x; });
  builder.add_channel("force_y", "N", {"reaction on a", "along y of marker b's axes"},
                      [&group, i](const Snapshot& s) { return group.reaction_of(i, s.motion).along_y; });
  builder.add_channel("reaction", "N", {"size of the reaction", "never negative"},
                      [&group, i](const Snapshot& s) { return group.reaction_of(i, s.motion).size(); });
}

void add_friction(const Bearing& e, const CompiledMarker& a, const CompiledMarker& b, SystemBuilder& builder) {
  auto friction = std::make_unique<CoulombFriction>();
  RowSpec row = row_of(a.body, b.body, AngleMeasure{});
  row.element = builder.element_index();
  row.quantity = "angle";
  row.base = builder.add_base();
  friction->feet = {row, row};
  friction->contacts.push_back(*builder.contact(e.name));
  friction->mu_static = e.static_friction * e.radius;
  friction->mu_kinetic = e.kinetic_friction.value_or(e.static_friction) * e.radius;
  const int f = builder.next_friction(), slot = builder.next_friction_row();
  builder.add_channel("friction", "N m", {"couple of friction on a", "positive counter-clockwise"},
                      [slot](const Snapshot& s) { return s.friction_force[slot]; });
  builder.add_channel("capacity", "N m", {"largest couple that holds", "never negative"},
                      [self = friction.get()](const Snapshot& s) { return self->mu_static * self->normal_force(*s.evaluation); });
  add_share_channel(builder, *friction);
  builder.add_channel("slip_rate", "rad/s", {"of a against b", "positive: a turns counter-clockwise"},
                      [row](const Snapshot& s) { return evaluate_row<false>(row, s.motion).rate; });
  builder.add_channel(
      "mode", "", {"what the friction does", "", "0 free, 1 sticks, 2 slips"},
      [self = friction.get(), f](const Snapshot& s) { return self->shown_phase(*s.evaluation, s.evaluation->friction[f]); });
  builder.add_friction(std::move(friction));
}

void compile_bearing(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Bearing&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("joins a body to itself: name markers on two different bodies");
  if (const std::string problem = friction_problem(e.static_friction, e.kinetic_friction); !problem.empty()) return builder.error(problem);
  add_reaction(e, a, b, builder);
  add_friction(e, a, b, builder);
}

} // namespace

const ElementKind& bearing_kind() {
  static const ElementKind kind = [] {
    using T = Bearing;
    ElementKind k;
    k.name = "bearing";
    k.doc = "A journal in an elastic bearing: springs that keep two markers together, and dry friction that follows their reaction R. It "
            "sticks exactly while the couple is within static_friction * radius * R.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("centre of the journal");
    f.add("b", &T::b).as(FieldType::marker).doc("centre of the bearing");
    f.add("stiffness", &T::stiffness).in("N/m").positive().required().doc("in every direction");
    f.add("damping", &T::damping).in("N s/m").not_negative().doc("in every direction");
    f.add("radius", &T::radius).in("m").positive().required().doc("of the journal");
    f.add("static_friction", &T::static_friction).not_negative().required().doc("mu_s: couple that holds, over radius and reaction");
    f.add("kinetic_friction", &T::kinetic_friction).not_negative().doc("mu_k; default: mu_s");
    f.add("source", &T::source)
        .doc("where the coefficients come from: above 0.8 results name it, from 1.2 on no verdict is hold without it");
    k.example = R"([[element]]
name = 'journal'
kind = 'bearing'
a = { body = 'a', at = [0.0, 0.0] }
b = { body = 'b', at = [0.0, 0.0] }
stiffness = 1e8
damping = 1e4
radius = 0.05
static_friction = 0.1
)";
    k.holds<T>();
    k.compile = compile_bearing;
    k.friction = [](const Element& element) {
      const auto& e = static_cast<const T&>(element);
      return GivenFriction{"static_friction", e.static_friction, e.source};
    };
    return k;
  }();
  return kind;
}

} // namespace steplap
