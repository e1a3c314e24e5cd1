// Where a slip begins and ends: the same for every method, tolerance and mass that has no part in
// it.
#include "tests/elements/step_lap/step_lap_scene.h"
#include "tests/sanitized.h"

#include <doctest/doctest.h>

using namespace step_lap_scene;
using steplap::Vec2;

namespace {

// A corner of a limb of width and yoke height 0.585 m: 7.5 mm of overlap along a mitre of 0.827 m.
// `side`: 1 top, −1 bottom.
std::string corner(double side, double pressure) {
  const double width = 0.585, lap = 7.5e-3, length = width * M_SQRT2;
  const Vec2 from(-1.0 + 0.5 * width, side * (1.65 - width)), along(-M_SQRT1_2, side * M_SQRT1_2);
  const Vec2 away(-M_SQRT1_2, -side * M_SQRT1_2); // from the yoke
  const auto strip = [&](double s0, double s1, double q0, double q1) {
    std::vector<Vec2> ring;
    for (const auto& [s, q] : {std::pair{s0, q0}, std::pair{s1, q0}, std::pair{s1, q1}, std::pair{s0, q1}})
      ring.push_back(from + s * along + q * away);
    return ring;
  };
  return interface(strip(-0.02, length + 0.02, -0.05, 0.5 * lap), strip(0.0, length, -0.5 * lap, 0.05), pressure, 0.2, "count = 2079",
                   side > 0.0 ? "top" : "bottom");
}

// A limb of 9 t on a base that a haversine of 1.5 g and 60 ms stops.
std::string stopped_base(const std::string& simulation, double pressure = 0.03e6, double base_mass = 5e4, bool has_bottom = true) {
  const double speed = 1.5 * 9.81 * 0.03; // what the pulse takes away
  return header(simulation + "\nvelocity = [" + number(speed) + ", 0.0]", 0.1, "[0.0, -9.81]") +
         body("base", base_mass, 2.0 * base_mass, {0, 0}, {speed, 0.0}) + body("limb", 9e3, 10.8e3, {-0.95, 0.1}, {speed, 0.0}) +
         "[[signal]]\nname = \"stop\"\nkind = \"haversine\"\npeak = " + number(-1.5 * 9.81) +
         "\nstart = 0.02\nduration = 0.06\n"
         "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"base\"\ncoordinate = "
         "\"x\"\nsignal = \"stop\"\nas = \"acceleration\"\n"
         "[[element]]\nkind = \"prismatic\"\nname = \"road\"\na = \"base\"\nb = \"ground\"\naxis = "
         "[1.0, 0.0]\n" +
         joint("limb", "base") + corner(1.0, pressure) + (has_bottom ? corner(-1.0, pressure) : "");
}

struct Stop {
  std::size_t slips = 0, sticks = 0, other = 0;
  double onset = 0.0, rest = 0.0;
  double dx = 0.0, dy = 0.0;
};

Stop stop_of(const std::string& text) {
  const Run r = run_text(text);
  Stop stop;
  const auto slips = r.times("joint", "slips"), sticks = r.times("joint", "sticks");
  stop.slips = slips.size();
  stop.sticks = sticks.size();
  stop.other = r.times("joint", "slips another way").size();
  if (!slips.empty()) stop.onset = slips.front();
  if (!sticks.empty()) stop.rest = sticks.back();
  const std::vector<double>& q = r.result.final_state.q;
  stop.dx = q[6] - q[3];
  stop.dy = q[7] - q[4];
  return stop;
}

std::string with(const std::string& method, const std::string& how) { return "end = 0.1\nintegrator = \"" + method + "\"\n" + how; }

std::string tolerance(const std::string& value) { return "tolerance = " + value; }

} // namespace

