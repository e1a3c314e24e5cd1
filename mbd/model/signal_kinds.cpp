// Kinds of signal without files: pulses, harmonics, chirps, sums and products. A pulse is zero outside [start, start + duration]. A
// deceleration is a pulse with a negative peak.
#include "mbd/model/signal.h"

#include "mbd/model/load_signals.h"
#include "mbd/model/signal_composites.h"

#include <array>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_pi = std::numbers::pi;
using Piece = Signal::Piece;

// Fields common to all pulses.
struct Pulse : SignalDefinition {
  double peak = 0.0;
  double start = 0.0;    // s
  double duration = 0.0; // s
};

FieldTable pulse_fields() {
  FieldTable f;
  f.add("peak", &Pulse::peak).in("*").required().doc("largest value; negative for a deceleration");
  f.add("start", &Pulse::start).in("s").doc("time at which the pulse begins");
  f.add("duration", &Pulse::duration).in("s").positive().required().doc("length of the pulse");
  return f;
}

template <class T> const T& as(const SignalDefinition& definition) { return static_cast<const T&>(definition); }

Piece polynomial(double start, double c0, double c1 = 0.0) {
  Piece piece;
  piece.start = start;
  piece.c[0] = c0;
  piece.c[1] = c1;
  return piece;
}

// Returns the polygonal line through `corners`, zero before the first and after the last; two corners at the same time make a jump.
Signal polygon(const std::vector<Vec2>& corners) {
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const double length = corners[k + 1].x() - corners[k].x();
    if (length > 0.0) pieces.push_back(polynomial(corners[k].x(), corners[k].y(), (corners[k + 1].y() - corners[k].y()) / length));
  }
  pieces.push_back(polynomial(corners.back().x(), 0.0));
  return Signal(std::move(pieces));
}

struct Constant : SignalDefinition {
  double value = 0.0;
};

const SignalKind& constant_kind() {
  static const SignalKind kind = [] {
    SignalKind k{
        "constant", "The same value at all times.", {}, create_object<SignalDefinition, Constant>, copy_object<SignalDefinition, Constant>,
        nullptr};
    k.fields.add("value", &Constant::value).in("*").required().doc("the value");
    k.build = [](const SignalDefinition& d) { return Signal::constant(as<Constant>(d).value); };
    return k;
  }();
  return kind;
}

const SignalKind& haversine_kind() {
  static const SignalKind kind{"haversine",
                               "Raised cosine, peak (1 - cos(2 pi tau / duration)) / 2; its integral is "
                               "peak duration / 2.",
                               pulse_fields(),
                               create_object<SignalDefinition, Pulse>,
                               copy_object<SignalDefinition, Pulse>,
                               [](const SignalDefinition& d) {
                                 const Pulse& p = as<Pulse>(d);
                                 Piece piece = polynomial(p.start, 0.5 * p.peak);
                                 piece.harmonics.push_back({-0.5 * p.peak, 2.0 * k_pi / p.duration, 0.0});
                                 return Signal({piece, polynomial(p.start + p.duration, 0.0)});
                               }};
  return kind;
}

const SignalKind& half_sine_kind() {
  static const SignalKind kind{"half_sine",
                               "Half a sine wave, peak sin(pi tau / duration); its integral is 2/pi peak "
                               "duration.",
                               pulse_fields(),
                               create_object<SignalDefinition, Pulse>,
                               copy_object<SignalDefinition, Pulse>,
                               [](const SignalDefinition& d) {
                                 const Pulse& p = as<Pulse>(d);
                                 Piece piece = polynomial(p.start, 0.0);
                                 piece.harmonics.push_back({p.peak, k_pi / p.duration, -0.5 * k_pi});
                                 return Signal({piece, polynomial(p.start + p.duration, 0.0)});
                               }};
  return kind;
}

const SignalKind& rectangle_kind() {
  static const SignalKind kind{"rectangle",
                               "The value peak for the whole duration; its integral is peak duration.",
                               pulse_fields(),
                               create_object<SignalDefinition, Pulse>,
                               copy_object<SignalDefinition, Pulse>,
                               [](const SignalDefinition& d) {
                                 const Pulse& p = as<Pulse>(d);
                                 return Signal({polynomial(p.start, p.peak), polynomial(p.start + p.duration, 0.0)});
                               }};
  return kind;
}

