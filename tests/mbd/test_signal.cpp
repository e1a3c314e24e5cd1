// Signals: closed forms, integrals against quadrature, derivatives against differences, and the
// velocity changes that pulses bring.
#include "mbd/model/signal.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

using namespace steplap;

namespace {

constexpr double k_pi = std::numbers::pi;

const SignalKind& kind_named(const std::string& name) {
  for (const SignalKind* kind : signal_kinds())
    if (kind->name == name) return *kind;
  FAIL("no such kind");
  return *signal_kinds().front();
}

using Values = std::vector<std::pair<std::string, FieldValue>>;

Signal make(const std::string& name, const Values& values) {
  const SignalKind& kind = kind_named(name);
  const auto definition = kind.create();
  definition->name = "s";
  for (const auto& [field, value] : values) {
    REQUIRE(kind.fields.find(field));
    kind.fields.find(field)->set(definition.get(), value);
  }
  return kind.build(*definition);
}

std::string message_of(const std::string& name, const Values& values) {
  try {
    (void)make(name, values);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

// Composite Gauss-Legendre with four points on each of n parts of each interval between
// breakpoints.
double quadrature(const std::function<double(double)>& f, double from, double to, const std::vector<double>& breakpoints) {
  constexpr double x[] = {0.3399810435848563, 0.8611363115940526};
  constexpr double w[] = {0.6521451548625461, 0.3478548451374538};
  std::vector<double> knots{from};
  for (const double b : breakpoints)
    if (b > from && b < to) knots.push_back(b);
  knots.push_back(to);
  double sum = 0.0;
  constexpr int n = 40;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const double h = (knots[k + 1] - knots[k]) / n;
    for (int i = 0; i < n; ++i) {
      const double middle = knots[k] + (i + 0.5) * h;
      for (int j = 0; j < 2; ++j) sum += 0.5 * h * w[j] * (f(middle - 0.5 * h * x[j]) + f(middle + 0.5 * h * x[j]));
    }
  }
  return sum;
}

std::vector<std::pair<std::string, Signal>> samples() {
  const Values pulse{{"peak", -5.886}, {"start", 0.05}, {"duration", 0.1}};
  Values trapezoid = pulse, triangle = pulse;
  trapezoid.insert(trapezoid.end(), {{"rise", 0.02}, {"fall", 0.05}});
  triangle.push_back({"rise", 0.03});
  Signal::Piece cubic{-0.3, {1.0, -2.0, 3.0, 4.0}, {{0.5, 7.0, 0.4}}, {}};
  Signal::Piece later{0.1, {0.2, 0.1, 0.0, 0.0}, {}, {}};
  return {{"constant", make("constant", {{"value", 2.5}})},
          {"haversine", make("haversine", pulse)},
          {"half_sine", make("half_sine", pulse)},
          {"triangle", make("triangle", triangle)},
          {"trapezoid", make("trapezoid", trapezoid)},
          {"rectangle", make("rectangle", pulse)},
          {"harmonics", make("harmonics", {{"offset", 0.3},
                                           {"amplitudes", std::vector<double>{1.0, -0.4}},
                                           {"frequencies", std::vector<double>{3.0, 11.0}},
                                           {"phases", std::vector<double>{0.2, -1.0}},
                                           {"start", 0.01},
                                           {"duration", 0.2}})},
          {"chirp", make("chirp", {{"amplitude", 1.3}, {"from", 2.0}, {"to", 30.0}, {"start", 0.02}, {"duration", 0.17}, {"phase", 0.4}})},
          {"starts before zero", Signal({cubic, later})}};
}

} // namespace

TEST_CASE("integrals agree with quadrature") {
  for (const auto& [name, signal] : samples()) {
    CAPTURE(name);
    const auto f = [&s = signal](double t) { return s.value(t); };
    for (const double t : {0.01, 0.06, 0.1, 0.149, 0.3}) {
      const SignalJet jet = signal.drive(t, DriveLevel::acceleration);
      const auto moment = [&](double u) { return (t - u) * f(u); };
      CHECK(jet.acceleration == f(t));
      CHECK(jet.rate == doctest::Approx(quadrature(f, 0.0, t, signal.breakpoints())).epsilon(1e-12));
      CHECK(jet.value == doctest::Approx(quadrature(moment, 0.0, t, signal.breakpoints())).epsilon(1e-11));
    }
  }
}

TEST_CASE("derivatives agree with central differences") {
  constexpr double h = 1e-6;
  for (const auto& [name, signal] : samples()) {
    CAPTURE(name);
    for (const double t : {0.0123, 0.0634, 0.111, 0.1401, 0.171}) {
      const SignalJet jet = signal.drive(t, DriveLevel::position);
      const double before = signal.value(t - h), at = signal.value(t), after = signal.value(t + h);
      // Tolerances: |f'''| h² / 6 and rounding of the value over h and h².
      CHECK(std::abs(jet.rate - (after - before) / (2 * h)) < 1e-5);
      CHECK(std::abs(jet.acceleration - (after - 2 * at + before) / (h * h)) < 0.05);
      CHECK(jet.value == at - signal.value(0.0));
    }
  }
}

TEST_CASE("the three levels belong to one motion") {
  for (const auto& [name, signal] : samples()) {
    CAPTURE(name);
    const double t = 0.077;
    const SignalJet v = signal.drive(t, DriveLevel::velocity);
    const SignalJet a = signal.drive(t, DriveLevel::acceleration);
    const SignalJet x = signal.drive(t, DriveLevel::position);
    CHECK(v.value == a.rate);
    CHECK(v.rate == a.acceleration);
    CHECK(v.acceleration == x.rate);
    for (const DriveLevel level : {DriveLevel::position, DriveLevel::velocity, DriveLevel::acceleration})
      CHECK(std::abs(signal.drive(0.0, level).value) < 1e-15);
  }
}

TEST_CASE("the paper's pulse brings 1.1 km/h to within 0.04 km/h of rest") {
  const double peak = 5.886, duration = 0.1;
  const auto change = [&](const std::string& kind) {
    const Signal s = make(kind, {{"peak", -peak}, {"start", 0.05}, {"duration", duration}});
    return s.drive(0.8, DriveLevel::acceleration).rate;
  };
  CHECK(change("haversine") == doctest::Approx(-0.5 * peak * duration).epsilon(1e-14));
  CHECK(change("triangle") == doctest::Approx(-0.5 * peak * duration).epsilon(1e-14));
  CHECK(change("half_sine") == doctest::Approx(-2.0 / k_pi * peak * duration).epsilon(1e-14));
  CHECK(change("rectangle") == doctest::Approx(-peak * duration).epsilon(1e-14));
  CHECK(std::abs(1.1 + 3.6 * change("haversine")) < 0.045);
}

TEST_CASE("shapes at known times") {
  const Values pulse{{"peak", 4.0}, {"start", 1.0}, {"duration", 2.0}};
  CHECK(make("haversine", pulse).value(2.0) == doctest::Approx(4.0).epsilon(1e-15));
  CHECK(make("haversine", pulse).value(1.5) == doctest::Approx(2.0).epsilon(1e-15));
  CHECK(make("half_sine", pulse).value(2.0) == doctest::Approx(4.0).epsilon(1e-15));
  CHECK(make("triangle", pulse).value(1.5) == 2.0);
  CHECK(make("rectangle", pulse).value(1.0) == 4.0);
  CHECK(make("rectangle", pulse).value(3.0) == 0.0);
  for (const std::string kind : {"haversine", "half_sine", "triangle", "rectangle"}) {
    CHECK(make(kind, pulse).value(0.999) == 0.0);
    CHECK(make(kind, pulse).value(3.001) == 0.0);
  }
  const Signal sine = make(
      "harmonics",
      {{"amplitudes", std::vector<double>{2.0}}, {"frequencies", std::vector<double>{0.25}}, {"phases", std::vector<double>{-0.5 * k_pi}}});
  CHECK(sine.value(1.0) == doctest::Approx(2.0).epsilon(1e-15));
}

TEST_CASE("a trapezoid by its rise, hold and fall is the one of that duration") {
  const Values course{{"peak", -4.0}, {"start", 1.0}, {"rise", 0.25}, {"fall", 0.5}};
  Values held = course, lasting = course, both = course;
  held.push_back({"hold", 1.5});
  lasting.push_back({"duration", 2.25});
  both.insert(both.end(), {{"hold", 1.5}, {"duration", 2.25}});
  const Signal a = make("trapezoid", held), b = make("trapezoid", lasting);
  CHECK(a.breakpoints() == b.breakpoints()); // all times are sums of powers of two, so they are exact
  for (double t = 0.9; t < 3.4; t += 0.01) CHECK(a.value(t) == b.value(t));
  CHECK(a.drive(5.0, DriveLevel::acceleration).rate == doctest::Approx(-4.0 * (0.125 + 1.5 + 0.25)).epsilon(1e-15));
  CHECK(message_of("trapezoid", both) == "error: trapezoid 's' gives both 'hold' and 'duration': give one of them");
  CHECK(message_of("trapezoid", course).find("needs 'hold'") != std::string::npos);
  CHECK(message_of("trapezoid", {{"peak", 1.0}, {"rise", 0.0}, {"fall", 0.0}, {"hold", 0.0}}).find("lasts no time") != std::string::npos);
}

TEST_CASE("a sine begins at zero, without a jump, and is the cosine of 90 degrees less") {
  const Values wave{{"amplitude", 2.0}, {"frequency", 0.25}, {"start", 1.0}, {"duration", 8.0}};
  const Signal sine = make("sine", wave);
  CHECK_FALSE(sine.jumps_at(0));
  CHECK_FALSE(sine.jumps_at(1)); // two whole turns
  CHECK(sine.value(0.5) == 0.0);
  CHECK(std::abs(sine.value(1.0)) < 1e-15); // the cosine of a right angle, rounded
  CHECK(sine.value(2.0) == doctest::Approx(2.0).epsilon(1e-15));
  CHECK(sine.value(4.0) == doctest::Approx(-2.0).epsilon(1e-15));
  Values ahead = wave;
  ahead.push_back({"phase", 0.5 * k_pi});
  CHECK(make("sine", ahead).value(1.0) == 2.0);
}

TEST_CASE("small integrals keep their digits") {
  // ∫ = −p T/2π sin(2πτ/T)/... : just after its start a haversine is p (π τ/T)², so ∬ = p π² τ⁴ /
  // 12 T².
  const Signal sine(std::vector<Signal::Piece>{{0.0, {0, 0, 0, 0}, {{1.0, 10.0, -0.5 * k_pi}}, {}}});
  const double t = 1e-6;
  CHECK(sine.drive(t, DriveLevel::acceleration).rate == doctest::Approx(5.0 * t * t).epsilon(1e-9));
  CHECK(sine.drive(t, DriveLevel::acceleration).value == doctest::Approx(10.0 / 6.0 * t * t * t).epsilon(1e-8));
}

TEST_CASE("breakpoints and jumps") {
  const Values pulse{{"peak", 4.0}, {"start", 1.0}, {"duration", 2.0}};
  const Signal haversine = make("haversine", pulse), rectangle = make("rectangle", pulse);
  CHECK(haversine.breakpoints() == std::vector<double>{1.0, 3.0});
  CHECK_FALSE(haversine.jumps_at(0));
  CHECK_FALSE(haversine.jumps_at(1));
  CHECK(rectangle.jumps_at(0));
  CHECK(rectangle.jumps_at(1));
  CHECK(make("triangle", pulse).breakpoints() == std::vector<double>{1.0, 2.0, 3.0});
  CHECK_FALSE(make("half_sine", pulse).jumps_at(1));
  Values steep = pulse;
  steep.insert(steep.end(), {{"rise", 0.0}, {"fall", 2.0}});
  CHECK(make("trapezoid", steep).breakpoints() == std::vector<double>{1.0, 3.0});
  CHECK(make("trapezoid", steep).jumps_at(0));
  CHECK(Signal::constant(3.0).is_constant());
  CHECK(Signal::constant(3.0).breakpoints().empty());
  CHECK(Signal().is_constant());
  CHECK_FALSE(haversine.is_constant());
}

TEST_CASE("a record of 1e5 pieces") {
  std::vector<Signal::Piece> pieces;
  for (int i = 0; i < 100000; ++i) pieces.push_back({1e-3 * i, {std::sin(1e-3 * i), 0, 0, 0}, {}, {}});
  const Signal signal(pieces);
  CHECK(signal.value(50.0005) == std::sin(50.0));
  double sum = 0.0;
  for (int i = 0; i < 50000; ++i) sum += 1e-3 * std::sin(1e-3 * i);
  CHECK(signal.drive(50.0, DriveLevel::velocity).value == doctest::Approx(sum).epsilon(1e-11));
}

TEST_CASE("values that make no signal") {
  using Pieces = std::vector<Signal::Piece>;
  const Signal::Piece plain{1.0, {0, 0, 0, 0}, {}, {}};
  const Signal::Piece nan{0.0, {NAN, 0, 0, 0}, {}, {}};
  const Signal::Piece still{0.0, {0, 0, 0, 0}, {{1.0, 0.0, 0.0}}, {}};
  CHECK_THROWS_AS(Signal(Pieces{plain, plain}), std::invalid_argument);
  CHECK_THROWS_AS(Signal(Pieces{nan}), std::invalid_argument);
  CHECK_THROWS_AS(Signal(Pieces{still}), std::invalid_argument);
  CHECK_THROWS_WITH_AS(make("triangle", {{"peak", 1.0}, {"duration", 1.0}, {"rise", 2.0}}),
                       "error: triangle 's' rises longer than it lasts: 'rise' must not exceed 'duration'", ModelError);
  CHECK_THROWS_AS(make("trapezoid", {{"peak", 1.0}, {"duration", 1.0}, {"rise", 0.6}, {"fall", 0.5}}), ModelError);
  CHECK_THROWS_AS(make("harmonics", {{"amplitudes", std::vector<double>{1.0}}, {"frequencies", std::vector<double>{1.0, 2.0}}}),
                  ModelError);
}

TEST_CASE("every field of every kind is documented") {
  for (const SignalKind* kind : signal_kinds()) {
    CHECK_FALSE(kind->doc.empty());
    for (const Field& field : kind->fields.fields()) CHECK_FALSE(field.doc.empty());
  }
}

TEST_CASE("a drive by an acceleration of harmonics takes a way of its own to the same bytes") {
  // A term that is zero, and not a harmonic, sends the second one the usual way.
  const double lengths[] = {0.3, 1.7};
  std::vector<Signal::Piece> plain, usual;
  for (int k = 0; k < 2; ++k) {
    Signal::Piece piece;
    piece.start = k == 0 ? -0.2 : lengths[0];
    piece.c[0] = 0.7 - k;
    piece.harmonics.push_back({.amplitude = 1.3, .frequency = 21.0 + k, .phase = k == 0 ? 0.0 : 0.4});
    piece.harmonics.push_back({.amplitude = -0.2, .frequency = 55.0, .phase = 1.1});
    plain.push_back(piece);
    piece.modulated.push_back({.power = 1, .amplitude = 0.0, .frequency = 3.0});
    usual.push_back(piece);
  }
  const Signal a(plain), b(usual);
  for (double t = -0.5; t < lengths[1]; t += 0.013) {
    const SignalJet x = a.drive(t, DriveLevel::acceleration), y = b.drive(t, DriveLevel::acceleration);
    CHECK(x.value == y.value);
    CHECK(x.rate == y.rate);
    CHECK(x.acceleration == y.acceleration);
  }
}

TEST_CASE("the piece of a time is found in short and in long signals") {
  for (const int count : {1, 8, 9, 40}) {
    std::vector<Signal::Piece> pieces(count);
    for (int k = 0; k < count; ++k) {
      pieces[k].start = 0.1 * k;
      pieces[k].c[0] = k + 1.0;
    }
    const Signal steps(pieces);
    CHECK(steps.value(-1e-9) == 0.0);
    for (int k = 0; k < count; ++k) {
      CHECK(steps.value(pieces[k].start) == k + 1.0);
      CHECK(steps.value(pieces[k].start + 0.05) == k + 1.0);
    }
  }
}
