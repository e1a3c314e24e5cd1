#include "elements/machinery/lossy_gear.h"

#include "mbd/system/bounded_friction.h"
#include "mbd/system/system.h"
#include "mbd/system/turn_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace steplap {

namespace {

struct MeshEntry {
  int a = k_ground, b = k_ground, carrier = k_ground;
  double ratio = 1.0, k = 0.0, c = 0.0;
  double start = 0.0; ///< δ in the reference pose, rad
  double band = 0.0;  ///< loads below this, N m, count as zero
  int unit = 0, first_event = 0;

  template <class S> [[nodiscard]] S twist(const Motion<S>* motion) const {
    return (motion[a].theta - motion[carrier].theta) - ratio * (motion[b].theta - motion[carrier].theta) - S(start);
  }
  template <class S> [[nodiscard]] S rate(const Motion<S>* motion) const {
    return (motion[a].omega - motion[carrier].omega) - ratio * (motion[b].omega - motion[carrier].omega);
  }
  template <class S> [[nodiscard]] S couple(const Motion<S>* motion) const { return k * twist(motion) + c * rate(motion); }
};

// Tooth forces of gears. The mode is the direction of the load on the teeth, so that the friction is smooth within a mode.
class MeshGroup final : public ForceGroup {
public:
  static constexpr UnitMode k_forwards = 0, k_backwards = 1;
  std::vector<MeshEntry> entries;
  using ElementData = MeshEntry;

  void add_forces(Evaluation& e) const override { add_forces_to(e); }
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override {
    add_forces_to(e);
    return true;
  }
  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries) sum += 0.5 * entry.k * entry.twist(motion) * entry.twist(motion);
    return sum;
  }
  void add_jacobian(const Evaluation&, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      const int bodies[3] = {entry.a, entry.b, entry.carrier};
      // Derivatives of δ with respect to the three angles; the moments are −M times these.
      const double by_angle[3] = {1.0, -entry.ratio, entry.ratio - 1.0};
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
          if (bodies[row] == k_ground || bodies[column] == k_ground) continue;
          PairJacobian& j = out.emplace_back();
          const bool is_same = bodies[row] == bodies[column];
          j.a = bodies[row];
          j.b = is_same ? k_ground : bodies[column];
          j.stiffness.setZero();
          j.damping.setZero();
          j.stiffness(2, is_same ? 2 : 5) = -entry.k * by_angle[row] * by_angle[column];
          j.damping(2, is_same ? 2 : 5) = -entry.c * by_angle[row] * by_angle[column];
        }
    }
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = is_used[entry.carrier] = 1;
  }
  void register_turns(TurnTable&) const override {} // no limit of rotation: a gear is linear in its angles
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override {
    return entries[static_cast<std::size_t>(element)].couple(e.motion) < 0.0 ? k_backwards : k_forwards;
  }
  [[nodiscard]] UnitMode next_mode(int, UnitMode mode, int, const Evaluation&) const override {
    return mode == k_forwards ? k_backwards : k_forwards;
  }
  [[nodiscard]] EventKind event_kind(UnitMode, UnitMode) const override { return EventKind::passes_kink; }

private:
  template <class S> void add_forces_to(EvaluationData<S>& e) const {
    for (const ElementData& entry : entries) {
      const S couple = entry.couple(e.motion), rate = entry.rate(e.motion);
      e.force[entry.a].m -= couple;
      e.force[entry.b].m += entry.ratio * couple;
      e.force[entry.carrier].m += (1.0 - entry.ratio) * couple;
      e.dissipation += entry.c * rate * rate;
      e.event_value[entry.first_event] = (e.mode[entry.unit] == k_forwards ? couple : -couple) + S(entry.band);
      e.event_derivative[entry.first_event] = S(std::numeric_limits<double>::quiet_NaN());
    }
  }
};

class ToothFriction final : public BoundedFriction {
public:
  RowSpec row;
  MeshEntry mesh;
  double loss = 0.0; ///< loss factor ν = 1/efficiency − 1

  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return &row; }
  void mark_bodies(std::vector<char>& is_used) const override { is_used[mesh.a] = is_used[mesh.b] = is_used[mesh.carrier] = 1; }
  [[nodiscard]] bool is_loaded(const Evaluation&, const FrictionState&) const override { return loss != 0.0; }
  void slip_wrench(const Evaluation& e, const FrictionState& state, const double*, double* wrench) const override {
    wrench[0] = -state.sign * bound<double>(e);
  }
  [[nodiscard]] WrenchBounds bounds(const Evaluation& e, const FrictionState&, bool /*kinetic*/) const override {
    return WrenchBounds::symmetric(std::max(0.0, bound<double>(e)));
  }
  void stick_events(const Evaluation& e, const FrictionState&, const double* wrench, double* event_value) const override {
    bound_events<double>(bound<double>(e), wrench[0], event_value);
  }
  [[nodiscard]] bool record_friction(TracedEvaluation& e, const FrictionState& state, const TapeNumber* rate, TapeNumber* wrench,
                                     TapeNumber* event_value) const override {
    if (rate) {
      wrench[0] = -state.sign * bound<TapeNumber>(e);
      event_value[0] = state.sign * rate[0];
      event_value[1] = 1.0;
    } else {
      bound_events<TapeNumber>(bound<TapeNumber>(e), wrench[0], event_value);
    }
    event_value[2] = 1.0;
    return true;
  }

