// Sums, products, scaled and delayed signals: against what they are made of, value by value, against quadrature for
// their integrals, and against closed forms where a product has some.
#include "mbd/model/signal_algebra.h"
#include "mbd/model/signal_network.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

using namespace steplap;

namespace {

constexpr double k_pi = std::numbers::pi;
using Piece = Signal::Piece;

Signal haversine(double peak, double start, double duration) {
  Piece pulse{start, {0.5 * peak, 0, 0, 0}, {{-0.5 * peak, 2.0 * k_pi / duration, 0.0}}, {}};
  return Signal({pulse, Piece{start + duration, {0, 0, 0, 0}, {}, {}}});
}
Signal sine(double frequency, double phase) { return Signal({Piece{0.0, {0, 0, 0, 0}, {{1.0, frequency, phase - 0.5 * k_pi}}, {}}}); }
// Rises from 0 at `start` to 1 at `end`, then stays.
Signal ramp(double start, double end) {
  return Signal({Piece{start, {0.0, 1.0 / (end - start), 0, 0}, {}, {}}, Piece{end, {1.0, 0, 0, 0}, {}, {}}});
}
Signal rectangle(double peak, double start, double end) {
  return Signal({Piece{start, {peak, 0, 0, 0}, {}, {}}, Piece{end, {0, 0, 0, 0}, {}, {}}});
}

// Four-point Gauss-Legendre on 60 parts of every interval between breakpoints.
double quadrature(const std::function<double(double)>& f, double to, const std::vector<double>& breakpoints) {
  constexpr double x[] = {0.3399810435848563, 0.8611363115940526}, w[] = {0.6521451548625461, 0.3478548451374538};
  std::vector<double> knots{0.0};
  for (const double b : breakpoints)
    if (b > 0.0 && b < to) knots.push_back(b);
  knots.push_back(to);
  double sum = 0.0;
  constexpr int n = 60;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const double h = (knots[k + 1] - knots[k]) / n;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 2; ++j) {
        const double middle = knots[k] + (i + 0.5) * h;
        sum += 0.5 * h * w[j] * (f(middle - 0.5 * h * x[j]) + f(middle + 0.5 * h * x[j]));
      }
  }
  return sum;
}

// Everything that a signal gives, against a function of time with the same breakpoints.
void check_against(const Signal& signal, const std::function<double(double)>& f) {
  for (const double t : {0.0, 0.013, 0.06, 0.11, 0.173, 0.26, 0.4}) {
    CAPTURE(t);
    // Terms of size 10 at most, summed in another order.
    CHECK(std::abs(signal.value(t) - f(t)) < 1e-13);
    constexpr double h = 1e-5;
    const SignalJet x = signal.drive(t, DriveLevel::position), a = signal.drive(t, DriveLevel::acceleration);
    CHECK(std::abs(x.value - (f(t) - f(0.0))) < 2e-13);
    // Differences: |f'''| h²/6 with frequencies to 100 rad/s, and rounding over h and h².
    if (t > 0.0) {
      CHECK(std::abs(x.rate - (f(t + h) - f(t - h)) / (2.0 * h)) < 1e-3);
      CHECK(std::abs(x.acceleration - (f(t + h) - 2.0 * f(t) + f(t - h)) / (h * h)) < 0.05);
    }
    const auto moment = [&](double u) { return (t - u) * f(u); };
    // The quadrature is exact to 1e-14 of the largest value over 60 parts of a few radians.
    CHECK(std::abs(a.rate - quadrature(f, t, signal.breakpoints())) < 1e-13);
    CHECK(std::abs(a.value - quadrature(moment, t, signal.breakpoints())) < 1e-13);
    const SignalJet v = signal.drive(t, DriveLevel::velocity);
    CHECK(v.value == a.rate);
    CHECK(std::abs(v.rate - signal.value(t)) < 1e-14);
    CHECK(v.acceleration == x.rate);
  }
}

} // namespace

TEST_CASE("a sum is the sum, in value, derivatives and integrals") {
  const Signal a = haversine(3.0, 0.05, 0.1), b = sine(40.0, 0.3), c = ramp(0.02, 0.2), d = Signal::constant(0.7);
  const Signal sum = sum_of({&a, &b, &c, &d}, {1.0, -2.0, 0.5, 3.0});
  check_against(sum, [&](double t) { return a.value(t) - 2.0 * b.value(t) + 0.5 * c.value(t) + 2.1; });
  CHECK(sum.breakpoints() == std::vector<double>{0.0, 0.02, 0.05, 0.05 + 0.1, 0.2});
  CHECK(sum.fastest_at(0.1) == 2.0 * k_pi / 0.1); // faster than the sine there
  CHECK(sum.fastest_at(0.3) == 40.0);
}

