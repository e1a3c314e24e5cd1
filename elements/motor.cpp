#include "elements/motor.h"

#include "mbd/system/law_group.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"
#include "mbd/system/turn_table.h"

namespace steplap {

namespace {

/// Reads signals in an evaluation: the mean over the step for an effort, which is a force; the present value for a target.
struct InputsOf {
  const Evaluation& e;

  double operator()(const Signal& effort) const { return e.force_of(effort); }
  double operator()(const SignalInput& target) const { return target.at(e.t); }
};

struct TracedInputsOf {
  TracedEvaluation& e;

  TapeNumber operator()(const Signal& effort) const { return e.record_signal_input({&effort}); }
  TapeNumber operator()(const SignalInput& target) const { return e.record_signal_input(target); }
};

struct MotorLaw {
  const Signal *effort = nullptr, *target = nullptr;
  double constant_effort = 0.0, droop = 0.0; ///< constant part of the effort; droop: 1/no-load speed
  double proportional = 0.0, derivative = 0.0, start = 0.0;

  template <class S> [[nodiscard]] S force(const S& value, const S& rate, const Evaluation& e) const {
    return force_by(value, rate, InputsOf{e});
  }
  // Returns the force of the motor. `at_time` returns the value of a signal.
  template <class S, class AtTime> [[nodiscard]] S force_by(const S& value, const S& rate, const AtTime& at_time) const {
    const auto stall = constant_effort + (effort ? at_time(*effort) : 0.0);
    const bool is_reverse = droop != 0.0 && stall < 0.0; // negative effort: the no-load speed is in the opposite direction
    S f = S(stall) * (is_reverse ? S(1) + S(droop) * rate : S(1) - S(droop) * rate);
    if (proportional == 0.0 && derivative == 0.0) return f;
    const auto wanted = target ? at_time(SignalInput{target}) : 0.0, wanted_rate = target ? at_time(SignalInput{target, true}) : 0.0;
    f += S(proportional) * (S(wanted + start) - value) + S(derivative) * (S(wanted_rate) - rate);
    return f;
  }
};

template <class Measure> class MotorGroup final : public ForceGroup {
public:
  struct ElementData {
    int a, b;
    Measure measure;
    MotorLaw law;
    int link = 0;
  };
  std::vector<ElementData> entries;
  static constexpr bool k_does_work = true;

  void add_forces(Evaluation& e) const override { add_forces_to(e, InputsOf{e}); }
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override {
    add_forces_to<TapeNumber>(e, TracedInputsOf{e});
    return true;
  }
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries)
      add_pair_jacobian(
          entry.a, entry.b, entry.measure, e, [&](const Dual<12>& value, const Dual<12>& rate) { return entry.law.force(value, rate, e); },
          out);
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
  [[nodiscard]] MeasureValue<double> measured(int i, const Evaluation& e) const {
    const ElementData& entry = entries[i];
    return entry.measure.template at<false, double>(e.motion[entry.a], e.motion[entry.b]);
  }

private:
  template <class S, class AtTime> void add_forces_to(EvaluationData<S>& e, const AtTime& at_time) const {
    for (const ElementData& entry : entries) {
      const auto m = entry.measure.template at<false, S>(e.link_motion[entry.link], Origin{});
      const S f = entry.law.force_by(m.value, m.rate, at_time);
      apply_force(e.link_force[entry.link], m, f);
      e.work += f * m.rate;
    }
  }
};

template <class Measure> void add(SystemBuilder& builder, int a, int b, const Measure& measure, MotorLaw law, bool is_angle) {
  MotorGroup<Measure>& group = builder.group<MotorGroup<Measure>>();
  law.start = measure.template at<false, double>(builder.reference(a), builder.reference(b)).value;
  group.entries.push_back({a, b, measure, law});
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel(is_angle ? "couple" : "force", is_angle ? "N m" : "N",
                      {"what it acts with on a along the coordinate", "positive: towards larger values of the coordinate"},
                      [&group, i](const Snapshot& s) {
                        const auto m = group.measured(i, *s.evaluation);
                        return group.entries[i].law.force(m.value, m.rate, *s.evaluation);
                      });
  builder.add_channel("power", "W", {"power that it gives", "negative while it brakes"}, [&group, i](const Snapshot& s) {
    const auto m = group.measured(i, *s.evaluation);
    return m.rate * group.entries[i].law.force(m.value, m.rate, *s.evaluation);
  });
  const RowSpec row = row_of(a, b, measure);
  builder.offer_channel(
      is_angle ? "angle" : "displacement", is_angle ? "rad" : "m", {"its coordinate, since the reference pose", "as the coordinate counts"},
      MeasuredValue{[&group, i](const Snapshot& s) { return group.measured(i, *s.evaluation).value - group.entries[i].law.start; }, row,
                    law.start});
  builder.offer_channel("rate", is_angle ? "rad/s" : "m/s", {"of its coordinate", "positive: it grows"},
                        MeasuredValue{[&group, i](const Snapshot& s) { return group.measured(i, *s.evaluation).rate; }, row, 0.0, true});
}

bool check(const Motor& e, const Signal* target, SystemBuilder& builder) {
  bool is_bad = false;
  const auto fail = [&](const std::string& message) {
    builder.error(message);
    is_bad = true;
  };
  if (e.effort.empty() && e.constant_effort == 0.0 && e.proportional == 0.0 && e.derivative == 0.0)
    fail("gives no force: set 'effort', 'constant_effort', 'proportional' or 'derivative'");
  if (!e.target.empty() && e.proportional == 0.0 && e.derivative == 0.0) fail("'target' needs 'proportional' or 'derivative'");
  if (target && e.derivative != 0.0)
    for (std::size_t k = 0; k < target->breakpoints().size(); ++k)
      if (target->breakpoints()[k] > 0.0 && target->jumps_at(k)) {
        fail("signal '" + e.target + "' jumps, so 'derivative' has no rate to follow");
        break;
      }
  return !is_bad;
}

void compile_motor(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Motor&>(element);
  MotorLaw law;
  law.effort = builder.signal(e.effort, e.no_load_speed ? SignalUse::motion : SignalUse::force);
  law.target = builder.signal(e.target);
  if (!check(e, law.target, builder)) return;
  law.constant_effort = e.constant_effort;
  law.droop = e.no_load_speed ? 1.0 / *e.no_load_speed : 0.0;
  law.proportional = e.proportional;
  law.derivative = e.derivative;
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("drives a body against itself: name markers on two different bodies");
  if (e.coordinate == "angle") return add(builder, a.body, b.body, AngleMeasure{}, law, true);
  if (e.coordinate == "distance") {
    if ((builder.marker_position(a) - builder.marker_position(b)).norm() < 1e-12)
      return builder.error("its ends coincide, so its direction is undefined: move a marker");
    return add(builder, a.body, b.body, DistanceMeasure{a.point, b.point}, law, false);
  }
  const Vec2 axis = builder.direction(b, e.coordinate == "x" ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0));
  add(builder, a.body, b.body, AxisMeasure{a.point, b.point, axis}, law, false);
}

} // namespace