struct Triangle : Pulse {
  std::optional<double> rise; // s
};

Signal build_triangle(const SignalDefinition& definition) {
  const Triangle& p = as<Triangle>(definition);
  const double rise = p.rise.value_or(0.5 * p.duration);
  if (rise > p.duration)
    throw ModelError(p.where, "triangle '" + p.name +
                                  "' rises longer than it lasts: 'rise' must "
                                  "not exceed 'duration'");
  return polygon({{p.start, 0.0}, {p.start + rise, p.peak}, {p.start + p.duration, 0.0}});
}

const SignalKind& triangle_kind() {
  static const SignalKind kind = [] {
    SignalKind k{"triangle",
                 "Linear up to the peak and down again; its integral is peak duration / 2.",
                 pulse_fields(),
                 create_object<SignalDefinition, Triangle>,
                 copy_object<SignalDefinition, Triangle>,
                 build_triangle};
    k.fields.add("rise", &Triangle::rise).in("s").not_negative().doc("time from start to peak; half the duration if not given");
    return k;
  }();
  return kind;
}

struct Trapezoid : SignalDefinition {
  double peak = 0.0;
  double start = 0.0;             // s
  double rise = 0.0, fall = 0.0;  // s
  std::optional<double> duration; // s
  std::optional<double> hold;     // s
};

// Returns the times of the four corners: begin of the rise, begin and end of the peak, end of the fall.
std::array<double, 4> corners_of(const Trapezoid& p) {
  const double rise_end = p.start + p.rise;
  if (p.hold) return {p.start, rise_end, rise_end + *p.hold, rise_end + *p.hold + p.fall};
  constexpr double k_same_duration = 1e-12; // relative: sums of times given as decimals differ by less
  const double excess = p.rise + p.fall - *p.duration, end = p.start + *p.duration;
  if (excess > k_same_duration * *p.duration)
    throw ModelError(p.where, "trapezoid '" + p.name +
                                  "' rises and falls longer than it lasts: "
                                  "'rise' + 'fall' must not exceed 'duration'");
  return {p.start, rise_end, excess > -k_same_duration * *p.duration ? rise_end : end - p.fall, end};
}

Signal build_trapezoid(const SignalDefinition& definition) {
  const Trapezoid& p = as<Trapezoid>(definition);
  const std::string subject = "trapezoid '" + p.name + "' ";
  if (p.hold.has_value() == p.duration.has_value())
    throw ModelError(p.where, subject + (p.hold ? "gives both 'hold' and 'duration': give one of them"
                                                : "needs 'hold', how long it stays at its peak, or 'duration', how long it lasts in all"));
  const auto [begin, rise_end, fall_start, end] = corners_of(p);
  if (!(end > begin)) throw ModelError(p.where, subject + "lasts no time: 'rise', 'hold' and 'fall' are all 0");
  return polygon({{begin, 0.0}, {rise_end, p.peak}, {fall_start, p.peak}, {end, 0.0}});
}

const SignalKind& trapezoid_kind() {
  static const SignalKind kind = [] {
    SignalKind k{"trapezoid",
                 "Linear rise, constant peak, linear fall; its integral is peak "
                 "(rise / 2 + hold + fall / 2).",
                 {},
                 create_object<SignalDefinition, Trapezoid>,
                 copy_object<SignalDefinition, Trapezoid>,
                 build_trapezoid};
    k.fields.add("peak", &Trapezoid::peak).in("*").required().doc("largest value; negative for a deceleration");
    k.fields.add("start", &Trapezoid::start).in("s").doc("time at which the pulse begins");
    k.fields.add("rise", &Trapezoid::rise).in("s").not_negative().required().doc("time from start to the peak value");
    k.fields.add("hold", &Trapezoid::hold).in("s").not_negative().doc("time at the peak value; give it or 'duration'");
    k.fields.add("fall", &Trapezoid::fall).in("s").not_negative().required().doc("time from the peak value to the end");
    k.fields.add("duration", &Trapezoid::duration).in("s").positive().doc("rise + hold + fall, instead of 'hold'");
    return k;
  }();
  return kind;
}

struct Sine : SignalDefinition {
  double amplitude = 0.0, frequency = 0.0, phase = 0.0; // -, Hz, rad
  double start = 0.0;                                   // s
  std::optional<double> duration;                       // s
};

