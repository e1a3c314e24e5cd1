#include "elements/machinery/buffer.h"

#include "elements/spring_laws.h"
#include "mbd/base/shown_text.h"
#include "mbd/system/bounded_friction.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace steplap {

namespace {

// Relative distance of both curves below which they coincide, for rounding errors of the interpolation.
constexpr double k_same_curve = 1e-12;

using CurveGroup = LawGroup<AxisMeasure, TabulatedSpring>;

// Friction of a buffer, with a bound of half the distance between its curves. Bound and spring table have the same corners, which are
// changes of the spring's mode; within a mode both are linear.
class BufferFriction final : public BoundedFriction {
public:
  RowSpec row;
  PiecewiseLinear bound; ///< bound, N, as a function of the row's change since first contact, like the spring table
  double free = 0.0;     ///< value of the row at first contact, m
  int unit = 0;          ///< index of the spring's unit

  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return &row; }
  void mark_bodies(std::vector<char>& is_used) const override { is_used[row.a] = is_used[row.b] = 1; }
  [[nodiscard]] bool is_loaded(const Evaluation& e, const FrictionState&) const override {
    const int segment = TabulatedSpring::spring_segment(e.mode[unit]);
    if (segment >= bound.segments() - 1) return false;                      // the last segment is the open buffer
    return bound.slope(segment) != 0.0 || bound.value(0.0, segment) != 0.0; // where both curves coincide the buffer is a spring
  }
  void slip_wrench(const Evaluation& e, const FrictionState& state, const double*, double* wrench) const override {
    wrench[0] = -state.sign * bound_at<double>(e);
  }
  [[nodiscard]] WrenchBounds bounds(const Evaluation& e, const FrictionState&, bool /*kinetic*/) const override {
    return WrenchBounds::symmetric(std::max(0.0, bound_at<double>(e)));
  }
  void stick_events(const Evaluation& e, const FrictionState&, const double* wrench, double* event_value) const override {
    bound_events<double>(e, wrench, event_value);
  }
  [[nodiscard]] bool record_friction(TracedEvaluation& e, const FrictionState& state, const TapeNumber* rate, TapeNumber* wrench,
                                     TapeNumber* event_value) const override {
    if (rate) {
      wrench[0] = -state.sign * bound_at<TapeNumber>(e);
      event_value[0] = state.sign * rate[0];
      event_value[1] = 1.0;
    } else {
      bound_events<TapeNumber>(e, wrench, event_value);
    }
    event_value[2] = 1.0;
    return true;
  }

private:
  // Returns the bound, continued linearly beyond the ends of the segment like the spring, so that a step beyond an end sees no corner.
  template <class S> [[nodiscard]] S bound_at(const EvaluationData<S>& e) const {
    const S value = evaluate_row<false>(row, e.motion[row.a], e.motion[row.b]).value;
    return bound.value(value - S(free), TabulatedSpring::spring_segment(e.mode[unit]));
  }
  template <class S> void bound_events(const EvaluationData<S>& e, const S* wrench, S* event_value) const {
    steplap::bound_events<S>(bound_at(e), wrench[0], event_value);
  }
};

// Interpolates linearly; continues beyond the last point with the slope of the last segment.
double value_at(const std::vector<Vec2>& curve, double depth) {
  const auto next = std::find_if(curve.begin() + 1, curve.end() - 1, [depth](const Vec2& p) { return depth <= p.x(); });
  const Vec2 &low = *std::prev(next), &high = *next;
  return low.y() + (high.y() - low.y()) / (high.x() - low.x()) * (depth - low.x());
}

struct Curves {
  const std::vector<Vec2>&loading, &unloading;

  [[nodiscard]] double pressed_in(double depth) const { return value_at(loading, depth); }
  /// Returns the unloading force at a depth. Beyond its last point the unloading curve keeps its distance from the loading curve, so that
  /// they do not cross.
  [[nodiscard]] double let_go(double depth) const {
    const Vec2& last = unloading.back();
    return depth > last.x() ? pressed_in(depth) - (pressed_in(last.x()) - last.y()) : value_at(unloading, depth);
  }
  /// Returns the depths of the corners of both curves, in descending order, ending with first contact.
  [[nodiscard]] std::vector<double> corners() const {
    std::vector<double> depths;
    for (const std::vector<Vec2>* curve : {&loading, &unloading})
      for (const Vec2& p : *curve) depths.push_back(p.x());
    std::sort(depths.begin(), depths.end(), std::greater<>());
    depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
    depths.insert(depths.begin(), 2.0 * depths.front());
    return depths;
  }
};

// Returns a table over the elongation −d. Its last segment is the open buffer, with zero force.
template <class Force> PiecewiseLinear table(const std::vector<double>& depths, const Force& force) {
  std::vector<Vec2> points;
  for (const double depth : depths) points.emplace_back(-depth, depth > 0.0 ? force(depth) : 0.0);
  points.emplace_back(1.0, 0.0);
  return PiecewiseLinear(std::move(points));
}

bool is_curve(const std::vector<Vec2>& curve, const char* name, SystemBuilder& builder) {
  const auto fail = [&](const std::string& what) {
    builder.error("'" + std::string(name) + "' " + what);
    return false;
  };
  if (curve.size() < 2) return fail("needs at least two points, [depth, force]");
  if (curve.size() > PiecewiseLinear::k_most_points / 4) return fail("may have at most 16384 points");
  if (curve.front() != Vec2::Zero())
    return fail("has to begin at [0, 0]: of a buffer with a preload the second point lies close to the first, and high");
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (!(curve[i].x() > curve[i - 1].x())) return fail("has to increase in depth from point to point");
    if (!(curve[i].y() >= 0.0)) return fail("has a negative force: a buffer pushes");
  }
  return true;
}

