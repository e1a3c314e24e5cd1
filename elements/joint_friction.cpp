#include "elements/joint_friction.h"

#include "elements/share_channel.h"
#include "mbd/base/shown_text.h"
#include "mbd/system/bounded_friction.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Returns true if the signal is zero throughout the piece that contains t.
bool is_zero_at(const Signal& signal, double t) {
  const std::vector<Signal::Piece>& pieces = signal.pieces();
  const auto next = std::upper_bound(pieces.begin(), pieces.end(), t, [](double time, const Signal::Piece& p) { return time < p.start; });
  if (next == pieces.begin()) return true;
  const Signal::Piece& piece = *std::prev(next);
  return piece.is_level && piece.c[0] == 0.0 && piece.harmonics.empty() && piece.modulated.empty();
}

// Returns times between which a piece from `start` to `end` has its minimum: its ends and the zeros of its slope, or, with harmonics,
// samples that resolve them.
std::vector<double> places_of_least(const Signal& signal, const Signal::Piece& piece, double start, double end) {
  constexpr double k_samples_of_a_turn = 64.0, k_whole_turn = 6.283185307179586;
  std::vector<double> places{start, end};
  if (!piece.harmonics.empty() || !piece.modulated.empty()) {
    const double samples = std::ceil(k_samples_of_a_turn * (1.0 + signal.fastest_at(start) * (end - start) / k_whole_turn));
    for (double k = 1.0; k < samples; ++k) places.push_back(start + k * (end - start) / samples);
    return places;
  }
  const double a = 3.0 * piece.c[3], b = piece.c[2], c = piece.c[1], root = std::sqrt(std::max(0.0, b * b - a * c));
  // Zeros of the slope: two for a cubic (first and second), one for a quadratic (third).
  for (const double tau : {(-b - root) / a, (-b + root) / a, -0.5 * c / b})
    if (const double t = piece.start + tau; t > start && t < end) places.push_back(t);
  return places;
}

// Returns the time of the least value of the signal up to `end`. With harmonics the minimum is refined between two samples.
double time_of_least(const Signal& signal, double end) {
  double best = 0.0, low = 0.0, high = 0.0;
  const std::vector<Signal::Piece>& pieces = signal.pieces();
  for (std::size_t i = 0; i < pieces.size() && pieces[i].start < end; ++i) {
    const double from = std::max(0.0, pieces[i].start), to = i + 1 < pieces.size() ? std::min(end, pieces[i + 1].start) : end;
    if (!(from < to)) continue;
    std::vector<double> places = places_of_least(signal, pieces[i], from, std::nextafter(to, from));
    std::sort(places.begin(), places.end());
    for (std::size_t k = 0; k < places.size(); ++k)
      if (signal.value(places[k]) < signal.value(best)) {
        best = places[k];
        low = places[k > 0 ? k - 1 : 0];
        high = places[std::min(k + 1, places.size() - 1)];
      }
  }
  for (int n = 0; n < 60; ++n) {
    const double one = low + (high - low) / 3.0, other = high - (high - low) / 3.0;
    if (signal.value(one) < signal.value(other)) high = other;
    else low = one;
  }
  const double least = 0.5 * (low + high);
  return signal.value(least) < signal.value(best) ? least : best;
}

// Returns false and reports an error if the signal becomes negative. Negative pressure has no meaning, and the kink of a pressure clipped
// at zero would not be located as an event.
bool is_pressure(const JointFriction& e, const Signal* signal, SystemBuilder& builder) {
  constexpr double k_rounded_zero = 1e-12; // a signal that touches zero may be rounded to this far below it
  if (!signal) return true;
  const double t = time_of_least(*signal, builder.model().simulation.end), least = signal->value(t);
  if (least >= -k_rounded_zero) return true;
  builder.error("'signal': '" + e.signal + "' falls to " + rounded_text(least) + " at t = " + rounded_text(t) +
                " s, and what presses is never below zero: add an offset, or make it of pulses");
  return false;
}

