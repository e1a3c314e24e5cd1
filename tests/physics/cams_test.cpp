// Cams: when the follower leaves, where it comes back, what it gives the cam, and curves through points.
#include "elements/machinery/lift_curve.h"
#include "tests/physics/rest_scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p"};
constexpr double k_mass = 0.5, k_radius = 0.01, k_pressed = 20.0, k_stiffness = 1e7;

// h = r (1 − cos φ), and a follower pressed by its weight and F₀. On a contact of stiffness k it swings with the steady motion
//   y = r − A cos ω t − (g + F₀/m)/ω_n²,  A = r ω_n²/(ω_n² − ω²),  N = m (A ω² cos ω t + g) + F₀
// from the start on, if it begins there.
struct Eccentric {
  double omega;
  [[nodiscard]] double natural() const { return k_stiffness / k_mass; } // ω_n²
  [[nodiscard]] double amplitude() const { return k_radius * natural() / (natural() - omega * omega); }
  [[nodiscard]] double held() const { return k_g + k_pressed / k_mass; }
  [[nodiscard]] double start() const { return k_radius - amplitude() - held() / natural(); }
  [[nodiscard]] std::string text() const {
    return body("follower", "mass = 0.5; inertia = 0.01; position = [0.0, 1.0]") +
           element("prismatic", "guide", "a = 'follower'; axis = [0.0, 1.0]") +
           body("shaft", "mass = 1.0; inertia = 0.01; angular_velocity = " + number(omega)) +
           element("revolute", "bearing", "a = 'shaft'") + signal_entry("constant", "speed", "value = " + number(omega)) +
           element("prescribed_motion", "drive", "a = 'shaft'; coordinate = 'angle'; signal = 'speed'; as = 'velocity'") +
           element("load", "spring", "at = 'follower'; force = [0.0, -20.0]") +
           element("cam", "cam",
                   "a = 'follower'; cam = 'shaft'; formula = \"'10 mm' * (1 - cos(value))\"; stiffness = 1e7; gap = " + number(start()));
  }
};

// The jump speed: A ω² = g + F₀/m.
double jump_speed() {
  const double held = k_g + k_pressed / k_mass, natural = k_stiffness / k_mass;
  return std::sqrt(held / (k_radius + held / natural));
}

} // namespace

