#include "elements/formula_force.h"

#include "mbd/formula/formula.h"
#include "mbd/system/law_group.h"
#include "mbd/system/own_states.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

using D12 = Dual<12>;

/// Measure along an axis fixed in a, through a's marker. It has a rate but no value, because it is not the rate of any coordinate.
struct FollowingMeasure {
  Vec2 point_a, axis;
  template <class S, class B> [[nodiscard]] MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    MeasureValue<S> m;
    m.direction = to_ground(a, axis);
    m.lever_a = to_ground(a, point_a);
    m.lever_b = offset(a, b) + m.lever_a;
    m.rate = dot(m.direction, velocity_against(a, m.lever_a, b, m.lever_b));
    return m;
  }

private:
  template <class S, class B>
  static Pair<S> velocity_against(const Motion<S>& a, const Pair<S>& lever_a, const B& b, const Pair<S>& lever_b) {
    if constexpr (k_is_origin<B>) return point_velocity(a, lever_a);
    else return point_velocity(a, lever_a) - point_velocity(b, lever_b);
  }
};

struct ForceEntry {
  int a, b;
  RowSpec row; ///< row of the coordinate; for own_x and own_y, point_a and direction are in a's frame
  bool is_following = false;
  MotionFormula formula;
  double zero = 0.0; ///< for an angle: relative angle of the markers in their bodies, rad
  std::vector<SwitchScale> switches = {};
  int link = 0;
  int element = 0;     ///< index in System::element_names
  int unit = -1;       ///< index of the unit whose mode contains the switches; −1: the formula has no switches
  int first_event = 0; ///< index of the unit's first event function

  template <class S, class B> [[nodiscard]] STEPLAP_INLINE MeasureValue<S> measure(const Motion<S>& m, const B& of_b) const {
    if (is_following) return FollowingMeasure{row.point_a, row.direction}.at(m, of_b);
    return evaluate_row<false>(row, m, of_b);
  }
  template <class S> [[nodiscard]] OwnCoordinate<S> own(const MeasureValue<S>& m) const { return {m.value - S(zero), m.rate}; }
  [[nodiscard]] OwnCoordinate<double> own_now(const Evaluation& e) const { return own(measure(e.motion[a], e.motion[b])); }
  template <class S> [[nodiscard]] SwitchBits bits(const EvaluationData<S>& e) const { return unit < 0 ? 0 : e.mode[unit]; }
};

/// Collects the derivatives of the forces on a and b with respect to the motions of other bodies.
class SharesOfBodies {
public:
  SharesOfBodies(const ForceEntry& entry, std::vector<PairJacobian>& out) : entry_(entry), out_(out), first_(out.size()) {}

  /// Adds the derivative with respect to an operand, to which body `share.body` contributes. `along`: wrenches on a and b per unit force;
  /// `slope`: derivative of the force.
  void add(const Vec3 (&along)[2], double slope, const MotionShare& share) {
    if (share.body == k_ground) return;
    const int ends[2] = {entry_.a, entry_.b};
    for (int side = 0; side < 2; ++side) {
      if (ends[side] == k_ground) continue;
      PairJacobian& part = part_of(ends[side], share.body);
      const int column = ends[side] == share.body ? 0 : 3;
      part.stiffness.block<3, 3>(0, column) += slope * along[side] * share.pose.transpose();
      part.damping.block<3, 3>(0, column) += slope * along[side] * share.velocity.transpose();
    }
  }

private:
  PairJacobian& part_of(int row, int column) {
    for (std::size_t i = first_; i < out_.size(); ++i)
      if (out_[i].a == row && out_[i].b == column) return out_[i];
    PairJacobian& part = out_.emplace_back();
    part.a = row;
    part.b = column;
    part.stiffness.setZero();
    part.damping.setZero();
    return part;
  }

  const ForceEntry& entry_;
  std::vector<PairJacobian>& out_;
  std::size_t first_;
};