TEST_CASE("a slip begins and ends once, whatever the tolerance, and at the same time for every method") {
  // Far finer than what it is compared with.
  const Stop exact = stop_of(stopped_base(with("dop853", tolerance(steplap::testing::k_is_sanitized ? "1e-9" : "1e-12"))));
  REQUIRE(exact.slips == 1);
  REQUIRE(exact.sticks == 1);
  const double slip = exact.rest - exact.onset;
  for (const std::string method : {"dop853", "tsit5", "rodas5p", "auto"})
    for (const double tol : {1e-3, 1e-4, 1e-6, 1e-9, 1e-11}) {
      const bool is_slow = method == "rodas5p" || method == "auto"; // a second at 1e-11
      if (is_slow ? tol < 1e-6 : tol == 1e-6) continue;
      if (steplap::testing::k_is_sanitized && tol < 1e-6) continue;
      CAPTURE(method);
      CAPTURE(tol);
      const Stop stop = stop_of(stopped_base(with(method, tolerance(number(tol)))));
      CHECK(stop.slips == 1);
      CHECK(stop.sticks == 1);
      CHECK(stop.other == 0);
      // The tolerance allows a step an error of tol × (0.44 m/s + 0.06 m/s) × √14 (of one velocity,
      // the norm being a mean of 14), or of the share 5e-4 of the slip where that is less; ten of
      // them make 20 tol m/s, or half a per cent. A deceleration of some 3 m/s² makes times of it,
      // the slip's 13 ms distances.
      const double speed = 20.0 * tol, share = 0.01;
      CHECK(std::abs(stop.rest - exact.rest) < std::min(speed / 3.0, share * slip) + 1e-12);
      CHECK(std::abs(stop.dx - exact.dx) < std::min(speed * slip, share * std::abs(exact.dx)) + 1e-13);
      CHECK(std::abs(stop.dy - exact.dy) < std::min(speed * slip, share * std::abs(exact.dy)) + 1e-13);
    }
}

TEST_CASE("the mass of a base whose motion is given has no part in when a slip ends") {
  for (const bool has_bottom : {true, false}) {
    if (steplap::testing::k_is_sanitized && !has_bottom) continue; // the same with fewer elements
    const double pressure = has_bottom ? 0.03e6 : 0.15e6;
    const Stop light = stop_of(stopped_base(with("dop853", tolerance("1e-12")), pressure, 1e3, has_bottom));
    const Stop heavy = stop_of(stopped_base(with("dop853", tolerance("1e-12")), pressure, 1e7, has_bottom));
    REQUIRE(light.sticks >= 1);
    REQUIRE(heavy.sticks == light.sticks);
    // ten thousand times the mass changes the acceleration to which the law's beginning and end are
    // scaled and each of some hundred steps rounds by 1e-12, its tolerance, of velocities up to
    // 0.44 m/s
    CHECK(std::abs(light.rest - heavy.rest) < 1e-11);
    CHECK(std::abs(light.dy - heavy.dy) < 1e-12);
  }
}

TEST_CASE("a fixed step follows a slip from its beginning to its end") {
  const double exact = stop_of(stopped_base(with("dop853", tolerance("1e-12")))).rest;
  for (const double step : {4e-3, 1e-3}) {
    if (steplap::testing::k_is_sanitized && step < 4e-3) continue;
    CAPTURE(step);
    const Stop stop = stop_of(stopped_base(with("rk4", "step = " + number(step))));
    CHECK(stop.slips == 1);
    CHECK(stop.sticks == 1);
    // Of first order it would be half a step; steps short enough for the slip's direction are exact
    // to (1/2)⁴/4! of what that turns by in one: 1e-10 of the slip at the beginning, where it is a
    // millionth.
    CHECK(std::abs(stop.rest - exact) < 1e-10);
  }
}

TEST_CASE("a uniform disc that slides and spins is at rest at the same time for every method") {
  const auto scene = [](const std::string& simulation) {
    return header(simulation, 0.3) + body("slider", 1.0, 0.5, {0, 0}, {1.0, 0.0}, 0.5) + joint("slider", "ground") +
           interface(rectangle(-10, -10, 10, 10), disc(1.0, 12), 1.0 / M_PI / 0.25, 0.25);
  };
  const auto rest = [&](const std::string& simulation) {
    const auto t = run_text(scene("end = 1.8\n" + simulation)).times("joint", "sticks");
    return t.size() == 1 ? t[0] : 0.0;
  };
  const double exact = rest("integrator = \"dop853\"\ntolerance = 1e-12");
  REQUIRE(exact > 1.0);
  for (const char* method : {"tsit5", "rodas5p", "auto"})
    for (const double tol : {1e-3, 1e-6, 1e-10}) {
      CAPTURE(method);
      CAPTURE(tol);
      // some twenty steps of tol (0.06 + 1) m/s each, deceleration about 0.6 m/s²
      CHECK(std::abs(rest(std::string("integrator = \"") + method + "\"\ntolerance = " + number(tol)) - exact) < 30.0 * tol);
    }
  CHECK(std::abs(rest("integrator = \"rk4\"\nstep = 1e-2") - exact) < 1e-6);
}
