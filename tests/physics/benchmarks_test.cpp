// The model files in models/benchmarks against published and exact digits.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

// Closed forms and 30-digit integrations; double precision and tight steps leave ten digits of them.
constexpr double k_digits = 1e-10;

Run run_file(const std::string& name, double tolerance, double end) {
  const Model model = read_model(std::string(STEPLAP_MODELS) + "/benchmarks/" + name + ".toml", transformer_catalog());
  Run r;
  r.system = compile(model);
  SimulationOptions o = options({"dop853", tolerance, end});
  o.settings.projection_tolerance = model.simulation.projection_tolerance;
  r.result = simulate(*r.system, r.system->initial_state(), o);
  return r;
}

void check_digits(double value, double expected, double relative = k_digits) {
  CHECK(std::abs(value - expected) <= relative * std::abs(expected));
}

// β, Θ, γ, Φ, δ, Ω, ε of the literature.
std::vector<double> squeezer_angles(const Run& r) {
  const auto a = [&r](const char* body) { return r.last(std::string(body) + ".theta"); };
  return {a("K1"), a("K2") - a("K1"), a("K3"), a("K4") - a("K5"), a("K5"), a("K6") - a("K7"), a("K7")};
}

// B0, the free end of rod 0.
Vec2 free_end(const Run& r) { return {2.0 * r.last("rod 0.x"), 2.0 * r.last("rod 0.y")}; }

} // namespace

TEST_CASE("Andrews' squeezer, start of the test set") {
  const std::vector<double> exact = {15.8107711951537,  -15.7563710584118, 0.0408222401196458, -0.534730116342080,
                                     0.524409965879954, 0.534730116342080, 1.04808074104194};
  const std::vector<double> published = {15.81077119629904,  -15.75637105984298, 0.04082224013073101, -0.5347301163226948,
                                         0.5244099658805304, 0.5347301163226948, 1.048080741042263};
  const std::vector<double> angles = squeezer_angles(run_file("andrews", 1e-13, 0.03));
  for (std::size_t i = 0; i < exact.size(); ++i) {
    CAPTURE(i);
    check_digits(angles[i], exact[i]);
    // The published digits belong to a start rounded to 15 digits, which is worth 1.4e-9.
    CHECK(std::abs(angles[i] - published[i]) < 2e-9);
  }
}

TEST_CASE("Andrews' squeezer, start of IFToMM A03, after one and after many turns of the crank") {
  const std::vector<double> early = {15.8001746706622,  -15.7431293809670, 0.0407336971253818, -0.534884952845811,
                                     0.524405359380725, 0.534884952845811, 1.04807815813403};
  const std::vector<double> late = {33.8153407213602,  -33.5711553782194, 0.115158527591552, -0.404764941308129,
                                    0.526051256322152, 0.404764941308129, 1.05727175590757};
  for (const bool is_late : {false, true}) {
    const std::vector<double>& exact = is_late ? late : early;
    const std::vector<double> angles = squeezer_angles(run_file("andrews_a03", 1e-13, is_late ? 0.05 : 0.03));
    for (std::size_t i = 0; i < exact.size(); ++i) {
      CAPTURE(i);
      check_digits(angles[i], exact[i]);
    }
  }
}

TEST_CASE("N-four-bars pass their flat positions and stay on the parallelogram branch") {
  const auto passes = [](const char* file, const Vec2& exact) {
    CAPTURE(file);
    // Some hundred steps of a local error that is the tolerance times about a metre, carried on at 5 rad/s.
    for (const double tolerance : {1e-9, 1e-11}) {
      CAPTURE(tolerance);
      CHECK((free_end(run_file(file, tolerance, 10.0)) - exact).norm() < 300.0 * tolerance);
    }
    const Run r = run_file(file, 1e-12, 10.0);
    check_digits(free_end(r).x(), exact.x());
    check_digits(free_end(r).y(), exact.y());
    CHECK(r.result.statistics.energy_residual < 1e-6); // J; the library allows 0.1 J
  };
  passes("four_bar_2", {0.328458111540815, 0.944518538178601});
  passes("four_bar_40", {0.180512226686728, 0.983572740582312});
}

