#include "elements/machinery/cam.h"

#include "elements/body_blocks.h"
#include "elements/contact_laws.h"
#include "elements/machinery/lift_curve.h"
#include "mbd/base/shown_text.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/motion_formula.h"
#include "mbd/system/system.h"
#include "mbd/system/turn_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap {

namespace {

struct CamEntry {
  std::string name;
  int a = k_ground, b = k_ground, cam = k_ground;
  AxisMeasure measure; ///< displacement of a relative to b along the axis
  LiftCurve curve;
  double zero = 0.0; ///< φ for θ_cam = θ_b, rad
  KelvinVoigtContact law = {};
  bool holds = false;
  int unit = 0, first_event = 0;

  [[nodiscard]] std::array<int, 3> bodies() const { return {a, b, cam}; }
};

/// Gap, its rate, and the effect of a unit force.
template <class S> struct CamGap {
  MeasureValue<S> m;             ///< measure of the follower, without the lift
  S value{0}, rate{0}, slope{0}; ///< slope: h′, m/rad
};

double with_slope(double, double value, double) { return value; }
template <int N> Dual<N> with_slope(const Dual<N>& angle, double value, double slope) { return {value, slope * angle.d}; }

template <class S> CamGap<S> gap_of(const CamEntry& entry, const Motion<S>& a, const Motion<S>& b, const Motion<S>& cam) {
  CamGap<S> gap;
  gap.m = entry.measure.at<false, S>(a, b);
  const S angle = cam.theta - b.theta + S(entry.zero);
  const Lift lift = entry.curve.at(value_of(angle));
  gap.slope = with_slope(angle, lift.slope, lift.curvature);
  gap.value = gap.m.value - with_slope(angle, lift.value, lift.slope);
  gap.rate = gap.m.rate - gap.slope * (cam.omega - b.omega);
  return gap;
}

template <class S> std::array<BodyForceOf<S>, 3> forces_of(const CamGap<S>& gap, const S& f) {
  std::array<BodyForceOf<S>, 3> on;
  add_at(on[0], gap.m.lever_a, f * gap.m.direction);
  add_at(on[1], gap.m.lever_b, -f * gap.m.direction);
  on[1].m += f * gap.slope;
  on[2].m -= f * gap.slope;
  return on;
}

class CamGroup final : public ForceGroup {
public:
  using ElementData = CamEntry;
  std::vector<ElementData> entries;

  [[nodiscard]] static CamGap<double> gap_now(const ElementData& entry, const Motion<double>* motion) {
    return gap_of(entry, motion[entry.a], motion[entry.b], motion[entry.cam]);
  }
  [[nodiscard]] static double force(const ElementData& entry, const CamGap<double>& gap, const Evaluation& e) {
    return entry.law.force(gap.value, gap.rate, mode_of(entry, e));
  }

  void add_forces(Evaluation& e) const override {
    for (const ElementData& entry : entries) {
      refuse_unsearched(entry, e.motion);
      const CamGap<double> gap = gap_now(entry, e.motion);
      const UnitMode mode = mode_of(entry, e);
      const double f = entry.law.force(gap.value, gap.rate, mode);
      if (!entry.holds)
        entry.law.event_value(gap.value, gap.rate, mode, e.event_value + entry.first_event, e.event_derivative + entry.first_event);
      e.dissipation += (entry.law.elastic_force(gap.value, mode) - f) * gap.rate;
      if (f == 0.0) continue;
      const std::array<int, 3> bodies = entry.bodies();
      const std::array<BodyForce, 3> on = forces_of(gap, f);
      for (std::size_t i = 0; i < 3; ++i) {
        BodyForce& sum = e.force[bodies[i]];
        sum.fx += on[i].fx;
        sum.fy += on[i].fy;
        sum.m += on[i].m;
      }
    }
  }
  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries) {
      const double value = gap_now(entry, motion).value;
      sum += entry.holds ? 0.5 * entry.law.k * (value - entry.law.offset) * (value - entry.law.offset) : entry.law.energy(value);
    }
    return sum;
  }
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      const CamGap<Dual<18>> gap =
          gap_of(entry, seeded_of<3>(e.motion[entry.a], 0), seeded_of<3>(e.motion[entry.b], 1), seeded_of<3>(e.motion[entry.cam], 2));
      const Dual<18> f = entry.law.force(gap.value, gap.rate, mode_of(entry, e));
      add_body_blocks<3>(entry.bodies(), forces_of(gap, f), out);
    }
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries)
      for (const int body : entry.bodies()) is_used[body] = 1;
  }
  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries) {
      turns.add(entry.a, entry.b, turning_of(entry.measure));
      turns.add(entry.cam, entry.b);
      if (!entry.curve.knots().empty())
        turns.add(entry.cam, entry.b, TurnKnots{entry.zero, entry.curve.knots(), entry.curve.is_periodic()});
    }
  }
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override {
    const ElementData& entry = entry_at(element);
    if (entry.holds) return k_contact_pressed;
    const CamGap<double> gap = gap_now(entry, e.motion);
    return entry.law.initial_mode(gap.value, gap.rate);
  }
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    const ElementData& entry = entry_at(element);
    const CamGap<double> gap = gap_now(entry, e.motion);
    return entry.law.next_mode(mode, slot, gap.value, gap.rate, rounding_of(entry, gap, e));
  }
  [[nodiscard]] bool is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    const ElementData& entry = entry_at(element);
    const CamGap<double> gap = gap_now(entry, e.motion);
    return entry.law.is_armed_at_entry(mode, slot, gap.value, rounding_of(entry, gap, e));
  }
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override { return KelvinVoigtContact::event_kind(from, to); }