const ElementKind& motor_kind() {
  static const ElementKind kind = [] {
    using T = Motor;
    ElementKind k;
    k.name = "motor";
    k.doc = "A couple or force between a and b along a coordinate: effort - |effort| rate/no_load_speed + proportional "
            "(target - value) + derivative (target' - rate), value counted from the reference pose.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker or body that is driven");
    f.add("b", &T::b).as(FieldType::marker).doc("marker whose axes count");
    f.add("coordinate", &T::coordinate)
        .one_of({"angle", "x", "y", "distance"})
        .doc("angle of a against b; x, y: of marker a in marker b's axes; distance of the markers");
    f.add("effort", &T::effort).as(FieldType::signal).in("N m|N").doc("couple or force at standstill");
    f.add("constant_effort", &T::constant_effort).in("N m|N").doc("the same, constant, added to the signal");
    f.add("no_load_speed", &T::no_load_speed)
        .in("rad/s|m/s")
        .positive()
        .doc("rate in the direction of the effort at which it has fallen to zero; not given: it never falls");
    f.add("target", &T::target).as(FieldType::signal).in("rad|m").doc("wanted value; not given: the reference pose");
    f.add("proportional", &T::proportional).in("N m/rad|N/m").not_negative().doc("of the servo");
    f.add("derivative", &T::derivative).in("N m s/rad|N s/m").not_negative().doc("of the servo");
    k.example = R"([[element]]
name = 'motor'
kind = 'motor'
a = 'a'
b = 'b'
coordinate = 'angle'
constant_effort = 10.0
)";
    k.holds<T>();
    k.compile = compile_motor;
    k.has_constant_load = [](const Element& element) { return static_cast<const T&>(element).constant_effort != 0.0; };
    return k;
  }();
  return kind;
}

} // namespace steplap