Signal build_sine(const SignalDefinition& definition) {
  const Sine& p = as<Sine>(definition);
  Piece piece = polynomial(p.start, 0.0);
  piece.harmonics.push_back({p.amplitude, 2.0 * k_pi * p.frequency, p.phase - 0.5 * k_pi});
  std::vector<Piece> pieces{piece};
  if (p.duration) pieces.push_back(polynomial(p.start + *p.duration, 0.0));
  return Signal(std::move(pieces));
}

const SignalKind& sine_kind() {
  static const SignalKind kind = [] {
    SignalKind k{"sine",
                 "amplitude sin(2 pi frequency (t - start) + phase), zero before start: without a phase it begins at zero.",
                 {},
                 create_object<SignalDefinition, Sine>,
                 copy_object<SignalDefinition, Sine>,
                 build_sine};
    k.fields.add("amplitude", &Sine::amplitude).in("*").required().doc("largest value");
    k.fields.add("frequency", &Sine::frequency).in("Hz").positive().required().doc("cycles per second");
    k.fields.add("phase", &Sine::phase).in("rad").doc("of the sine at its start; \"90 deg\" makes a cosine");
    k.fields.add("start", &Sine::start).in("s").doc("time at which the signal begins");
    k.fields.add("duration", &Sine::duration).in("s").positive().doc("zero again after this time; endless if not given");
    return k;
  }();
  return kind;
}

struct Harmonics : SignalDefinition {
  double offset = 0.0;
  std::vector<double> amplitudes, frequencies, phases; // -, Hz, rad
  double start = 0.0;                                  // s
  std::optional<double> duration;                      // s
};

Signal build_harmonics(const SignalDefinition& definition) {
  const Harmonics& h = as<Harmonics>(definition);
  const auto fail = [&](const std::string& what) { throw ModelError(h.where, "harmonics '" + h.name + "': " + what); };
  const std::size_t count = h.amplitudes.size();
  if (h.frequencies.size() != count || (!h.phases.empty() && h.phases.size() != count))
    fail("'amplitudes', 'frequencies' and 'phases' must be of equal length");
  Piece piece = polynomial(h.start, h.offset);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(h.frequencies[i] > 0.0)) fail("frequencies must be greater than 0; use 'offset' for a constant");
    piece.harmonics.push_back({h.amplitudes[i], 2.0 * k_pi * h.frequencies[i], h.phases.empty() ? 0.0 : h.phases[i]});
  }
  std::vector<Piece> pieces{piece};
  if (h.duration) pieces.push_back(polynomial(h.start + *h.duration, 0.0));
  return Signal(std::move(pieces));
}

const SignalKind& harmonics_kind() {
  static const SignalKind kind = [] {
    SignalKind k{"harmonics",
                 "offset + sum of amplitude cos(2 pi frequency (t - start) + phase), zero before "
                 "start; for a single sine see the kind sine.",
                 {},
                 create_object<SignalDefinition, Harmonics>,
                 copy_object<SignalDefinition, Harmonics>,
                 build_harmonics};
    k.fields.add("offset", &Harmonics::offset).in("*").doc("constant added to the harmonics");
    k.fields.add("amplitudes", &Harmonics::amplitudes).in("*").required().doc("one per harmonic");
    k.fields.add("frequencies", &Harmonics::frequencies).in("Hz").required().doc("cycles per second, one per harmonic");
    k.fields.add("phases", &Harmonics::phases).in("rad").doc("one per harmonic; all 0 if not given");
    k.fields.add("start", &Harmonics::start).in("s").doc("time at which the signal begins");
    k.fields.add("duration", &Harmonics::duration).in("s").positive().doc("zero again after this time; endless if not given");
    return k;
  }();
  return kind;
}

} // namespace

const std::vector<const SignalKind*>& signal_kinds() {
  static const std::vector<const SignalKind*> kinds{&constant_kind(),  &haversine_kind(), &half_sine_kind(), &triangle_kind(),
                                                    &trapezoid_kind(), &rectangle_kind(), &sine_kind(),      &harmonics_kind(),
                                                    &chirp_kind(),     &sum_kind(),       &product_kind(),   &scaled_kind(),
                                                    &road_kind(),      &random_kind(),    &sea_kind()};
  return kinds;
}

} // namespace steplap