private:
  [[nodiscard]] const ElementData& entry_at(int element) const { return entries[static_cast<std::size_t>(element)]; }
  static UnitMode mode_of(const ElementData& entry, const Evaluation& e) { return entry.holds ? k_contact_pressed : e.mode[entry.unit]; }
  static void refuse_unsearched(const ElementData& entry, const Motion<double>* motion) {
    const double angle = motion[entry.cam].theta - motion[entry.b].theta + entry.zero;
    if (std::abs(angle) > entry.curve.searched_to())
      throw ElementFailure("'formula' of cam '" + entry.name + "' does not repeat itself, and beyond " +
                               rounded_text(entry.curve.searched_to() / (2.0 * std::numbers::pi), 3) +
                               " turns steps may leap over its lobes: give a formula with whole periods in 64 turns, or 'lift' as points",
                           {entry.name});
  }
  // Includes the rounding error of the lift by that of the angle, which may be many turns.
  static double rounding_of(const ElementData& entry, const CamGap<double>& gap, const Evaluation& e) {
    const Motion<double>&a = e.motion[entry.a], &b = e.motion[entry.b], &cam = e.motion[entry.cam];
    return value_rounding(gap.m, a, b) +
           k_rounded_sum * (std::abs(gap.slope) * (std::abs(cam.theta) + std::abs(b.theta)) + std::abs(gap.value - gap.m.value));
  }
};

// Returns the points with the last point of a periodic table, which repeats the first one a whole turn later and is often omitted. It is
// added to a table with equal intervals of which one is missing, and to a table whose last lift equals the first if the gap is no wider
// than its intervals. Returns nothing for other tables.
std::optional<std::vector<Vec2>> closed_turn(std::vector<Vec2> points) {
  constexpr double k_digits = 1e-3; // angles and lifts are given with at least three digits
  double widest = 0.0, narrowest = std::numeric_limits<double>::infinity(), low = points.front().y(), high = low;
  for (std::size_t i = 1; i < points.size(); ++i) {
    widest = std::max(widest, points[i].x() - points[i - 1].x());
    narrowest = std::min(narrowest, points[i].x() - points[i - 1].x());
    low = std::min(low, points[i].y());
    high = std::max(high, points[i].y());
  }
  const Vec2 end(points.front().x() + 2.0 * std::numbers::pi, points.front().y());
  const double left_out = end.x() - points.back().x();
  const bool is_even = std::max(widest, left_out) - std::min(narrowest, left_out) <= k_digits * widest;
  const bool ends_alike = std::abs(points.back().y() - end.y()) <= k_digits * (high - low);
  if (!is_even && !(ends_alike && left_out <= widest)) return std::nullopt;
  points.push_back(end);
  return points;
}