TEST_CASE("a follower leaves an eccentric above the jump speed and never below, where the force of the steady motion is zero") {
  CHECK(jump_speed() ==
        doctest::Approx(std::sqrt((k_g + k_pressed / k_mass) / k_radius)).epsilon(2e-4)); // the rigid cam's: ω² r = g + F₀/m
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Eccentric slow{0.999 * jump_speed()}, fast{1.01 * jump_speed()};
    CHECK(run(slow.text(), {method, 1e-11, 0.5}).event_times("cam").empty());
    const Run r = run(fast.text(), {method, 1e-12, 0.1, 0.001});
    const std::vector<double> off = r.event_times("cam", "opens"), on = r.event_times("cam", "closes");
    REQUIRE(!off.empty());
    REQUIRE(!on.empty());
    const double a = fast.amplitude() * fast.omega * fast.omega, leaves = std::acos(-fast.held() / a) / fast.omega;
    CHECK(std::abs(off[0] - leaves) < 1e-8);
    // Then it flies: y'' = −g − F₀/m, until the curve meets it again.
    const auto position = [&](double t) { return k_radius - fast.amplitude() * std::cos(fast.omega * t) - fast.held() / fast.natural(); };
    const double y = position(leaves), v = fast.amplitude() * fast.omega * std::sin(fast.omega * leaves);
    const auto gap = [&](double t) {
      const double s = t - leaves;
      return y + v * s - 0.5 * fast.held() * s * s - k_radius * (1.0 - std::cos(fast.omega * t));
    };
    double low = leaves + 1e-3, high = leaves + 1e-3;
    REQUIRE(gap(low) > 0.0);
    while (gap(high) > 0.0) high += 1e-4;
    for (int n = 0; n < 100; ++n) (gap(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
    CHECK(std::abs(on[0] - low) < 1e-7); // the time of flight takes the errors of the speed with it
  }
}

TEST_CASE("a cam and its follower exchange energy without loss, and what damps is told as heat") {
  for (const double damping : {0.0, 300.0}) {
    CAPTURE(damping);
    const std::string text = body("follower", "mass = 2.0; inertia = 0.1; position = [0.1, 1.0]") +
                             element("prismatic", "guide", "a = 'follower'; axis = [0.0, 1.0]") +
                             body("shaft", "mass = 3.0; inertia = 0.05; angular_velocity = 20.0") +
                             element("revolute", "bearing", "a = 'shaft'") +
                             element("spring_damper", "spring",
                                     "a = 'follower'; b = { body = 'ground', at = [0.1, 2.0] }; stiffness = 500.0; preload = -100.0") +
                             element("cam", "cam",
                                     "a = 'follower'; cam = 'shaft'; lift = [[0.0, 0.0], [1.0, 0.01], [2.2, 0.03], [3.5, 0.04], [5.0, "
                                     "0.015], [6.283185307179586, 0.0]]; "
                                     "stiffness = 2e5; damping = " +
                                         number(damping));
    double before = 0.0;
    for (const char* method : k_methods) {
      CAPTURE(method);
      const Run r = run(text, {method, 1e-10, 2.0, 1.0});
      CHECK(std::abs(r.result.statistics.energy_residual) < 1e-5); // of 10 J
      CHECK((r.result.statistics.dissipated > 1e-3) == (damping > 0.0));
      const double turned = r.last("shaft.theta");
      if (before != 0.0) CHECK(std::abs(turned - before) < 1e-5);
      before = turned;
    }
  }
}

TEST_CASE("a groove holds the follower both ways: it follows at any speed, pushed and pulled by m h'' ω²") {
  const double omega = 300.0;
  const std::string text =
      k_no_gravity + body("follower", "mass = 0.5; inertia = 0.01; position = [0.0, 1.0]; velocity = [0.0, 0.0]") +
      element("prismatic", "guide", "a = 'follower'; axis = [0.0, 1.0]") +
      body("shaft", "mass = 1.0; inertia = 0.01; angular_velocity = 300.0") + element("revolute", "bearing", "a = 'shaft'") +
      signal_entry("constant", "speed", "value = 300.0") +
      element("prescribed_motion", "drive", "a = 'shaft'; coordinate = 'angle'; signal = 'speed'; as = 'velocity'") +
      element("cam", "cam",
              "a = 'follower'; cam = 'shaft'; holds = true; formula = \"'10 mm' * (1 - cos(value))\"; stiffness = 1e8; damping = 2e3");
  const Run r = run(text, {"dop853", 1e-10, 0.2, 0.001});
  const std::vector<double> t = r.times(), y = r.series("follower.y"), force = r.series("cam.force");
  CHECK(r.event_times("cam").empty());
  for (std::size_t i = 100; i < t.size(); ++i) {
    CHECK(std::abs(y[i] - 1.0 - k_radius * (1.0 - std::cos(omega * t[i]))) < 1e-5); // k/m = 2e8 1/s², ω² = 9e4 1/s²: 4.5e-4 of 10 mm
    CHECK(std::abs(force[i] - k_mass * k_radius * omega * omega * std::cos(omega * t[i])) < 1.5); // of 450 N
  }
}

TEST_CASE("curves through points: periodic without a seam, with the order of a cubic spline, straight beyond ends that are none") {
  const auto lift = [](double x) { return 0.01 * (1.0 - std::cos(x)) + 0.003 * std::sin(2.0 * x); };
  double before = 0.0;
  for (const int n : {16, 32, 64}) {
    std::vector<Vec2> points;
    for (int i = 0; i <= n; ++i) points.emplace_back(2.0 * k_pi * i / n, lift(2.0 * k_pi * (i % n) / n));
    const LiftCurve curve(points);
    double off = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const double x = -7.0 + 0.02 * i;
      off = std::max(off, std::abs(curve.at(x).value - lift(x)));
      const double step = 1e-6;
      CHECK(std::abs((curve.at(x + step).value - curve.at(x - step).value) / (2.0 * step) - curve.at(x).slope) < 1e-9);
      CHECK(std::abs((curve.at(x + step).slope - curve.at(x - step).slope) / (2.0 * step) - curve.at(x).curvature) < 1e-6);
    }
    if (before != 0.0) CHECK(before / off > 13.0); // h⁴
    before = off;
    const Lift left = curve.at(2.0 * k_pi - 1e-9), right = curve.at(2.0 * k_pi + 1e-9);
    CHECK(std::abs(left.curvature - right.curvature) < 1e-9);
  }
  const LiftCurve arm({{0.0, 0.0}, {0.5, 0.01}, {1.0, 0.05}});
  CHECK(arm.at(-0.3).value == doctest::Approx(-0.3 * arm.at(0.0).slope));
  CHECK(arm.at(1.4).value == doctest::Approx(0.05 + 0.4 * arm.at(1.0).slope));
  CHECK(arm.at(1.4).curvature == 0.0);
}