TEST_CASE("a product is the product, in value, derivatives and integrals") {
  const Signal a = haversine(3.0, 0.05, 0.3), b = sine(40.0, 0.3), c = ramp(0.02, 0.2), d = ramp(-0.1, 0.5);
  const Signal twice = product_of({&a, &b});
  check_against(twice, [&](double t) { return a.value(t) * b.value(t); });
  CHECK(twice.fastest_at(0.1) == doctest::Approx(40.0 + 2.0 * k_pi / 0.3).epsilon(1e-15));
  const Signal all = product_of({&a, &b, &c, &d});
  check_against(all, [&](double t) { return a.value(t) * b.value(t) * c.value(t) * d.value(t); });
  const Signal powers = product_of({&c, &c, &d, &c, &d}); // a polynomial of the fifth degree
  check_against(powers, [&](double t) { return std::pow(c.value(t), 3) * d.value(t) * d.value(t); });
  CHECK(powers.fastest_at(0.1) > 0.0); // its humps are known, too
  CHECK(product_of({&c, &c}).fastest_at(0.1) == 0.0);
}

// sin² = ½ − ½ cos 2ωt: ∫ = t/2 − sin(2ωt)/4ω, ∬ = t²/4 − (1 − cos 2ωt)/8ω².
TEST_CASE("the square of a sine has a mean and twice the frequency") {
  const double w = 31.0;
  const Signal wave = sine(w, 0.0), square = product_of({&wave, &wave});
  CHECK(square.fastest_at(1.0) == 2.0 * w);
  for (const double t : {1e-3, 0.1, 2.0, 50.0}) {
    const SignalJet jet = square.drive(t, DriveLevel::acceleration);
    // Rounding of phases up to 3000 rad over ω.
    CHECK(jet.acceleration == doctest::Approx(std::pow(std::sin(w * t), 2)).epsilon(1e-11));
    CHECK(std::abs(jet.rate - (0.5 * t - std::sin(2 * w * t) / (4 * w))) < 1e-13 * (1.0 + t));
    CHECK(std::abs(jet.value - (0.25 * t * t - (1 - std::cos(2 * w * t)) / (8 * w * w))) < 1e-13 * (1.0 + t * t));
  }
}

// ∫ t sin ωt = sin(ωt)/ω² − t cos(ωt)/ω; just after the start t² ω t³ / 3 … without loss of digits.
TEST_CASE("a wave that grows with time, from the first instant to many turns") {
  const double w = 20.0;
  const Signal wave = sine(w, 0.0);
  const Signal line({Piece{0.0, {0.0, 1.0, 0, 0}, {}, {}}});
  const Signal product = product_of({&line, &wave});
  for (const double t : {1e-6, 1e-3, 0.05, 0.0999, 0.1001, 1.0, 40.0}) {
    CAPTURE(t);
    const double rate = product.drive(t, DriveLevel::velocity).value;
    const double x = w * t;
    const double exact = x < 0.1 ? w * t * t * t * (1.0 / 3 - x * x / 30 + x * x * x * x / 840 - std::pow(x, 6) / 45360)
                                 : std::sin(x) / (w * w) - t * std::cos(x) / w;
    // The phase of −π/2 is rounded: a cosine of 1e-16, which brings t²/2 as much.
    CHECK(std::abs(rate - exact) < (x < 0.1 ? 1e-14 * exact + 1e-16 * t * t : 1e-13 * (1.0 + t)));
  }
}

TEST_CASE("jumps and kinks of a part are jumps and kinks of the whole, and no others") {
  const Signal wave = sine(30.0, 0.5), block = rectangle(2.0, 0.1, 0.2), slope = ramp(0.15, 0.3);
  const Signal sum = sum_of({&wave, &block, &slope}, {1.0, 1.0, 1.0});
  // The sine begins with a jump as well: it was zero before t = 0.
  CHECK(sum.breakpoints() == std::vector<double>{0.0, 0.1, 0.15, 0.2, 0.3});
  for (const std::size_t k : {0, 1, 3}) CHECK(sum.jumps_at(k));
  for (const std::size_t k : {2, 4}) {
    CHECK_FALSE(sum.jumps_at(k));
    CHECK(sum.rate_jumps_at(k));
  }
  const auto jump = sum.first_jump(DriveLevel::velocity, 0.0, 1.0);
  REQUIRE(jump);
  CHECK(jump->t == 0.1);
  CHECK(jump->after - jump->before == doctest::Approx(2.0).epsilon(1e-14));
  // Where the other factor is zero a jump is none: sin(30 t + 0.5) at (π − 0.5)/30.
  const double zero = (k_pi - 0.5) / 30.0;
  const Signal from_zero = rectangle(2.0, zero, 0.2), product = product_of({&wave, &from_zero});
  REQUIRE(product.breakpoints().size() == 3);
  CHECK_FALSE(product.jumps_at(1));
  CHECK(product.rate_jumps_at(1));
  CHECK(product.jumps_at(2));
  CHECK(product.first_jump(DriveLevel::position, 0.0, 1.0)->t == zero);
  CHECK(product.first_jump(DriveLevel::velocity, 0.0, 1.0)->t == 0.2);
}