/// `Works`: the power is counted as work, otherwise as heat. `Jumps`: a formula contains comparisons, so its force may jump.
template <bool Works, bool Jumps> class FormulaForceGroup final : public ForceGroup {
public:
  using ElementData = ForceEntry;
  std::vector<ElementData> entries;
  static constexpr bool k_does_work = Works;

  void add_forces(Evaluation& e) const override { add_forces_to(e, NumericSignalEvaluator{e.t}); }
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override {
    add_forces_to<TapeNumber>(e, TracedSignalEvaluator{e});
    return true;
  }
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }

  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      const Gradient g(entry, e);
      PairJacobian& turning = out.emplace_back(); // change of direction and levers at constant force
      turning.a = entry.a;
      turning.b = entry.b;
      for (int i = 0; i < 6; ++i) {
        turning.stiffness.row(i) = g.value * g.along[i].d.template head<6>().matrix().transpose();
        turning.damping.row(i) = g.value * g.along[i].d.template tail<6>().matrix().transpose();
      }
      SharesOfBodies shares(entry, out);
      const auto& operands = entry.formula.operands();
      for (std::size_t i = 0; i < operands.size(); ++i)
        for (const MotionShare& share : shares_of(operands[i], e, g.own, entry.a, entry.b)) shares.add(g.on_ends, g.slopes[i], share);
    }
  }
  void add_state_jacobian(const Evaluation& e, StateJacobian& out) const override {
    for (const ElementData& entry : entries) {
      const Gradient g(entry, e);
      const auto& operands = entry.formula.operands();
      for (std::size_t i = 0; i < operands.size(); ++i) {
        if (operands[i].kind != MotionOperand::Kind::state) continue;
        const double slope = g.slopes[i] * operands[i].unit;
        if (entry.a != k_ground) out.forces.push_back({entry.a, operands[i].inner, slope * g.on_ends[0]});
        if (entry.b != k_ground) out.forces.push_back({entry.b, operands[i].inner, slope * g.on_ends[1]});
      }
    }
  }

  void register_formulas(std::vector<FormulaInMotion>& out) const override {
    for (const ElementData& entry : entries)
      out.push_back({&entry.formula, [&entry](const Evaluation& e) { return entry.own_now(e); }, entry.unit, entry.element});
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) {
      is_used[entry.a] = is_used[entry.b] = 1;
      for (const int body : entry.formula.bodies()) is_used[body] = 1;
    }
  }
  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries) {
      if (entry.is_following) turns.add_all({entry.a, entry.b});
      else turns.add(entry.a, entry.b, turning_of(entry.row));
      if (entry.row.kind == MeasureKind::angle && !entry.formula.program().is_linear()) turns.add(entry.a, entry.b);
      entry.formula.register_turns(turns);
    }
  }
  void register_links(LinkTable& links) override {
    for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
  }

  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override {
    FormulaProgram::Bits bits{0, 0};
    entries[element].formula.find_bits(e, entries[element].own_now(e), bits);
    return bits.values;
  }
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    return next_bits(entries[element].formula, mode, slot, e, entries[element].own_now(e));
  }
  // True for formulas without switches, too, because the signals in them may jump.
  [[nodiscard]] bool has_discontinuous_events() const override { return true; }
  [[nodiscard]] EventTolerance event_tolerance(int) const override { return Jumps ? EventTolerance::none : EventTolerance::velocity; }
  [[nodiscard]] EventKind event_kind(UnitMode, UnitMode) const override { return EventKind::passes_kink; }

  [[nodiscard]] double force_of(int i, const Evaluation& e) const {
    const ElementData& entry = entries[i];
    return entry.formula.value<double>(e, entry.own_now(e), NumericSignalEvaluator{e.t}, entry.bits(e), nullptr);
  }