TEST_CASE("simple pendulum after 10 s") {
  const Run r = run_file("simple_pendulum", 1e-13, 10.0);
  check_digits(r.last("bob.x"), -0.275087462576117);
  check_digits(r.last("bob.y"), -0.961419205099125);
}

TEST_CASE("stick-slip on a belt: first stick, first slip, the grazing motion at 3 s") {
  const Run r = run_file("stick_slip_belt", 1e-13, 3.0);
  const std::vector<double> events = r.event_times("friction");
  REQUIRE(events.size() >= 3);
  CHECK(events[0] == 0.0); // it starts at rest on the belt that moves
  check_digits(events[1], 0.0747188139815066);
  check_digits(events[2], 0.182668443438953);
  check_digits(r.last("mass.x"), 0.0314469318813080);
  check_digits(r.last("mass.vx"), -0.198980397472595);
  CHECK(events.size() == 3); // from then on it grazes the belt's speed once a period, and never sticks again
  // Where it sticks: a run that ends there.
  check_digits(run_file("stick_slip_belt", 1e-13, 0.0747188139815066).last("mass.x"), 0.00784007410851070);
  // Where it grazes: v = 0.2 m/s again after whole periods of 2π/10 s; v is flat there (an error of v is
  // (error of t)² · 10 m/s³).
  for (const int period : {1, 2, 4})
    check_digits(run_file("stick_slip_belt", 1e-13, 0.182668443438953 + period * 0.2 * std::numbers::pi).last("mass.vx"), 0.2);
}

TEST_CASE("Den Hartog's oscillator: phases and the state at 10 s") {
  const Run r = run_file("den_hartog", 1e-13, 10.0);
  const std::vector<double> events = r.event_times("friction");
  const std::vector<double> expected = {0.279920279335179, 0.851888409415235, 1.45131468114814, 1.97262699328603, 2.41252234708784};
  std::vector<double> ends;
  for (const double t : events)
    if (t > 1e-6) ends.push_back(t);
  REQUIRE(ends.size() == 19); // 20 phases in 10 s
  for (std::size_t i = 0; i < expected.size(); ++i) check_digits(ends[i], expected[i]);
  // From the second on slip and stick take turns, and each slip goes the other way than the one before.
  std::vector<Event> changes;
  for (const Event& event : r.result.events)
    if (event.element == "friction" && event.t > 1e-6) changes.push_back(event);
  EventKind before = changes.front().kind;
  for (std::size_t i = 1; i < changes.size(); ++i) {
    CAPTURE(changes[i].t);
    CHECK((changes[i].kind == EventKind::sticks) == (i % 2 == 1));
    if (i % 2 == 1) continue;
    CHECK(changes[i].kind != before);
    before = changes[i].kind;
  }
  check_digits(r.last("mass.x"), -0.0363829137728667);
  check_digits(r.last("mass.vx"), 0.370762125122938);
}

TEST_CASE("a block on an incline stops where and when it should") {
  const Run r = run_file("block_on_incline", 1e-13, 2.0);
  const std::vector<double> stops = r.event_times("friction", "sticks");
  REQUIRE(stops.size() == 1);
  check_digits(stops[0], 1.59492851148150);
  check_digits(r.last("block.x"), 1.59492851148150);
}