TEST_CASE("breakpoints that differ by rounding are one") {
  const double end = 0.1 + 0.2; // 0.30000000000000004
  const Signal first = rectangle(1.0, 0.1, end), second = rectangle(-1.0, 0.3, 0.4);
  const Signal sum = sum_of({&first, &second}, {1.0, 1.0});
  CHECK(sum.breakpoints() == std::vector<double>{0.1, 0.3, 0.4});
  const Signal kink_one = ramp(0.1, end), kink_two = ramp(0.3, 0.5);
  const Signal kinks = sum_of({&kink_one, &kink_two}, {1.0, 1.0});
  REQUIRE(kinks.breakpoints().size() == 3);
  CHECK_FALSE(kinks.rate_jumps_at(1)); // slopes of 5 before and after
  CHECK_FALSE(kinks.jumps_at(1));
}

TEST_CASE("a delayed signal is the same later, and a constant sum of constants stays one") {
  const Signal pulse = haversine(3.0, 0.05, 0.1), later = delayed(pulse, 0.02), earlier = delayed(pulse, -0.1);
  check_against(later, [&](double t) { return pulse.value(t - 0.02); });
  for (const double t : {0.0, 0.03, 0.07}) CHECK(std::abs(earlier.value(t) - pulse.value(t + 0.1)) < 1e-14);
  const Signal two = Signal::constant(2.0), nothing;
  CHECK(sum_of({&two, &two, &nothing}, {1.0, 0.5, 1.0}).is_constant());
  CHECK(product_of({&two, &two}).value(7.0) == 4.0);
  CHECK(product_of({&two, &nothing}).value(7.0) == 0.0);
  CHECK(product_of({&two, &two}).is_constant());
}

TEST_CASE("a constant begins at t = 0 also next to a signal that begins before, and its delay counts from there") {
  const Signal early = haversine(1e-9, -0.05, 0.1), one = Signal::constant(1.0), later = delayed(sum_of({&early, &one}, {1.0, 1.0}), 0.2);
  CHECK(std::abs(later.value(0.19)) < 1e-8);
  CHECK(std::abs(later.value(0.21) - 1.0) < 1e-8);
}

TEST_CASE("a product that would grow beyond bounds is refused") {
  const Signal slope({Piece{0.0, {1.0, 1.0, 0, 0}, {}, {}}});
  std::vector<Signal> waves; // products have 2¹⁴ sums and differences of their frequencies
  for (int i = 0; i < 15; ++i) waves.push_back(sine(30.0 * std::sqrt(i + 1.0), 0.5));
  std::vector<const Signal*> many;
  for (const Signal& one : waves) many.push_back(&one);
  CHECK_THROWS_AS(static_cast<void>(product_of(many)), std::invalid_argument);
  CHECK_NOTHROW(static_cast<void>(product_of(std::vector<const Signal*>(k_most_power, &slope))));
  CHECK_THROWS_AS(static_cast<void>(product_of(std::vector<const Signal*>(k_most_power + 1, &slope))), std::invalid_argument);
}

// Each twice the one before: 2^60 terms if they were built anew wherever they are named.
TEST_CASE("a network builds each of its signals once") {
  const auto kind_named = [](const std::string& name) -> const SignalKind& {
    for (const SignalKind* kind : signal_kinds())
      if (kind->name == name) return *kind;
    throw std::logic_error(name);
  };
  Model model;
  const auto add = [&](const std::string& kind, const std::string& name, const std::string& field, FieldValue value) {
    const SignalKind& k = kind_named(kind);
    const auto definition = k.create();
    definition->name = name;
    k.fields.find(field)->set(definition.get(), value);
    model.signals.push_back({&k, definition});
  };
  add("constant", "s0", "value", 1.0);
  for (int i = 1; i <= 60; ++i) {
    const std::string before = "s" + std::to_string(i - 1);
    add("sum", "s" + std::to_string(i), "signals", std::vector<std::string>{before, before});
  }
  SignalNetwork network(model);
  CHECK(network.build("s60")->value(0.0) == std::pow(2.0, 60));
  CHECK(network.build("none") == nullptr);
}