bool check(const Buffer& e, const std::vector<Vec2>& unloading, SystemBuilder& builder) {
  if (e.axis.norm() == 0.0) {
    builder.error("'axis' has no direction");
    return false;
  }
  if (!is_curve(e.loading, "loading", builder) || !is_curve(unloading, "unloading", builder)) return false;
  const Curves curves{e.loading, unloading};
  for (const double depth : curves.corners()) // corners of both curves suffice, because both are linear in between
    if (!(curves.let_go(depth) <= curves.pressed_in(depth))) {
      builder.error("'unloading' lies above 'loading' at a depth of " + rounded_text(depth) +
                    " m, where it would give back more than it took");
      return false;
    }
  return true;
}

void compile_buffer(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Buffer&>(element);
  const std::vector<Vec2>& unloading = e.unloading.empty() ? e.loading : e.unloading;
  if (!check(e, unloading, builder)) return;
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("presses a body against itself: name markers on two different bodies");
  const AxisMeasure measure{a.point, b.point, builder.direction(b, e.axis)};
  const double now = measure.at<false, double>(builder.reference(a.body), builder.reference(b.body)).value;
  const double free = now - e.gap, n = static_cast<double>(e.count);
  const Curves curves{e.loading, unloading};
  const std::vector<double> depths = curves.corners();
  // The tables contain negative forces, because a spring exerts the negative value of its table.
  const PiecewiseLinear middle = table(depths, [&](double d) { return -0.5 * n * (curves.pressed_in(d) + curves.let_go(d)); });
  const PiecewiseLinear without({{-1.0, 0.0}, {1.0, 0.0}});

  CurveGroup& group = builder.group<CurveGroup>();
  group.entries.push_back({a.body, b.body, measure, TabulatedSpring{middle, without, free, 1.0}});
  builder.add_unit(group, TabulatedSpring::k_event_count);
  const int i = static_cast<int>(group.entries.size()) - 1, unit = group.entries.back().unit;

  auto friction = std::make_unique<BufferFriction>();
  RowSpec& row = friction->row;
  row.a = a.body;
  row.b = b.body;
  row.point_a = a.point;
  row.point_b = b.point;
  row.direction = measure.axis;
  row.quantity = "slide";
  row.element = builder.element_index();
  row.base = builder.add_base();
  friction->bound = table(depths, [&](double d) {
    const double in = curves.pressed_in(d), between = in - curves.let_go(d);
    return between > k_same_curve * in ? 0.5 * n * between : 0.0;
  });
  friction->free = free;
  friction->unit = unit;

  const int f = builder.next_friction(), slot = builder.next_friction_row(), last = friction->bound.segments() - 1;
  builder.add_channel("depth", "m", {"by which it is pressed in", "negative: the gap that is left"},
                      motion_value(a.body, b.body, measure, [free](const auto& m) { return free - m.value; }));
  builder.add_channel("rate", "m/s", {"of the depth", "positive: it is pressed in"},
                      motion_value(a.body, b.body, measure, [](const auto& m) { return -m.rate; }));
  builder.add_channel("force", "N", {"of spring and friction, zero while open", "positive: it presses"},
                      [&group, i, slot](const Snapshot& s) { return group.force_of(i, *s.evaluation) + s.friction_force[slot]; });
  builder.add_channel("mode", "", {"state", "", "0 open, 1 sticks, 2 moves"}, [f, unit, last](const Snapshot& s) {
    if (TabulatedSpring::spring_segment(s.evaluation->mode[unit]) == last) return 0.0;
    return s.evaluation->friction[f].phase == FrictionPhase::stick ? 1.0 : 2.0;
  });
  builder.add_friction(std::move(friction));
}

} // namespace

const ElementKind& buffer_kind() {
  static const ElementKind kind = [] {
    using T = Buffer;
    ElementKind k;
    k.name = "buffer";
    k.doc = "Buffer or draw gear of a railway vehicle: pressed in it follows one curve, let go a lower one, and between them it "
            "sticks. A draw gear is a buffer whose axis points the other way.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker that is pushed off");
    f.add("b", &T::b).as(FieldType::marker).doc("marker in whose axes its axis is given");
    f.add("axis", &T::axis).doc("the way in which a is pushed, in marker b's axes");
    f.add("loading", &T::loading)
        .in("m", "N")
        .required()
        .doc("[depth, force] while it is pressed in, from [0, 0] on, straight between them and on beyond the last");
    f.add("unloading", &T::unloading)
        .in("m", "N")
        .doc("the same during release, beyond the last point parallel to loading; default: as for compression");
    f.add("gap", &T::gap).in("m").doc("what is left in the reference pose; negative: pressed in by so much");
    f.add("count", &T::count).at_least(1).doc("equal buffers side by side");
    k.example = R"([[element]]
name = 'buffer'
kind = 'buffer'
a = 'a'
b = 'b'
loading = [[0.0, 0.0], [0.1, 5e5]]
)";
    k.holds<T>();
    k.compile = compile_buffer;
    return k;
  }();
  return kind;
}

} // namespace steplap
