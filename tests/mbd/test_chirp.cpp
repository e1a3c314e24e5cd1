// Chirps: their sine against its formula in more digits, integrals against Fresnel's and the sine integral (SciPy 1.10) and against
// quadrature, what they are in sums, products and delays, and what is refused.
#include "mbd/model/signal.h"
#include "mbd/model/signal_algebra.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;

namespace {

struct Sweep {
  double amplitude = 2.0, from = 1.0, to = 100.0;
  bool is_exponential = false;
  double start = 0.7, duration = 10.0, phase = 0.3;
};

Signal made(const Sweep& s) {
  for (const SignalKind* kind : signal_kinds()) {
    if (kind->name != "chirp") continue;
    const auto definition = kind->create();
    definition->name = "s";
    const auto set = [&](const char* field, const FieldValue& value) { kind->fields.find(field)->set(definition.get(), value); };
    set("amplitude", s.amplitude);
    set("from", s.from);
    set("to", s.to);
    set("course", std::string(s.is_exponential ? "exponential" : "linear"));
    set("start", s.start);
    set("duration", s.duration);
    set("phase", s.phase);
    return kind->build(*definition);
  }
  FAIL("no such kind");
  return {};
}

// The frequency in rad/s, and the phase as its integral, with 64 bits of digits.
long double frequency(const Sweep& s, long double tau) {
  constexpr long double k_turn = 2.0L * std::numbers::pi_v<long double>;
  if (s.is_exponential) return k_turn * s.from * std::pow(static_cast<long double>(s.to) / s.from, tau / s.duration);
  return k_turn * (s.from + (static_cast<long double>(s.to) - s.from) * tau / s.duration);
}
long double phase(const Sweep& s, long double tau) {
  constexpr long double k_turn = 2.0L * std::numbers::pi_v<long double>;
  if (!s.is_exponential) return s.phase + k_turn * tau * (s.from + 0.5L * (static_cast<long double>(s.to) - s.from) * tau / s.duration);
  const long double growth = std::log(static_cast<long double>(s.to) / s.from) / s.duration;
  return s.phase + k_turn * s.from * std::expm1(growth * tau) / growth;
}

// Of the frequency, rad/s².
long double change(const Sweep& s, long double tau) {
  if (s.is_exponential) return frequency(s, tau) * std::log(static_cast<long double>(s.to) / s.from) / s.duration;
  return (frequency(s, s.duration) - frequency(s, 0.0L)) / s.duration;
}

const Sweep k_sweeps[] = {{},
                          {.is_exponential = true},
                          {.from = 0.0},
                          {.from = 60.0, .to = 0.0, .start = -3.0},
                          {.from = 80.0, .to = 0.01, .is_exponential = true},
                          {.from = 1e-3, .to = 2e3, .is_exponential = true, .duration = 0.5},
                          {.from = 7.0, .to = 7.0},
                          {.from = 3e6, .to = 4e6, .start = 0.0, .duration = 2e-5}};

} // namespace

TEST_CASE("a chirp is a sine whose phase is the integral of its frequency, with exact derivatives") {
  for (const Sweep& s : k_sweeps) {
    CAPTURE(s.from);
    CAPTURE(s.to);
    CAPTURE(s.is_exponential);
    const Signal signal = made(s);
    const double end = s.start + s.duration;
    CHECK(signal.value(s.start - 1e-9 * s.duration) == 0.0);
    CHECK(signal.value(end) == 0.0);
    for (int i = 0; i < 4000; ++i) {
      const double t = s.start + s.duration * (i + 0.37) / 4000.0;
      const long double tau = static_cast<long double>(t) - s.start, w = frequency(s, tau), p = phase(s, tau);
      // Phases add up over the pieces, of which each rounds a share of its own turn; times are rounded, too.
      const double rounding = 1e-15 * (10.0 + 2.0 * static_cast<double>(p) + static_cast<double>(w) * (std::abs(t) + std::abs(s.start)));
      const SignalJet jet = signal.drive(t, DriveLevel::position);
      REQUIRE(std::abs(static_cast<double>(signal.value(t) - s.amplitude * std::sin(p))) < s.amplitude * rounding);
      // What a series has left out is of a power of 17 in its length, of some sixteenth of a turn at least: derivatives lose by that.
      const double fastest = static_cast<double>(std::max(w, std::sqrt(frequency(s, s.duration) / s.duration)));
      CHECK(std::abs(static_cast<double>(jet.rate - s.amplitude * w * std::cos(p))) < s.amplitude * fastest * 50.0 * rounding);
      const double bend = static_cast<double>(s.amplitude * (change(s, tau) * std::cos(p) - w * w * std::sin(p)));
      CHECK(std::abs(jet.acceleration - bend) < s.amplitude * fastest * fastest * 2e3 * rounding);
    }
  }
}

