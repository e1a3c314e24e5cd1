#include "elements/machinery/skate.h"

#include "elements/share_channel.h"
#include "mbd/system/bounded_friction.h"
#include "mbd/system/system.h"

#include <cmath>
#include <memory>

namespace steplap {

namespace {

// Friction across the direction of motion, with constant bounds.
class SidewaysGrip final : public BoundedFriction {
public:
  RowSpec row;
  double grip = 0.0, drags = 0.0; ///< static and kinetic bound, N

  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return &row; }
  void mark_bodies(std::vector<char>& is_used) const override { is_used[row.a] = is_used[row.b] = 1; }
  [[nodiscard]] bool is_loaded(const Evaluation&, const FrictionState&) const override { return true; }
  void slip_wrench(const Evaluation&, const FrictionState& state, const double*, double* wrench) const override {
    wrench[0] = -state.sign * drags;
  }
  [[nodiscard]] WrenchBounds bounds(const Evaluation&, const FrictionState&, bool kinetic) const override {
    return WrenchBounds::symmetric(kinetic ? drags : grip);
  }
  void stick_events(const Evaluation&, const FrictionState&, const double* wrench, double* event_value) const override {
    bound_events<double>(grip, wrench[0], event_value);
  }
  [[nodiscard]] bool record_friction(TracedEvaluation&, const FrictionState& state, const TapeNumber* rate, TapeNumber* wrench,
                                     TapeNumber* event_value) const override {
    if (rate) {
      wrench[0] = TapeNumber(-state.sign * drags);
      event_value[0] = state.sign * rate[0];
      event_value[1] = 1.0;
    } else {
      bound_events<TapeNumber>(TapeNumber(grip), wrench[0], event_value);
    }
    event_value[2] = 1.0;
    return true;
  }
};

RowSpec sideways(const Skate& e, SystemBuilder& builder) {
  const CompiledMarker a = builder.marker(e.a);
  RowSpec row;
  row.kind = MeasureKind::skate;
  row.a = a.body;
  row.b = builder.marker(e.b).body;
  row.point_a = a.point;
  row.direction = builder.direction(a, perp(e.axis));
  row.quantity = "velocity across";
  row.element = builder.element_index();
  return row;
}

void add_speed(const RowSpec& row, SystemBuilder& builder) {
  RowSpec along = row;
  along.direction = Vec2(row.direction.y(), -row.direction.x());
  builder.add_channel("speed", "m/s", {"with which it runs", "positive: along its axis"},
                      [along](const Snapshot& s) { return evaluate_row<false>(along, s.motion).rate; });
}

void add_held(RowSpec row, SystemBuilder& builder) {
  const int r = builder.next_row();
  builder.add_channel("force", "N", {"reaction on a, across its axis", "positive: to the left of its axis"},
                      [r](const Snapshot& s) { return s.row_force[r]; });
  add_speed(row, builder);
  builder.offer_channel("power", "W", "power of the reaction: zero up to numerical error",
                        [row, r](const Snapshot& s) { return s.row_force[r] * evaluate_row<false>(row, s.motion).rate; });
  builder.add_rows({row});
}

void add_gripping(RowSpec row, double grip, double drags, SystemBuilder& builder) {
  row.base = builder.add_base();
  auto friction = std::make_unique<SidewaysGrip>();
  friction->row = row;
  friction->grip = grip;
  friction->drags = drags;
  const int f = builder.next_friction(), slot = builder.next_friction_row();
  builder.add_channel("force", "N", {"friction on a, across its axis", "positive: to the left of its axis"},
                      [slot](const Snapshot& s) { return s.friction_force[slot]; });
  add_share_channel(builder, *friction);
  add_speed(row, builder);
  builder.add_channel("slip_rate", "m/s", {"with which it slides across its axis", "positive: to the left"},
                      [row](const Snapshot& s) { return evaluate_row<false>(row, s.motion).rate; });
  builder.add_channel("mode", "", {"state", "", "1 runs along its axis, 2 slides across it"},
                      [f](const Snapshot& s) { return static_cast<double>(s.evaluation->friction[f].phase); });
  builder.add_friction(std::move(friction));
}

void compile_skate(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Skate&>(element);
  if (e.axis.norm() == 0.0) return builder.error("'axis' has no direction");
  if (e.drags && !e.grip) return builder.error("'drags' is what it slides against beyond 'grip': give 'grip', too");
  if (e.drags && *e.drags > *e.grip) return builder.error("'drags' must not exceed 'grip'");
  if (builder.marker(e.a).body == builder.marker(e.b).body)
    return builder.error("runs on its own body: name markers on two different bodies");
  const RowSpec row = sideways(e, builder);
  if (e.grip) add_gripping(row, *e.grip, e.drags.value_or(*e.grip), builder);
  else add_held(row, builder);
}

} // namespace

const ElementKind& skate_kind() {
  static const ElementKind kind = [] {
    using T = Skate;
    ElementKind k;
    k.name = "skate";
    k.doc = "A body that runs along one of its own directions and not across it, in a plane seen from above: the wheels of an axle, "
            "a knife edge, a keel. Only its velocity is held, never a place.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker or body that runs: where it touches the plane");
    f.add("b", &T::b).as(FieldType::marker).doc("marker or body on whose plane it runs");
    f.add("axis", &T::axis).doc("the way in which it runs, in marker a's axes");
    f.add("grip", &T::grip).in("N").positive().doc("largest sideways force that it takes without sliding; default: any");
    f.add("drags", &T::drags).in("N").not_negative().doc("sideways force while it slides; default: as grip");
    k.example = R"([[element]]
name = 'rear axle'
kind = 'skate'
a = 'a'
b = 'b'
[[element]]
name = 'front axle'
kind = 'skate'
a = 'b'
grip = 1e3
)";
    k.holds<T>();
    k.compile = compile_skate;
    return k;
  }();
  return kind;
}

} // namespace steplap