private:
  /// Value and derivatives of one entry for the present motion.
  struct Gradient {
    OwnCoordinate<D12> own;
    D12 along[6];    ///< wrench on a and on b for unit value
    Vec3 on_ends[2]; ///< wrenches on a and b per unit force, without derivatives
    double value = 0.0;
    std::vector<double>& slopes; ///< derivative of the force with respect to each operand; valid until the next Gradient is created

    Gradient(const ElementData& entry, const Evaluation& e) : slopes(room()) {
      if (slopes.size() < entry.formula.operands().size()) slopes.resize(entry.formula.operands().size());
      const MeasureValue<D12> m = entry.measure(seeded(e.motion[entry.a], 0), seeded(e.motion[entry.b], 3));
      own = entry.own(m);
      const D12 couple_a = cross(m.lever_a, m.direction) + m.couple, couple_b = cross(m.lever_b, m.direction) + m.couple;
      const D12 rows[6] = {m.direction.x, m.direction.y, couple_a, -m.direction.x, -m.direction.y, -couple_b};
      for (int i = 0; i < 6; ++i) along[i] = rows[i];
      for (int side = 0; side < 2; ++side) on_ends[side] = Vec3(rows[3 * side].v, rows[3 * side + 1].v, rows[3 * side + 2].v);
      value = entry.formula.differentiate(e, {own.value.v, own.rate.v}, entry.bits(e), slopes.data());
    }

  private:
    static std::vector<double>& room() {
      static thread_local std::vector<double> kept;
      return kept;
    }
  };

  template <class S, class AtTime> void add_forces_to(EvaluationData<S>& e, const AtTime& at_time) const {
    S quantity[k_most_switches];
    for (const ElementData& entry : entries) {
      const MeasureValue<S> m = entry.measure(e.link_motion[entry.link], Origin{});
      const SwitchBits bits = entry.bits(e);
      preset_quantities(entry.formula.program().switch_count(), bits, quantity);
      const S f = entry.formula.value(e, entry.own(m), at_time, bits, quantity);
      if (entry.unit >= 0)
        switch_events(bits, quantity, entry.switches, e.event_value + entry.first_event, e.event_derivative + entry.first_event);
      apply_force(e.link_force[entry.link], m, f);
      if constexpr (Works) e.work += f * m.rate;
      else e.dissipation -= f * m.rate;
    }
  }
};

// Sets the row for the coordinate between these markers. Returns false, with an error, if its direction is undefined.
bool set_coordinate(const FormulaForce& e, const CompiledMarker& a, const CompiledMarker& b, SystemBuilder& builder, ForceEntry& entry) {
  const bool is_y = e.coordinate == "y" || e.coordinate == "own_y";
  const Vec2 axis = is_y ? Vec2(0.0, 1.0) : Vec2(1.0, 0.0);
  entry.is_following = e.coordinate == "own_x" || e.coordinate == "own_y";
  if (e.coordinate == "angle") {
    entry.row = row_of(a.body, b.body, AngleMeasure{});
    entry.zero = b.angle - a.angle;
  } else if (e.coordinate == "distance") {
    if ((builder.marker_position(a) - builder.marker_position(b)).norm() < 1e-12) {
      builder.error("its ends coincide, so its direction is undefined: move a marker");
      return false;
    }
    entry.row = row_of(a.body, b.body, DistanceMeasure{a.point, b.point});
  } else {
    entry.row = row_of(a.body, b.body, AxisMeasure{a.point, b.point, builder.direction(entry.is_following ? a : b, axis)});
  }
  return true;
}

template <class Group> void add(SystemBuilder& builder, ForceEntry entry, bool is_angle) {
  Group& group = builder.group<Group>();
  const int switch_count = entry.formula.program().switch_count();
  group.entries.push_back(std::move(entry));
  if (switch_count > 0) builder.add_unit(group, switch_count);
  const int i = static_cast<int>(group.entries.size()) - 1;
  const ForceEntry& added = group.entries.back();
  builder.add_channel(is_angle ? "couple" : "force", is_angle ? "N m" : "N",
                      {"what its formula gives, on a along the coordinate", "positive: towards larger values of the coordinate"},
                      [&group, i](const Snapshot& s) { return group.force_of(i, *s.evaluation); });
  builder.add_channel("power", "W", {"power that it gives", "negative while it brakes"}, [&group, i](const Snapshot& s) {
    return group.force_of(i, *s.evaluation) * group.entries[i].own_now(*s.evaluation).rate;
  });
  const RowSpec row = added.row;
  const double zero = added.zero;
  if (!added.is_following)
    builder.offer_channel(
        "value", is_angle ? "rad" : "m", {"of its coordinate", "as the coordinate counts"},
        MeasuredValue{[row, zero](const Snapshot& s) { return evaluate_row<false>(row, s.motion).value - zero; }, row, zero, false});
  builder.offer_channel("rate", is_angle ? "rad/s" : "m/s", {"of its coordinate", "positive: it grows"},
                        [&group, i](const Snapshot& s) { return group.entries[i].own_now(*s.evaluation).rate; });
}