TEST_CASE("bouncing mass: contacts and the state at 5 s") {
  const Run r = run_file("bouncing_mass", 1e-13, 10.0);
  const std::vector<double> closes = r.event_times("floor", "closes");
  CHECK(closes.size() == 43);
  check_digits(closes[0], 0.451523640985731);
  check_digits(closes[1], 1.27998531039192);
  // It lifts off where the force reaches zero: the floor, damped, comes back more slowly.
  check_digits(r.event_times("floor", "force reaches zero").at(0), 0.461309647824878);
  // The bounces add up to rest: an error of each contact's time adds up with them.
  check_digits(closes.back(), 9.3013309499589, 1e-9);
  CHECK(r.event_times("floor", "opens").size() == 42);
  const Run half = run_file("bouncing_mass", 1e-13, 5.0);
  check_digits(half.last("mass.y"), 0.173031311957123);
  check_digits(half.last("mass.vy"), 0.803729314210234);
}

TEST_CASE("double pendulum against Lagrange's equations in two angles") {
  // From the vertical, d = θ₁ − θ₂: 4/3 θ₁'' + ½ cos d θ₂'' = −½ sin d θ₂'² − 3/2 g sin θ₁,
  //                                 ½ cos d θ₁'' + 1/3 θ₂'' = ½ sin d θ₁'² − ½ g sin θ₂.
  using Four = std::array<double, 4>;
  const auto rates = [](const Four& y) {
    const double c = 0.5 * std::cos(y[0] - y[1]), s = 0.5 * std::sin(y[0] - y[1]);
    const double p = -s * y[3] * y[3] - 1.5 * 9.81 * std::sin(y[0]);
    const double q = s * y[2] * y[2] - 0.5 * 9.81 * std::sin(y[1]);
    const double determinant = 4.0 / 9.0 - c * c;
    return Four{y[2], y[3], (p / 3.0 - c * q) / determinant, (4.0 / 3.0 * q - c * p) / determinant};
  };
  const auto along = [](const Four& y, double h, const Four& k) {
    Four z;
    for (int i = 0; i < 4; ++i) z[i] = y[i] + h * k[i];
    return z;
  };
  constexpr int k_steps = 10000;
  constexpr double h = 1.0 / k_steps;
  Four y = {0.5 * std::numbers::pi, 0.5 * std::numbers::pi, 0.0, 0.0};
  for (int n = 0; n < k_steps; ++n) {
    const Four k1 = rates(y), k2 = rates(along(y, 0.5 * h, k1)), k3 = rates(along(y, 0.5 * h, k2)), k4 = rates(along(y, h, k3));
    for (int i = 0; i < 4; ++i) y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  }
  const Run r = run_file("double_pendulum", 1e-12, 1.0);
  // Fourth order at 1e-4 s, rates up to 20 rad/s: (ωh)⁴/120 a radian, 1e-13, over 20 rad.
  CHECK(std::abs(r.last("upper.theta") + 0.5 * std::numbers::pi - y[0]) < 1e-10);
  CHECK(std::abs(r.last("lower.theta") + 0.5 * std::numbers::pi - y[1]) < 1e-10);
}

TEST_CASE("slider-crank: the slider is where the crank and the rod put it, and friction takes its work") {
  const double t = 0.3, angle = 2.0 * std::numbers::pi * t;
  const Run r = run_file("slider_crank", 1e-10, t);
  const double s = 0.1 * std::sin(angle) - r.last("slider.y"); // the guide gives way by a micrometre
  CHECK(std::abs(r.last("slider.x") - (0.1 * std::cos(angle) + std::sqrt(0.09 - s * s))) < 1e-11);
  CHECK(r.result.statistics.dissipated > 0.0);
  CHECK(r.result.statistics.energy_residual < 1e-8); // of 1 J exchanged, local errors of 1e-10
}

TEST_CASE("a chain of ten rods and a rocking block keep their balance of energy") {
  CHECK(run_file("chain_10", 1e-11, 1.0).result.statistics.energy_residual < 1e-7); // of 490 J
  const Run block = run_file("rocking_block", 1e-9, 4.0);
  CHECK(block.event_times("left corner", "closes").size() > 3);
  CHECK(block.result.statistics.energy_residual < 1e-4); // of 100 J, over 70 events
}
