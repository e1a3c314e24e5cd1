// A sine whose frequency changes from f₀ to f₁ over the time T: A sin(Φ(τ) + φ), Φ = 2π ∫ f dτ, with
//
//   linear:       f = f₀ + (f₁ − f₀) τ/T
//   exponential:  f = f₀ (f₁/f₀)^(τ/T)
//
// The integrals of the linear form are Fresnel integrals; those of the exponential form have no closed form. The signal is therefore
// divided into pieces with Φ = Φ_k + ω_k τ + δ(τ) and small δ. There e^{iδ} is expanded into a power series in τ. Each piece is then a sum
// of terms τⁿ cos(ω_k τ + …), whose integrals, products and delays signals can represent exactly (signal.h). The length of a piece is
// chosen so that the truncation error is below the rounding error of the sine.
#include "mbd/model/load_signals.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr int k_power = 16; // highest power of τ in a piece; products with cubics stay below k_most_power (signal_algebra.h)
constexpr int k_highest_power = 2 * k_power; // considered for the truncation error; higher ones are negligible, since successive terms
                                             // fall by a factor of about ten
constexpr double k_left_out = 0.5 * std::numeric_limits<double>::epsilon();
constexpr double k_nothing = 1e-40; // relative to the amplitude: negligible terms, whose coefficients could overflow
constexpr std::size_t k_most_pieces = 20'000;

using Powers = std::array<double, k_highest_power + 1>;

struct Chirp : SignalDefinition {
  double amplitude = 0.0;
  double from = 0.0, to = 0.0; // Hz
  std::string course = "linear";
  double start = 0.0, duration = 0.0; // s
  double phase = 0.0;                 // rad
};

[[nodiscard]] bool is_exponential(const Chirp& chirp) { return chirp.course == "exponential"; }

// Returns the angular frequency at time τ after the start, rad/s.
double frequency_at(const Chirp& chirp, double tau) {
  const double share = tau / chirp.duration;
  if (is_exponential(chirp)) return 2.0 * k_pi * chirp.from * portable::pow(chirp.to / chirp.from, share);
  return 2.0 * k_pi * (chirp.from + (chirp.to - chirp.from) * share);
}

// Returns the power series of δ about a point with angular frequency ω, as coefficients of (τ/length)ⁿ.
Powers deviation(const Chirp& chirp, double omega, double length) {
  Powers d{};
  if (!is_exponential(chirp)) {
    d[2] = k_pi * (chirp.to - chirp.from) / chirp.duration * length * length;
    return d;
  }
  const double growth = portable::log10(chirp.to / chirp.from) * std::numbers::ln10 / chirp.duration * length;
  double term = omega * length;
  for (int n = 2; n <= k_highest_power; ++n) {
    term *= growth / n;
    d[n] = term;
  }
  return d;
}

// Returns a bound of the truncated terms of e^{iδ} for |τ| ≤ length, from the series of e^δ with absolute coefficients of δ.
double left_out(const Powers& d) {
  Powers bound{};
  bound[0] = 1.0;
  double sum = 0.0;
  for (int n = 1; n <= k_highest_power; ++n) {
    for (int j = 2; j <= n; ++j) bound[n] += j * std::abs(d[j]) * bound[n - j];
    bound[n] /= n;
    if (n > k_power) sum += bound[n];
  }
  return sum;
}

// Returns the length of the next piece, at most `remaining`. Lengths are tried in decreasing order, beginning slightly above `last`, the
// length of the previous piece.
double length_of(const Chirp& chirp, double omega, double remaining, double last) {
  constexpr double k_longer = 1.3, k_shorter = 0.95;
  double length = std::min(remaining, k_longer * last);
  while (left_out(deviation(chirp, omega, length)) > k_left_out) length *= k_shorter;
  return length;
}

// Coefficients of e^{iδ} = Σ c_n (τ/length)ⁿ from the recurrence n c_n = i Σ j d_j c_{n−j}; real and imaginary parts.
struct Turned {
  std::array<double, k_power + 1> real{}, imaginary{};
};

Turned turned_by(const Powers& d) {
  Turned c;
  c.real[0] = 1.0;
  for (int n = 1; n <= k_power; ++n) {
    for (int j = 2; j <= n; ++j) {
      c.real[n] -= j * d[j] * c.imaginary[n - j];
      c.imaginary[n] += j * d[j] * c.real[n - j];
    }
    c.real[n] /= n;
    c.imaginary[n] /= n;
  }
  return c;
}

