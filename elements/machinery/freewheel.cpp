#include "elements/machinery/freewheel.h"

#include "mbd/system/bounded_friction.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/one_way_lock.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Friction of a one-way clutch. λ, the torque on a (counter-clockwise positive), lies between `low` and `high`.
class OneWayClutch final : public OneWayLock {
public:
  RowSpec row;
  double low = 0.0, high = 0.0;
  double rest = 0.0; ///< torques below this, N m, are rounding
  std::string name;  ///< name of the element

  [[nodiscard]] int refuses() const override { return low <= -k_without_bound ? 1 : high >= k_without_bound ? -1 : 0; }
  [[nodiscard]] double drag() const override { return std::min(-low, high); }
  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return &row; }
  void mark_bodies(std::vector<char>& is_used) const override { is_used[row.a] = is_used[row.b] = 1; }
  [[nodiscard]] bool is_loaded(const Evaluation&, const FrictionState&) const override { return true; }
  void slip_wrench(const Evaluation&, const FrictionState& state, const double*, double* wrench) const override {
    wrench[0] = bound(state);
  }
  [[nodiscard]] WrenchBounds bounds(const Evaluation&, const FrictionState&, bool /*kinetic*/) const override { return {low, high, rest}; }
  [[nodiscard]] double gauge(const Evaluation&, const FrictionState&, const double* wrench, double* normal) const override {
    const double bound = wrench[0] < 0.0 ? std::min(low, -rest) : std::max(high, rest);
    normal[0] = 1.0 / bound;
    return wrench[0] / bound;
  }
  void stick_events(const Evaluation&, const FrictionState&, const double* wrench, double* event_value) const override {
    bound_events<double>(wrench[0], event_value);
  }
  [[nodiscard]] bool record_friction(TracedEvaluation&, const FrictionState& state, const TapeNumber* rate, TapeNumber* wrench,
                                     TapeNumber* event_value) const override {
    if (rate) {
      wrench[0] = TapeNumber(sliding(state));
      event_value[0] = state.sign * rate[0];
      event_value[1] = 1.0;
    } else {
      bound_events<TapeNumber>(wrench[0], event_value);
    }
    event_value[2] = 1.0;
    return true;
  }
  // Sets the direction of slip: at the bound that the torque has reached, since the other one is far away.
  void set_onset_direction(const Evaluation&, FrictionState& state, const double* wrench) const override {
    state.sign = wrench[0] > 0.5 * (low + high) ? -1 : 1;
  }

private:
  [[nodiscard]] double least() const { return low * (1.0 + k_friction_bound_slack) - rest; }
  [[nodiscard]] double most() const { return high * (1.0 + k_friction_bound_slack) + rest; }
  [[nodiscard]] double sliding(const FrictionState& state) const { return state.sign > 0 ? low : high; }
  // Returns the sliding torque, N m. An unbounded one means that drives turn the bodies against the lock (otherwise an impact would have
  // joined them), and throws.
  [[nodiscard]] double bound(const FrictionState& state) const {
    const double couple = sliding(state);
    if (std::abs(couple) < k_without_bound) return couple;
    throw ElementFailure(
        "drives turn the bodies of the one-way clutch '" + name +
            "' against its lock, which no couple keeps them from: turn 'free' round, give it 'holds', or drive one of them only",
        {name});
  }
  template <class S> void bound_events(const S& wrench, S* event_value) const {
    event_value[0] = most() - wrench;
    event_value[1] = wrench - least();
  }
};

void compile_freewheel(const Element& element, SystemBuilder& builder) {
  constexpr double k_least_acceleration = 1e-11; // torques that accelerate the lighter body by less, rad/s², are rounding
  const auto& e = static_cast<const Freewheel&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("locks a body against itself: name markers on two different bodies");
  const double holds = e.holds.value_or(OneWayLock::k_without_bound);
  if (!(e.drags < holds)) return builder.error("'drags' must be less than 'holds'");
  auto clutch = std::make_unique<OneWayClutch>();
  clutch->name = e.name;
  const bool is_forward = e.free == "counter_clockwise";
  clutch->low = is_forward ? -e.drags : -holds;
  clutch->high = is_forward ? holds : e.drags;
  double lighter = std::numeric_limits<double>::infinity();
  for (const int index : {a.body, b.body})
    if (index != k_ground) lighter = std::min(lighter, builder.compiled().bodies[static_cast<std::size_t>(index)].inertia);
  clutch->rest = std::isfinite(lighter) ? k_least_acceleration * lighter : 0.0;
  RowSpec& row = clutch->row;
  row.kind = MeasureKind::angle;
  row.a = a.body;
  row.b = b.body;
  row.point_a = a.point;
  row.point_b = b.point;
  row.quantity = "angle";
  row.element = builder.element_index();
  row.base = builder.add_base();
  clutch->impact = builder.add_impacts();
  const int f = builder.next_friction(), slot = builder.next_friction_row();
  const OneWayClutch* const self = clutch.get();
  builder.add_channel("couple", "N m", {"with which b takes a along, or drags on it", "positive: counter-clockwise on a"},
                      [slot](const Snapshot& s) { return s.friction_force[slot]; });
  builder.add_channel("slip_rate", "rad/s", {"rate of a against b", "positive counter-clockwise"},
                      [self](const Snapshot& s) { return evaluate_row<false>(self->row, s.motion).rate; });
  builder.add_channel("mode", "", {"state", "", "1 locked, 2 free or slipping"},
                      [f](const Snapshot& s) { return static_cast<double>(s.evaluation->friction[f].phase); });
  builder.add_channel("impulse", "N m s", {"of the last blow that locked it, zero before the first", "never negative"},
                      [impact = clutch->impact](const Snapshot& s) { return s.impacts[impact].impulse; });
  builder.add_friction(std::move(clutch));
}

} // namespace

const ElementKind& freewheel_kind() {
  static const ElementKind kind = [] {
    using T = Freewheel;
    ElementKind k;
    k.name = "freewheel";
    k.doc =
        "A one-way clutch: a may overrun b in one direction, and b takes a along in that direction, exactly, without play. A backstop is a "
        "freewheel against the ground.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("body that may overrun");
    f.add("b", &T::b).as(FieldType::marker).doc("body that takes it along");
    f.add("free", &T::free).one_of({"counter_clockwise", "clockwise"}).doc("how a may turn against b");
    f.add("holds", &T::holds).in("N m").positive().doc("largest couple while it is locked; not given: whatever it takes");
    f.add("drags", &T::drags).in("N m").not_negative().doc("couple that brakes a while it overruns");
    k.example = R"([[element]]
name = 'ratchet'
kind = 'freewheel'
a = 'a'
b = 'b'
free = 'counter_clockwise'
)";
    k.holds<T>();
    k.compile = compile_freewheel;
    return k;
  }();
  return kind;
}

} // namespace steplap
