#include "elements/step_lap_joint.h"

#include "mbd/system.h"

namespace steplap {

namespace {

class StepLapFriction final : public FrictionElement {
public:
  RowSpec hold[3]; ///< x and y in the active part's axes, angle

  [[nodiscard]] int dimension() const override { return 3; }
  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return hold; }
  [[nodiscard]] bool is_rigid() const override { return true; }
  void mark_bodies(std::vector<char>&) const override {}
  [[nodiscard]] bool is_loaded(const Evaluation&, const FrictionState&) const override { return true; }
  void slip_wrench(const Evaluation&, const FrictionState&, const double*, double* wrench) const override {
    wrench[0] = wrench[1] = wrench[2] = 0.0;
  }
  void watch_stick(const Evaluation&, const FrictionState&, const double*, double* watch) const override {
    watch[0] = watch[1] = 1.0;
  }
  void begin_slip(const Evaluation&, FrictionState&, const double*) const override {}
  [[nodiscard]] FrictionBlock solve_block(const Evaluation&, const FrictionState&, const double*,
                                          const double*, bool) const override {
    return {};
  }
};

void add_channels(SystemBuilder& builder, const StepLapFriction& friction) {
  const int f = builder.next_friction(), row = builder.next_friction_row();
  const RowSpec* hold = friction.hold;
  const int b = hold[0].b;
  builder.add_channel("fx", "N", "force on the limb, ground axes", [row, b](const Snapshot& s) {
    return s.motion[b].c * s.friction_force[row] - s.motion[b].s * s.friction_force[row + 1];
  });
  builder.add_channel("fy", "N", "force on the limb, ground axes", [row, b](const Snapshot& s) {
    return s.motion[b].s * s.friction_force[row] + s.motion[b].c * s.friction_force[row + 1];
  });
  builder.add_channel("m", "N m", "couple on the limb about its centre of gravity",
                      [row](const Snapshot& s) { return s.friction_force[row + 2]; });
  static constexpr const char* names[] = {"dx", "dy", "theta_acc"};
  for (int r = 0; r < 3; ++r) {
    const double start = evaluate_row<false>(hold[r], &builder.reference(0)).value;
    const double sign = r < 2 ? 1.0 : -1.0; // θ_acc is the active part's angle against the limb's (23)
    builder.add_channel(names[r], r < 2 ? "m" : "rad", "slid since the reference pose",
                        [hold, r, start, sign](const Snapshot& s) {
                          return sign * (evaluate_row<false>(hold[r], s.motion).value - start);
                        });
  }
  builder.add_channel("mode", "", "1 sticks, 2 slips", [f](const Snapshot& s) {
    return static_cast<double>(s.evaluation->friction[f].phase);
  });
}

void compile_joint(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const StepLapJoint&>(element);
  const int limb = builder.body(e.limb), active = builder.body(e.active_part);
  if (limb == active) return builder.error("joins a body to itself: name two different bodies");
  auto friction = std::make_unique<StepLapFriction>();
  const Vec2 directions[2] = {{1.0, 0.0}, {0.0, 1.0}};
  for (int r = 0; r < 3; ++r) {
    RowSpec& row = friction->hold[r];
    row.a = limb;
    row.b = active;
    row.kind = r < 2 ? MeasureKind::axis : MeasureKind::angle;
    if (r < 2) row.direction = directions[r];
    row.quantity = "joint";
    row.element = builder.element_index();
    row.memory = builder.add_memory(evaluate_row<false>(row, &builder.reference(0)).value);
  }
  add_channels(builder, *friction);
  builder.add_friction(std::move(friction));
}

} // namespace

const ElementKind& step_lap_joint_kind() {
  static const ElementKind kind = [] {
    using T = StepLapJoint;
    ElementKind k;
    k.name = "step_lap_joint";
    k.doc = "A core limb held to the active part by friction between overlapped sheets.";
    FieldTable& f = k.fields;
    f.add("limb", &T::limb).as(FieldType::body).required().doc("the limb");
    f.add("active_part", &T::active_part).as(FieldType::body).required().doc("the part with the yokes");
    k.create = [] { return std::shared_ptr<Element>(std::make_shared<T>()); };
    k.compile = compile_joint;
    return k;
  }();
  return kind;
}

} // namespace steplap