Signal::Piece piece_of(double amplitude, double start, double omega, double phase, const Powers& d, double length) {
  Signal::Piece piece;
  piece.start = start;
  const double cosine_phase = phase - 0.5 * k_pi; // converts the sine to a cosine
  if (omega > 0.0) piece.harmonics.push_back({amplitude, omega, cosine_phase});
  else piece.c[0] = amplitude * portable::cos(cosine_phase);
  const Turned c = turned_by(d);
  double scale = amplitude;
  for (int n = 1; n <= k_power; ++n) {
    scale /= length;
    const double size = portable::hypot(c.real[n], c.imaginary[n]);
    if (size > k_nothing) piece.modulated.push_back({n, scale * size, omega, cosine_phase + portable::atan2(c.imaginary[n], c.real[n])});
  }
  return piece;
}

void check(const Chirp& chirp) {
  const auto fail = [&](const std::string& what) { throw ModelError(chirp.where, "chirp '" + chirp.name + "': " + what); };
  if (is_exponential(chirp) && (!(chirp.from > 0.0) || !(chirp.to > 0.0)))
    fail("a frequency that grows exponentially is never 0: give 'from' and 'to' above 0, or course = 'linear'");
  if (chirp.from == 0.0 && chirp.to == 0.0) fail("both frequencies are 0, which is no sine: give 'to' above 0");
  const double cycles = std::abs(chirp.to - chirp.from) * chirp.duration; // a linear chirp needs about √45 pieces per cycle of this number
  if (!(cycles < 1e7))
    fail("it sweeps over more frequencies than can be followed: (to - from) duration is " + number_text(cycles) +
         ", and must be less than 1e7; let it be shorter or narrower");
}

// Builds the signal from pieces. Their starts are rounded times; the phase is accumulated over the resulting lengths, so that the value
// does not jump. Whole turns are subtracted.
Signal build_chirp(const SignalDefinition& definition) {
  const auto& chirp = static_cast<const Chirp&>(definition);
  check(chirp);
  std::vector<Signal::Piece> pieces;
  const double end = chirp.start + chirp.duration;
  double phase = chirp.phase, last = chirp.duration;
  for (double t = chirp.start; t < end;) {
    if (pieces.size() >= k_most_pieces)
      throw ModelError(chirp.where, "chirp '" + chirp.name + "' takes more than " + std::to_string(k_most_pieces) +
                                        " pieces: let it be shorter, or 'from' and 'to' be nearer to each other");
    const double omega = frequency_at(chirp, t - chirp.start), remaining = end - t;
    last = length_of(chirp, omega, remaining, last);
    const double parts = std::ceil(remaining / last);
    const double next = parts > 1.0 ? t + remaining / parts : end;
    const double length = next - t;
    const Powers d = deviation(chirp, omega, length);
    pieces.push_back(piece_of(chirp.amplitude, t, omega, phase, d, length));
    double turned = omega * length;
    for (int n = 2; n <= k_highest_power; ++n) turned += d[n];
    phase = std::fmod(phase + turned, 2.0 * k_pi);
    if (!(next > t)) break; // far from t = 0 times cannot resolve a shorter piece
    t = next;
  }
  Signal::Piece silence;
  silence.start = end;
  pieces.push_back(silence);
  return Signal(std::move(pieces));
}

} // namespace

const SignalKind& chirp_kind() {
  static const SignalKind kind = [] {
    SignalKind k;
    k.name = "chirp";
    k.doc = "A sine whose frequency f runs from one value to another: amplitude sin(2 pi integral of f + phase) within the duration, else "
            "zero. Linear: f = from + (to - from) tau / duration; exponential: f = from (to / from)^(tau / duration), as many octaves in "
            "each second as in another.";
    k.holds<Chirp>();
    k.build = build_chirp;
    FieldTable& f = k.fields;
    f.add("amplitude", &Chirp::amplitude).in("*").required().doc("of the sine");
    f.add("from", &Chirp::from).in("Hz").not_negative().required().doc("frequency at the start");
    f.add("to", &Chirp::to).in("Hz").not_negative().required().doc("frequency at the end; below the first one it falls");
    f.add("course", &Chirp::course).one_of({"linear", "exponential"}).doc("how the frequency runs");
    f.add("start", &Chirp::start).in("s").doc("time at which the sine begins");
    f.add("duration", &Chirp::duration).in("s").positive().required().doc("length of the sweep");
    f.add("phase", &Chirp::phase).in("rad").doc("of the sine at its start; 0 begins at zero");
    return k;
  }();
  return kind;
}

} // namespace steplap