TEST_CASE("what is wrong with a cam is told") {
  const auto complaint = [](const std::string& fields) {
    try {
      (void)compile(scene(body("follower", "mass = 1.0; inertia = 0.1") + body("shaft", "mass = 1.0; inertia = 0.1") +
                          element("cam", "cam", "a = 'follower'; stiffness = 1e4; " + fields) + k_head));
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto says = [&](const std::string& fields, const std::string& part) {
    const std::string text = complaint(fields);
    CHECK_MESSAGE(text.find(part) != std::string::npos, text);
  };
  CHECK(complaint("cam = 'shaft'; formula = \"'1 mm' * sin(value)\"") == "nothing");
  says("cam = 'follower'; formula = \"'1 mm' * sin(value)\"", "a separate body");
  says("cam = 'shaft'", "give either 'lift', as points, or its 'formula'");
  says("cam = 'shaft'; formula = \"'1 mm' * abs(value)\"", "has a kink or a jump");
  says("cam = 'shaft'; formula = \"'1 mm' * shaft.theta\"", "may hold the angle `value` and parameters alone");
  says("cam = 'shaft'; formula = \"'1 mm' * value * t / '1 s'\"", "not the time");
  says("cam = 'shaft'; formula = \"'1 mm'\"", "lifts nothing");
  says("cam = 'shaft'; formula = \"'1 s' * value\"", "formula");
  says("cam = 'shaft'; formula = \"'1 mm' / value\"", "no finite value");
  says("cam = 'shaft'; lift = [[0.0, 0.0], [1.0, 0.1]]", "at least three points");
  says("cam = 'shaft'; lift = [[0.0, 0.0], [1.0, 0.1], [0.5, 0.2]]", "increase in angle");
  says("cam = 'shaft'; lift = [[0.0, 0.0], [3.0, 0.1], [6.283185307179586, 0.2]]", "spans a whole turn, but ends at");
  says("cam = 'shaft'; lift = [[0.0, 0.0], [3.0, 0.1], [7.0, 0.0]]", "more than a whole turn");
  says("cam = 'shaft'; lift = [[0.0, 0.0], [1.0, 0.1], [2.0, 0.0]]", "spans 114.6 degrees of a turn, from 0 to 2 rad only");
  CHECK(complaint("cam = 'shaft'; lift = [[0.0, 0.0], [2.0943951, 0.1], [4.1887902, 0.2]]") ==
        "nothing");                                                                            // even: the first point comes next
  CHECK(complaint("cam = 'shaft'; lift = [[0.0, 0.0], [2.5, 0.1], [5.0, 0.0]]") == "nothing"); // ends as it begins, 1.28 rad before that
  // Across a dwell of 3 rad the smooth curve goes on as the bump of 0.1 rad ends.
  says("cam = 'shaft'; lift = [[0.0, 0.0], [3.0, 0.0], [3.01, 0.0], [3.02, 5e-4], [3.03, 1e-3], [3.04, 5e-4], [3.05, 0.0], [3.06, 0.0], "
       "[4.0, 0.0], [6.283185307179586, 0.0]]",
       "the smooth curve through 'lift' leaves its points");
  says("cam = 'shaft'; axis = [0.0, 0.0]; formula = \"'1 mm' * sin(value)\"", "no direction");
}