// Friction of one coordinate. The bound for sliding at rate v is drags + (holds − drags)/(1 + (v/v_s)²), with Stribeck velocity v_s (Hess
// and Soom, 1990), plus a viscous part. It is a smooth even function of v, so a step may extend beyond the end of a slip.
class CoordinateFriction final : public BoundedFriction {
public:
  RowSpec row;
  double holds = 0.0, drags = 0.0, viscous = 0.0;
  double per_stribeck_velocity = 0.0; ///< 1/v_s, s/m or s/rad; 0: the bound does not depend on velocity
  const Signal* signal = nullptr;     ///< signal that multiplies all bounds; null: factor 1

  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return &row; }
  void mark_bodies(std::vector<char>& is_used) const override { is_used[row.a] = is_used[row.b] = 1; }
  // Evaluated at events only: the friction is free during pieces of the signal that are zero throughout, and such pieces begin and end with
  // an event.
  [[nodiscard]] bool is_loaded(const Evaluation& e, const FrictionState&) const override { return !signal || !is_zero_at(*signal, e.t); }
  void slip_wrench(const Evaluation& e, const FrictionState& state, const double* rate, double* wrench) const override {
    wrench[0] = sliding_force(rate[0], state, share(e.t));
  }
  [[nodiscard]] WrenchBounds bounds(const Evaluation& e, const FrictionState&, bool kinetic) const override {
    return WrenchBounds::symmetric(share(e.t) * (kinetic ? sliding_bound(sliding_rate(e)) : holds));
  }
  // While sliding, the capacity contains the viscous part in addition to the static bound.
  [[nodiscard]] double gauge(const Evaluation& e, const FrictionState& state, const double* wrench, double* normal) const override {
    const double sliding = state.phase == FrictionPhase::slip ? viscous * std::abs(evaluate_row<false>(row, e.motion).rate) : 0.0;
    const double capacity = share(e.t) * (holds + sliding);
    normal[0] = wrench[0] < 0.0 ? -1.0 / capacity : 1.0 / capacity;
    return normal[0] * wrench[0];
  }
  void stick_events(const Evaluation& e, const FrictionState&, const double* wrench, double* event_value) const override {
    bound_events<double>(holds * share(e.t), wrench[0], event_value);
  }
  [[nodiscard]] bool record_friction(TracedEvaluation& e, const FrictionState& state, const TapeNumber* rate, TapeNumber* wrench,
                                     TapeNumber* event_value) const override {
    const TapeNumber now = signal ? greatest_of(TapeNumber(0.0), e.record_signal_input({signal})) : TapeNumber(1.0);
    if (rate) {
      wrench[0] = sliding_force(rate[0], state, now);
      event_value[0] = state.sign * rate[0];
      event_value[1] = 1.0;
    } else {
      bound_events<TapeNumber>(holds * now, wrench[0], event_value);
    }
    event_value[2] = 1.0;
    return true;
  }

private:
  [[nodiscard]] double share(double t) const { return signal ? std::max(0.0, signal->value(t)) : 1.0; }
  [[nodiscard]] double sliding_rate(const Evaluation& e) const {
    if (viscous == 0.0 && per_stribeck_velocity == 0.0) return 0.0;
    return std::abs(evaluate_row<false>(row, e.motion).rate);
  }
  /// Returns the bound, N or N m, for a rate ≥ 0 in the direction of slip.
  template <class S> [[nodiscard]] S sliding_bound(const S& rate) const {
    S bound{drags};
    if (per_stribeck_velocity != 0.0) {
      const S relative = per_stribeck_velocity * rate;
      bound = bound + (holds - drags) / (1.0 + relative * relative);
    }
    if (viscous != 0.0) bound = bound + viscous * rate;
    return bound;
  }
  template <class S> [[nodiscard]] S sliding_force(const S& rate, const FrictionState& state, const S& share) const {
    const S bound = sliding_bound<S>(state.sign * rate);
    return -state.sign * (signal ? share * bound : bound);
  }
};