// Returns why the smooth curve is not the one meant by the points, "" if it may be. Between two points it may leave their range by half of the
// whole lift, and in a dwell, three points of equal lift or more, by a tenth.
std::string swings_between(const std::vector<Vec2>& points, const LiftCurve& curve) {
  constexpr double k_most = 0.5, k_most_in_dwell = 0.1;
  constexpr int k_parts = 16;
  const auto by_lift = [](const Vec2& x, const Vec2& y) { return x.y() < y.y(); };
  const auto [lowest, highest] = std::minmax_element(points.begin(), points.end(), by_lift);
  const double whole = highest->y() - lowest->y();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec2 &from = points[i - 1], &to = points[i];
    const bool is_dwell =
        from.y() == to.y() && ((i > 1 && points[i - 2].y() == from.y()) || (i + 1 < points.size() && points[i + 1].y() == to.y()));
    double most = 0.0;
    for (int k = 1; k < k_parts; ++k) {
      const double lift = curve.at(from.x() + (to.x() - from.x()) * k / k_parts).value;
      most = std::max({most, lift - std::max(from.y(), to.y()), std::min(from.y(), to.y()) - lift});
    }
    if (most > (is_dwell ? k_most_in_dwell : k_most) * whole)
      return "the smooth curve through 'lift' leaves its points by " + rounded_text(most, 2) + " m between [" + rounded_text(from.x()) +
             ", " + rounded_text(from.y()) + "] and [" + rounded_text(to.x()) + ", " + rounded_text(to.y()) +
             "]: add points there, as close together as those next to them";
  }
  return "";
}

// Returns the lift curve; nothing after an error.
std::optional<LiftCurve> curve_of(const Cam& e, SystemBuilder& builder) {
  const auto fail = [&](const std::string& message) -> std::optional<LiftCurve> {
    builder.error(message);
    return std::nullopt;
  };
  if (e.lift.empty() == e.formula.empty()) return fail("give either 'lift', as points, or its 'formula'");
  if (!e.formula.empty()) {
    const MotionFormula formula(builder, {e.formula, "formula", "m", "rad", "-"});
    if (!formula.is_valid()) return std::nullopt;
    for (const MotionOperand& operand : formula.operands())
      if (operand.kind != MotionOperand::Kind::own_value) return fail("'formula' may hold the angle `value` and parameters alone");
    if (formula.program().uses_time()) return fail("'formula' may hold the angle `value` and parameters alone, not the time");
    if (formula.program().switch_count() > 0)
      return fail("'formula' has a kink or a jump (abs, min, max or a comparison), which a cam has not: give 'lift', as points");
    if (formula.operands().empty()) return fail("'formula' does not hold the angle `value`: such a cam lifts nothing");
    LiftCurve curve(formula.program(), formula.tree());
    if (!std::isfinite(curve.at(e.start_angle).value) || !std::isfinite(curve.at(e.start_angle).slope))
      return fail("'formula' has no finite value and slope at the start");
    return curve;
  }
  if (e.lift.size() < 3) return fail("'lift' needs at least three points, [angle, lift]");
  if (e.lift.size() > 65536) return fail("'lift' may have at most 65536 points");
  for (std::size_t i = 1; i < e.lift.size(); ++i)
    if (!(e.lift[i].x() > e.lift[i - 1].x())) return fail("'lift' has to increase in angle from point to point");
  if (LiftCurve::is_whole_turn(e.lift) && e.lift.back().y() != e.lift.front().y())
    return fail("'lift' spans a whole turn, but ends at " + rounded_text(e.lift.back().y()) + " m where it begins with " +
                rounded_text(e.lift.front().y()) + " m");
  const double span = e.lift.back().x() - e.lift.front().x(), turn = 2.0 * std::numbers::pi;
  if (span > 6.2831853072) return fail("'lift' spans more than a whole turn");
  const auto through = [&](const std::vector<Vec2>& points) -> std::optional<LiftCurve> {
    LiftCurve curve(points);
    if (const std::string swings = swings_between(points, curve); !swings.empty()) return fail(swings);
    return curve;
  };
  if (LiftCurve::is_whole_turn(e.lift)) return through(e.lift);
  const std::optional<std::vector<Vec2>> closed = closed_turn(e.lift);
  if (closed) return through(*closed);
  return fail("'lift' spans " + rounded_text(span * 360.0 / turn, 4) + " degrees of a turn, from " + rounded_text(e.lift.front().x()) +
              " to " + rounded_text(e.lift.back().x()) + " rad only. Add points up to [" + rounded_text(e.lift.front().x() + turn, 12) +
              ", " + rounded_text(e.lift.front().y()) +
              "], a whole turn behind the first one and with its lift; a dwell is points of equal lift");
}

