#include "elements/joint_friction.h"

#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_bound_slack = 1e-13; // as in coulomb_stick.cpp
constexpr double k_no_motion = 1e-12; // m/s or m/s²: rounding of a coordinate that a drive keeps at rest

class ConstantFriction final : public FrictionElement {
public:
  RowSpec row;
  double holds = 0.0, drags = 0.0;

  [[nodiscard]] int dimension() const override { return 1; }
  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return &row; }
  void mark_bodies(std::vector<char>& is_used) const override { is_used[row.a] = is_used[row.b] = 1; }
  [[nodiscard]] bool is_loaded(const Evaluation&, const FrictionState&) const override { return true; }
  void slip_wrench(const Evaluation&, const FrictionState& state, const double*, double* wrench) const override {
    wrench[0] = -drags * state.sign;
  }
  [[nodiscard]] double support(const Evaluation&, const FrictionState&, const double* rate) const override {
    return holds * std::abs(rate[0]);
  }
  void watch_stick(const Evaluation&, const FrictionState&, const double* wrench, double* watch) const override {
    const double bound = holds * (1.0 + k_bound_slack);
    watch[0] = bound - wrench[0];
    watch[1] = bound + wrench[0];
  }
  void begin_slip(const Evaluation&, FrictionState& state, const double* wrench) const override {
    state.sign = wrench[0] > 0.0 ? -1 : 1;
  }
  [[nodiscard]] FrictionBlock solve_block(const Evaluation&, const FrictionState&, const double* a, const double* b,
                                          bool is_kinetic) const override {
    FrictionBlock block;
    const double bound = is_kinetic ? drags : holds;
    const double wanted = a[0] > 0.0 ? -b[0] / a[0] : (b[0] > 0.0 ? -bound : bound);
    // Where a drive prescribes the coordinate no force changes its motion: it rests or it does not.
    block.is_inside = a[0] > 0.0 ? std::abs(wanted) <= bound * (1.0 + k_bound_slack) : std::abs(b[0]) <= k_no_motion;
    block.wrench[0] = std::clamp(wanted, -bound, bound);
    block.direction[0] = wanted > 0.0 ? -1.0 : 1.0;
    return block;
  }
};

void add_channels(SystemBuilder& builder, const ConstantFriction& friction, bool is_angle) {
  const int f = builder.next_friction(), slot = builder.next_friction_row();
  const auto* row = &friction.row;
  builder.add_channel("friction", is_angle ? "N m" : "N", {"friction on a along the coordinate", "positive: towards larger values"},
                      [slot](const Snapshot& s) { return s.friction_force[slot]; });
  builder.add_channel("slip_rate", is_angle ? "rad/s" : "m/s", {"rate of the coordinate", "positive: it grows"},
                      [row](const Snapshot& s) { return evaluate_row<false>(*row, s.motion).rate; });
  builder.add_channel("mode", "", {"what the friction does", "", "1 sticks, 2 slips"},
                      [f](const Snapshot& s) { return static_cast<double>(s.evaluation->friction[f].phase); });
}

void compile_joint_friction(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const JointFriction&>(element);
  if (e.drags.value_or(e.holds) > e.holds) return builder.error("'drags' must not exceed 'holds'");
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("holds a body against itself: name markers on two different bodies");
  auto friction = std::make_unique<ConstantFriction>();
  RowSpec& row = friction->row;
  row.a = a.body;
  row.b = b.body;
  row.point_a = a.point;
  row.point_b = b.point;
  row.quantity = e.coordinate == "angle" ? "angle" : "slide";
  row.element = builder.element_index();
  row.memory = builder.add_memory();
  if (e.coordinate == "angle") row.kind = MeasureKind::angle;
  else if (e.coordinate == "distance") row.kind = MeasureKind::distance;
  else row.direction = builder.direction(b, e.coordinate == "x" ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0));
  if (e.coordinate == "distance" && (builder.marker_position(a) - builder.marker_position(b)).norm() < 1e-12)
    return builder.error("its ends coincide, so its direction is undefined: move a marker");
  friction->holds = e.holds;
  friction->drags = e.drags.value_or(e.holds);
  add_channels(builder, *friction, e.coordinate == "angle");
  builder.add_friction(std::move(friction));
}

} // namespace

const ElementKind& joint_friction_kind() {
  static const ElementKind kind = [] {
    using T = JointFriction;
    ElementKind k;
    k.name = "joint_friction";
    k.doc = "Dry friction with a constant bound on a coordinate of a against b, as of a preloaded bearing or guide: "
            "sticks exactly while it takes no more than 'holds'. It does not follow the joint's reaction.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker or body that is held");
    f.add("b", &T::b).as(FieldType::marker).doc("marker whose axes count");
    f.add("coordinate", &T::coordinate).one_of({"angle", "x", "y", "distance"}).doc(
        "angle of a against b; x, y: of marker a in marker b's axes; distance of the markers");
    f.add("holds", &T::holds).in("N m|N").positive().required().doc(
        "largest couple or force that it takes sticking");
    f.add("drags", &T::drags).in("N m|N").not_negative().doc("couple or force while it slides; default: as holds");
    k.holds<T>();
    k.compile = compile_joint_friction;
    return k;
  }();
  return kind;
}

} // namespace steplap