void add_channels(SystemBuilder& builder, const CoordinateFriction& friction, bool is_angle) {
  const int f = builder.next_friction(), slot = builder.next_friction_row();
  const auto* row = &friction.row;
  builder.add_channel("friction", is_angle ? "N m" : "N", {"friction on a along the coordinate", "positive: towards larger values"},
                      [slot](const Snapshot& s) { return s.friction_force[slot]; });
  add_share_channel(builder, friction);
  builder.add_channel("slip_rate", is_angle ? "rad/s" : "m/s", {"rate of the coordinate", "positive: it grows"},
                      [row](const Snapshot& s) { return evaluate_row<false>(*row, s.motion).rate; });
  builder.add_channel("mode", "", {"what the friction does", "", "0 free, 1 sticks, 2 slips"},
                      [f](const Snapshot& s) { return static_cast<double>(s.evaluation->friction[f].phase); });
}

void compile_joint_friction(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const JointFriction&>(element);
  const double drags = e.drags.value_or(e.holds);
  if (drags > e.holds) return builder.error("'drags' must not exceed 'holds'");
  if (e.stribeck_velocity && !(drags < e.holds))
    return builder.error("'stribeck_velocity' says how the friction falls from 'holds' to 'drags': give 'drags', below 'holds'");
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("holds a body against itself: name markers on two different bodies");
  auto friction = std::make_unique<CoordinateFriction>();
  RowSpec& row = friction->row;
  row.a = a.body;
  row.b = b.body;
  row.point_a = a.point;
  row.point_b = b.point;
  row.quantity = e.coordinate == "angle" ? "angle" : "slide";
  row.element = builder.element_index();
  row.base = builder.add_base();
  if (e.coordinate == "angle") row.kind = MeasureKind::angle;
  else if (e.coordinate == "distance") row.kind = MeasureKind::distance;
  else row.direction = builder.direction(b, e.coordinate == "x" ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0));
  if (e.coordinate == "distance" && (builder.marker_position(a) - builder.marker_position(b)).norm() < 1e-12)
    return builder.error("its ends coincide, so its direction is undefined: move a marker");
  friction->holds = e.holds;
  friction->drags = drags;
  friction->viscous = e.viscous;
  friction->per_stribeck_velocity = e.stribeck_velocity ? 1.0 / *e.stribeck_velocity : 0.0;
  friction->signal = builder.signal(e.signal);
  if (!is_pressure(e, friction->signal, builder)) return;
  add_channels(builder, *friction, e.coordinate == "angle");
  builder.add_friction(std::move(friction));
}

} // namespace

const ElementKind& joint_friction_kind() {
  static const ElementKind kind = [] {
    using T = JointFriction;
    ElementKind k;
    k.name = "joint_friction";
    k.doc = "Dry friction with a given bound on a coordinate of a against b, as of a preloaded bearing or guide, a brake or a "
            "clutch: sticks exactly while it takes no more than 'holds'. Friction that follows the joint's reaction is that of a bearing.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker or body that is held");
    f.add("b", &T::b).as(FieldType::marker).doc("marker whose axes count");
    f.add("coordinate", &T::coordinate)
        .one_of({"angle", "x", "y", "distance"})
        .doc("angle of a against b; x, y: of marker a in marker b's axes; distance of the markers");
    f.add("holds", &T::holds).in("N m|N").positive().required().doc("largest couple or force that it takes sticking");
    f.add("drags", &T::drags).in("N m|N").not_negative().doc("couple or force while it slides; default: as holds");
    f.add("stribeck_velocity", &T::stribeck_velocity)
        .in("rad/s|m/s")
        .positive()
        .doc("rate v_s over which it falls: drags + (holds - drags)/(1 + (rate/v_s)^2); default: at once");
    f.add("viscous", &T::viscous).in("N m s/rad|N s/m").not_negative().doc("added while it slides, times the rate");
    f.add("signal", &T::signal)
        .as(FieldType::signal)
        .doc("multiplies holds, drags and viscous, as a brake's pressure does; never below zero");
    k.example = R"([[element]]
name = 'brake'
kind = 'joint_friction'
a = 'a'
b = 'b'
coordinate = 'angle'
holds = 100.0
drags = 80.0
)";
    k.holds<T>();
    k.compile = compile_joint_friction;
    return k;
  }();
  return kind;
}

} // namespace steplap
