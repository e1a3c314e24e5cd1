// Motion of a vessel: it rotates about an axis by θ = Θ sin ωτ, while the axis moves vertically with ḧ = H sin(ω_h τ + φ). At a point (X,
// Y) relative to the axis, in the axes of the vessel, acceleration minus gravity has the components
//
//   f_x = −X θ̇² − Y θ̈ + (g + ḧ) sin θ,   f_y = X θ̈ − Y θ̇² + (g + ḧ) cos θ.
//
// For a model whose ground is the deck, the vehicle is accelerated by f_x in x and by f_y − g in y, because the model has its own gravity.
//
// The trigonometric functions of θ are expanded exactly into harmonics (Jacobi–Anger): sin(Θ sin ωτ) = 2 Σ J_k(Θ) sin kωτ over odd k, cos(Θ
// sin ωτ) = J_0(Θ) + 2 Σ J_k(Θ) cos kωτ over even k ≥ 2. The accelerations rise from zero within `rise`.
#include "mbd/model/load_signals.h"
#include "mbd/model/signal_algebra.h"
#include "mbd/model/spectral_waves.h"

#include "mbd/base/portable_math.h"

#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_standard_gravity = 9.80665; // m/s²

struct Sea : SignalDefinition {
  std::string motion = "roll";
  std::string component;
  std::optional<double> angle;             // rad
  std::optional<double> period;            // s
  double heave = 0.2 * k_standard_gravity; // m/s²
  std::optional<double> heave_period;      // s
  double heave_phase = 0.0;                // rad
  Vec2 place = Vec2::Zero();               // m
  double gravity = 9.81;                   // m/s², should equal that of the model
  double start = 0.0;                      // s
  std::optional<double> rise;              // s
};

// Returns the Bessel function J_n(x) by its power series. For x up to 1.6 the terms decrease from the first one on.
double bessel(int n, double x) {
  double term = 1.0;
  for (int k = 1; k <= n; ++k) term *= 0.5 * x / k;
  double sum = term;
  for (int k = 1; k < 40; ++k) sum += term *= -0.25 * x * x / (k * (n + k));
  return sum;
}

Signal sines(std::vector<Signal::Harmonic> waves, double offset = 0.0) {
  Signal::Piece piece;
  piece.c[0] = offset;
  piece.harmonics = std::move(waves);
  return Signal({piece});
}
Signal::Harmonic sine(double amplitude, double frequency, double phase = 0.0) { return {amplitude, frequency, phase - 0.5 * k_pi}; }

// Returns sin θ(t) for `first` = 1, cos θ(t) for `first` = 0, for θ = angle · sin(omega τ).
Signal of_angle(double angle, double omega, int first) {
  constexpr double k_none = 1e-20;
  std::vector<Signal::Harmonic> waves;
  for (int k = first == 0 ? 2 : 1; 2.0 * bessel(k, angle) > k_none; k += 2) {
    const double amplitude = 2.0 * bessel(k, angle);
    waves.push_back(first == 0 ? Signal::Harmonic{amplitude, k * omega, 0.0} : sine(amplitude, k * omega));
  }
  return sines(std::move(waves), first == 0 ? bessel(0, angle) : 0.0);
}

// Returns the requested component of the motion without its gradual start. `angle`: amplitude Θ, rad.
Signal sea_at_full_amplitude(const Sea& sea, double angle, double omega, double heave_omega) {
  if (sea.component == "angle") return sines({sine(angle, omega)});
  if (sea.component == "height") return sines({sine(-sea.heave / (heave_omega * heave_omega), heave_omega, sea.heave_phase)});
  const bool is_x = sea.component == "x";
  const double faster = angle * omega * omega, lever = is_x ? sea.place.y() : -sea.place.x(), arm = is_x ? sea.place.x() : sea.place.y();
  const double swing = 0.5 * arm * angle * faster; // mean of θ̇² multiplied by the other coordinate
  const Signal turning = sines({sine(lever * faster, omega), {-swing, 2.0 * omega, 0.0}}, -swing);
  const Signal weight = sines({sine(sea.heave, heave_omega, sea.heave_phase)}, sea.gravity), tilt = of_angle(angle, omega, is_x ? 1 : 0);
  const Signal felt = product_of({&weight, &tilt}), one = Signal::constant(1.0);
  return sum_of({&turning, &felt, &one}, {1.0, 1.0, is_x ? 0.0 : -sea.gravity});
}

Signal build_sea(const SignalDefinition& definition) {
  const auto& sea = static_cast<const Sea&>(definition);
  const bool is_roll = sea.motion == "roll";
  const double angle = sea.angle.value_or((is_roll ? 20.0 : 12.5) * k_pi / 180.0), period = sea.period.value_or(10.0);
  const double omega = 2.0 * k_pi / period, heave_omega = 2.0 * k_pi / sea.heave_period.value_or(period);
  Signal::Piece growing, whole;
  const double rise = sea.rise.value_or(period);
  growing.c[0] = 0.5;
  growing.harmonics.push_back({-0.5, k_pi / rise, 0.0});
  whole.start = rise;
  whole.c[0] = 1.0;
  const Signal envelope({growing, whole}), wave = sea_at_full_amplitude(sea, angle, omega, heave_omega);
  return delayed(product_of({&envelope, &wave}), sea.start);
}

} // namespace

const SignalKind& sea_kind() {
  static const SignalKind kind = [] {
    SignalKind k;
    k.name = "sea";
    k.doc = "Roll or pitch of a vessel, angle sin(2 pi t / period) about an axis, with heave of the axis; or the acceleration "
            "that a place on the deck "
            "feels of them, with gravity's part along the tilted deck.";
    k.holds<Sea>();
    k.build = build_sea;
    FieldTable& f = k.fields;
    f.add("component", &Sea::component)
        .one_of({"angle", "height", "x", "y"})
        .required()
        .doc("angle of the vessel (rad), height of its axis (m), or acceleration along x or y of the deck (m/s^2); y without "
             "gravity at rest");
    f.add("motion", &Sea::motion).one_of({"roll", "pitch"}).doc("chooses the default of angle");
    f.add("angle", &Sea::angle).in("rad").positive().at_most(1.05).doc("amplitude; 20 deg of roll, 12.5 deg of pitch if not given");
    f.add("period", &Sea::period).in("s").positive().doc("of roll or pitch; 10 s if not given");
    f.add("heave", &Sea::heave).in("m/s^2").not_negative().doc("amplitude of the axis's vertical acceleration");
    f.add("heave_period", &Sea::heave_period).in("s").positive().doc("that of roll or pitch if not given");
    f.add("heave_phase", &Sea::heave_phase).in("rad").doc("0: largest upwards acceleration at the largest angle");
    f.add("place", &Sea::place).in("m").doc("place for x and y, from the axis, along the vessel's x and y");
    f.add("gravity", &Sea::gravity).in("m/s^2").positive().doc("gravitational acceleration, as in the model");
    f.add("start", &Sea::start).in("s").doc("time at which the waves begin");
    f.add("rise", &Sea::rise).in("s").positive().doc("within which they grow from zero; one period if not given");
    return k;
  }();
  return kind;
}

} // namespace steplap