// Returns an evaluation in the reference pose, to check that formulas have a value there.
Evaluation reference_evaluation(SystemBuilder& builder, const std::vector<double>& inner) {
  Evaluation e;
  e.motion = &builder.reference(k_ground);
  e.inner = inner.data();
  return e;
}

void compile_formula_force(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const FormulaForce&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("acts on a body against itself: name markers on two different bodies");
  const bool is_angle = e.coordinate == "angle", is_following = e.coordinate == "own_x" || e.coordinate == "own_y";
  ForceEntry entry{a.body,
                   b.body,
                   {},
                   false,
                   MotionFormula(builder, {e.formula, "formula", is_angle ? "N m" : "N",
                                           is_following ? "-"
                                           : is_angle   ? "rad"
                                                        : "m",
                                           is_angle ? "rad/s" : "m/s"})};
  if (!set_coordinate(e, a, b, builder, entry) || !entry.formula.is_valid()) return;
  const std::vector<double> inner = start_of_states(builder);
  const Evaluation start = reference_evaluation(builder, inner);
  const OwnCoordinate<double> own = entry.own_now(start);
  FormulaProgram::Bits bits{0, 0};
  entry.formula.find_bits(start, own, bits);
  if (!std::isfinite(entry.formula.value<double>(start, own, NumericSignalEvaluator{0.0}, bits.values, nullptr)))
    return builder.error(
        "'formula' has no finite value at the start: something is divided by zero, or a root or logarithm is taken of what has none");
  entry.switches = scales_of(entry.formula, start, own);
  entry.element = builder.element_index();
  const bool jumps = entry.formula.program().has_comparisons();
  if (e.energy == "work")
    jumps ? add<FormulaForceGroup<true, true>>(builder, std::move(entry), is_angle)
          : add<FormulaForceGroup<true, false>>(builder, std::move(entry), is_angle);
  else
    jumps ? add<FormulaForceGroup<false, true>>(builder, std::move(entry), is_angle)
          : add<FormulaForceGroup<false, false>>(builder, std::move(entry), is_angle);
}

} // namespace

const ElementKind& formula_force_kind() {
  static const ElementKind kind = [] {
    using T = FormulaForce;
    ElementKind k;
    k.name = "force";
    k.doc = "A force or couple on a along a coordinate, its opposite on b, whose value is a formula of places, angles, velocities, states, "
            "signals, parameters and time: drag, magnets, tyres, controllers. Syntax: `docs/reference/formulas_of_forces.md`.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker or body that it acts on");
    f.add("b", &T::b).as(FieldType::marker).doc("marker that its opposite acts on, whose axes count");
    f.add("coordinate", &T::coordinate)
        .one_of({"x", "y", "distance", "angle", "own_x", "own_y"})
        .doc(
            "x, y: of marker a in marker b's axes; distance of the markers; angle of a against b; own_x, own_y: along marker a's own axes");
    f.add("formula", &T::formula)
        .required()
        .doc("its value, in N or N m; `value` and `rate` are those of the coordinate: \"-'0.3 N s2/m2' * abs(rate) * rate\"");
    f.add("energy", &T::energy).one_of({"work", "dissipated"}).doc("how its power is booked: work of a drive, or heat");
    k.example = R"([[element]]
name = 'push'
kind = 'force'
a = 'a'
b = 'b'
coordinate = 'distance'
formula = "'1 N'"
[[element]]
name = 'brake'
kind = 'force'
a = 'a'
b = 'b'
coordinate = 'angle'
energy = 'dissipated'
formula = "-'1 N m s' * rate"
)";
    k.stage = 1;
    k.holds<T>();
    k.compile = compile_formula_force;
    // A formula of signals, parameters and time is a load; with places or velocities it may be a spring.
    k.acts_from_outside = [](const Element& element, const Model& model) {
      const std::vector<std::string> names = Formula(static_cast<const T&>(element).formula, "formula", {}).names();
      return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
        return model.parameters.find(name) || std::any_of(model.signals.begin(), model.signals.end(),
                                                          [&](const SignalEntry& signal) { return signal.definition->name == name; });
      });
    };
    // A formula without names is a constant load.
    k.has_constant_load = [](const Element& element) {
      return Formula(static_cast<const T&>(element).formula, "formula", {}).names().empty();
    };
    return k;
  }();
  return kind;
}

} // namespace steplap