TEST_CASE("no piece of a chirp jumps against the next, nor its rate, and its waves are as fast as its frequency") {
  for (const Sweep& s : k_sweeps) {
    CAPTURE(s.from);
    CAPTURE(s.to);
    for (const double delay : {0.0, 0.1, 1234.56789}) {
      const Signal signal = delayed(made(s), delay);
      for (std::size_t k = 1; k + 1 < signal.breakpoints().size(); ++k) {
        CHECK_FALSE(signal.jumps_at(k));
        CHECK_FALSE(signal.rate_jumps_at(k));
      }
    }
    const Signal signal = made(s);
    for (const double share : {0.1, 0.5, 0.97}) {
      const double t = s.start + share * s.duration, w = static_cast<double>(frequency(s, share * s.duration));
      // That of a piece's start, over which ½ ω' τ² reaches 0.07.
      CHECK(std::abs(signal.fastest_at(t) - w) <=
            1e-9 * w + std::sqrt(0.15 * static_cast<double>(std::abs(change(s, share * s.duration)))));
    }
  }
}

TEST_CASE("a chirp's integral is Fresnel's, or of sine and cosine integrals") {
  // S(√(2r) t) / √(2r) with r = 20 Hz/s, and [cos c (Si(c e^kt) − Si(c)) − sin c (Ci(c e^kt) − Ci(c))] / k, c = ω₀/k, by SciPy.
  const Signal linear = made({.amplitude = 1.0, .from = 0.0, .to = 40.0, .start = 0.0, .duration = 2.0, .phase = 0.0});
  const Signal octaves =
      made({.amplitude = 1.0, .from = 0.5, .to = 50.0, .is_exponential = true, .start = 0.0, .duration = 3.0, .phase = 0.0});
  // SciPy's digits are good to 1e-15, sums of some hundred pieces to 1e-14.
  CHECK(std::abs(linear.drive(0.3, DriveLevel::velocity).value - 0.059273479750743825) < 2e-14);
  CHECK(std::abs(linear.drive(1.1, DriveLevel::velocity).value - 0.07317706823009072) < 2e-14);
  CHECK(std::abs(linear.drive(2.0, DriveLevel::velocity).value - 0.0750781151638289) < 2e-14);
  CHECK(std::abs(octaves.drive(0.4, DriveLevel::velocity).value - 0.24621526506850416) < 2e-14);
  CHECK(std::abs(octaves.drive(1.7, DriveLevel::velocity).value - 0.2364019789651093) < 2e-14);
  CHECK(std::abs(octaves.drive(3.0, DriveLevel::velocity).value - 0.2555362188036509) < 2e-14);
  // ∬ by parts: τ ∫ sin(πrτ²) − ∫ τ sin(πrτ²) = τ S − (1 − cos πrτ²)/(2πr).
  for (const double t : {0.3, 1.1, 2.0}) {
    const double area = linear.drive(t, DriveLevel::velocity).value, w = 20.0 * std::numbers::pi;
    CHECK(std::abs(linear.drive(t, DriveLevel::acceleration).value - (t * area - (1.0 - std::cos(w * t * t)) / (2.0 * w))) < 1e-13);
  }
}

TEST_CASE("means of a chirp are its integrals over their times, and it takes part in sums and products") {
  for (const bool is_exponential : {false, true}) {
    const Sweep s{.from = 2.0, .to = 30.0, .is_exponential = is_exponential, .start = 0.2, .duration = 2.0};
    const Signal chirp = made(s);
    for (const double from : {-0.1, 0.3, 1.234})
      for (const double length : {1e-3, 0.1, 2.5}) {
        const double whole = chirp.drive(from + length, DriveLevel::velocity).value - chirp.drive(from, DriveLevel::velocity).value;
        CHECK(std::abs(chirp.mean(from, from + length) * length - whole) < 1e-8 * length + 1e-14); // as mean() promises
      }
    // A cubic envelope u²(3 − 2u), and the same sweep once more with the other sign.
    const Signal envelope({{0.2, {0.0, 0.0, 0.75, -0.25}, {}, {}}, {2.2, {0, 0, 0, 0}, {}, {}}});
    const Signal window = product_of({&chirp, &envelope}), nothing = sum_of({&chirp, &chirp}, {1.0, -1.0});
    for (double t = 0.0; t < 2.5; t += 0.0137) {
      CHECK(std::abs(window.value(t) - chirp.value(t) * envelope.value(t)) < 1e-13);
      CHECK(std::abs(nothing.value(t)) < 1e-14);
    }
    CHECK_THROWS_AS(static_cast<void>(product_of({&chirp, &chirp})), std::invalid_argument); // powers that signals do not have
  }
}

TEST_CASE("what makes no chirp is refused with what would make one") {
  const auto complaint = [](const Sweep& s) {
    try {
      (void)made(s);
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto says = [&](const Sweep& s, const std::string& part) {
    const std::string found = complaint(s);
    CHECK_MESSAGE(found.find(part) != std::string::npos, found);
  };
  says({.from = 0.0, .is_exponential = true}, "give 'from' and 'to' above 0, or course = 'linear'");
  says({.to = 0.0, .is_exponential = true}, "give 'from' and 'to' above 0, or course = 'linear'");
  says({.from = 0.0, .to = 0.0}, "give 'to' above 0");
  says({.from = 1.0, .to = 1e9}, "let it be shorter or narrower");
  says({.from = 1.0, .to = 9.9e5}, "let it be shorter, or 'from' and 'to' be nearer to each other");
}