void compile_cam(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Cam&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b), cam = builder.marker(e.cam);
  if (a.body == b.body) return builder.error("lifts a body against itself: name markers on two different bodies");
  if (cam.body == a.body || cam.body == b.body) return builder.error("'cam' must be a separate body, neither the follower nor the frame");
  if (e.axis.norm() == 0.0) return builder.error("'axis' has no direction");
  std::optional<LiftCurve> curve = curve_of(e, builder);
  if (!curve) return;
  CamGroup& group = builder.group<CamGroup>();
  CamEntry entry{e.name, a.body, b.body, cam.body, {a.point, b.point, builder.direction(b, e.axis)}, std::move(*curve)};
  entry.zero = e.start_angle - (builder.reference(cam.body).theta - builder.reference(b.body).theta);
  entry.holds = e.holds;
  const double now = CamGroup::gap_now(entry, &builder.reference(0)).value;
  entry.law = {e.stiffness, e.damping, now - e.gap};
  group.entries.push_back(std::move(entry));
  if (!e.holds) builder.add_unit(group, KelvinVoigtContact::k_event_count);
  const int i = static_cast<int>(group.entries.size()) - 1;
  const auto at = [&group, i](const Snapshot& s) { return CamGroup::gap_now(group.entries[static_cast<std::size_t>(i)], s.motion); };
  builder.add_channel("gap", "m", {"between follower and cam", "negative: pressed in"},
                      [at, &group, i](const Snapshot& s) { return at(s).value - group.entries[static_cast<std::size_t>(i)].law.offset; });
  builder.add_channel("force", "N", {"on the follower", "positive: it is lifted"}, [at, &group, i](const Snapshot& s) {
    return CamGroup::force(group.entries[static_cast<std::size_t>(i)], at(s), *s.evaluation);
  });
  builder.add_channel("couple", "N m", {"on the cam", "positive counter-clockwise"}, [at, &group, i](const Snapshot& s) {
    return -at(s).slope * CamGroup::force(group.entries[static_cast<std::size_t>(i)], at(s), *s.evaluation);
  });
  builder.add_channel("lift", "m", {"of the curve at the cam's angle, from that in the reference pose", "positive: along the axis"},
                      [at, start = group.entries[static_cast<std::size_t>(i)].curve.at(e.start_angle).value](const Snapshot& s) {
                        return at(s).m.value - at(s).value - start;
                      });
}

} // namespace

const ElementKind& cam_kind() {
  static const ElementKind kind = [] {
    using T = Cam;
    ElementKind k;
    k.name = "cam";
    k.doc =
        "A cam lifts marker a along an axis of marker b by a curve of its angle against b. The follower is pressed and never held, so that "
        "it "
        "leaves a cam that turns too fast, unless a groove holds it. The cam's bearing and the follower's guide are joints of their own.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker or body that is lifted");
    f.add("b", &T::b).as(FieldType::marker).doc("marker of the frame, in whose axes its axis is given");
    f.add("cam", &T::cam).as(FieldType::marker).required().doc("body that turns, or a marker on it");
    f.add("axis", &T::axis).doc("direction in which it is lifted, in marker b's axes");
    f.add("lift", &T::lift)
        .in("rad", "m")
        .doc(
            "[angle, lift] over one whole turn: a smooth curve through them, periodic. The last point, where the first comes again, may be "
            "left out");
    f.add("formula", &T::formula).doc("instead: lift in m over the angle `value`: \"'4 mm' * (1 - cos(value))\"");
    f.add("start_angle", &T::start_angle).in("rad").doc("of the cam in the reference pose, as the curve counts");
    f.add("gap", &T::gap).in("m").doc("between follower and cam in the reference pose; negative: pressed in");
    f.add("holds", &T::holds).doc("true: a groove holds the follower both ways");
    f.add("stiffness", &T::stiffness).in("N/m").positive().required().doc("of the contact");
    f.add("damping", &T::damping).in("N s/m").not_negative().doc("while it is pressed; never pulls");
    k.example = R"toml([[body]]
name = 'shaft'
mass = 1.0
inertia = 1.0
[[element]]
name = 'cam'
kind = 'cam'
a = 'a'
b = 'b'
cam = 'shaft'
formula = "'4 mm' * (1 - cos(value))"
stiffness = 1e4
)toml";
    k.stage = 1;
    k.holds<T>();
    k.compile = compile_cam;
    return k;
  }();
  return kind;
}

} // namespace steplap