private:
  // The bound must remain positive in the dead band about zero load.
  template <class S> [[nodiscard]] S bound(const EvaluationData<S>& e) const {
    const S couple = mesh.couple(e.motion);
    return loss * ((e.mode[mesh.unit] == MeshGroup::k_forwards ? couple : -couple) + S(mesh.band));
  }
};

void compile_lossy_gear(const Element& element, SystemBuilder& builder) {
  constexpr double k_no_twist = 1e-12; // an initial twist below this, rad, is a residual of the joints
  const auto& e = static_cast<const LossyGear&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b), carrier = builder.marker(e.carrier);
  if (a.body == b.body || a.body == carrier.body || b.body == carrier.body)
    return builder.error("'a', 'b' and 'carrier' have to be three bodies, one of which may be the ground");
  if (e.ratio == 0.0) return builder.error("'ratio' is 0: such a gear turns nothing");
  MeshGroup& group = builder.group<MeshGroup>();
  MeshEntry entry{a.body, b.body, carrier.body, e.ratio, e.stiffness, e.damping};
  entry.start = entry.twist(&builder.reference(0));
  entry.band = k_no_twist * e.stiffness;
  group.entries.push_back(entry);
  builder.add_unit(group, 1);
  const MeshEntry& added = group.entries.back();
  auto friction = std::make_unique<ToothFriction>();
  friction->mesh = added;
  friction->loss = 1.0 / e.efficiency - 1.0;
  RowSpec& row = friction->row;
  row.kind = MeasureKind::angle;
  row.a = a.body;
  row.b = carrier.body;
  row.quantity = "angle";
  row.element = builder.element_index();
  row.base = builder.add_base();
  const int f = builder.next_friction(), slot = builder.next_friction_row();
  builder.add_channel("twist", "rad", {"by which its teeth give, at shaft a", "positive: a is ahead"},
                      [mesh = added](const Snapshot& s) { return mesh.twist(s.motion); });
  builder.add_channel("couple", "N m", {"with which its teeth brake shaft a, without friction", "positive: a drives counter-clockwise"},
                      [mesh = added](const Snapshot& s) { return mesh.couple(s.motion); });
  builder.add_channel("friction", "N m", {"between its teeth, on shaft a", "positive counter-clockwise"},
                      [slot](const Snapshot& s) { return s.friction_force[slot]; });
  builder.add_channel("mode", "", {"what the friction does", "", "1 sticks, 2 slips"},
                      [f](const Snapshot& s) { return s.evaluation->friction[f].phase == FrictionPhase::stick ? 1.0 : 2.0; });
  builder.add_friction(std::move(friction));
}

} // namespace

const ElementKind& lossy_gear_kind() {
  static const ElementKind kind = [] {
    using T = LossyGear;
    ElementKind k;
    k.name = "lossy_gear";
    k.doc = "A gear, worm or screw drive between two shafts on one carrier that loses by friction a share of what it carries: 'efficiency' "
            "where a "
            "drives, 2 - 1/efficiency where b drives; with 1/2 or less it locks itself.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("shaft that usually drives");
    f.add("b", &T::b).as(FieldType::marker).required().doc("shaft that is usually driven");
    f.add("carrier", &T::carrier).as(FieldType::marker).doc("body that carries both wheels");
    f.add("ratio", &T::ratio).required().doc("turns of a to one of b; negative: they turn against each other");
    f.add("efficiency", &T::efficiency).positive().at_most(1.0).doc("power at b of that at a, where a drives");
    f.add("stiffness", &T::stiffness).in("N m/rad").positive().required().doc("of the teeth, at shaft a");
    f.add("damping", &T::damping).in("N m s/rad").not_negative().doc("likewise");
    k.example = R"([[element]]
name = 'gear'
kind = 'lossy_gear'
a = 'a'
b = 'b'
ratio = -2.0
efficiency = 0.9
stiffness = 1e4
)";
    k.holds<T>();
    k.compile = compile_lossy_gear;
    return k;
  }();
  return kind;
}

} // namespace steplap
