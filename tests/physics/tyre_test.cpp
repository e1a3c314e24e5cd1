// Tyres: slip, standstill, locked wheels and landings by closed forms; the nearest place of a road by brute force; rolling resistance.
#include "elements/machinery/road.h"
#include "tests/physics/rest_scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p"};
constexpr double k_mass = 400.0, k_radius = 0.3, k_stiffness = 2e5, k_friction = 0.8;
constexpr double k_slip = 4e4, k_length = 0.2, k_spring = k_slip / k_length, k_damper = 300.0; // C, σ, C/σ, b
constexpr double k_most = k_friction * k_mass * k_g;

std::string tyre(const std::string& more = "") {
  return element(
      "tyre", "tyre",
      "a = 'wheel'; radius = 0.3; stiffness = 2e5; friction = 0.8; slip_stiffness = 4e4; relaxation_length = 0.2; tread_damping = 300; " +
          more);
}

// At rest on its tyre, as far as up and down go.
std::string wheel(double speed, double spin) {
  return body("wheel", "mass = 400; inertia = 9; position = [0.0, " + number(k_radius - k_mass * k_g / k_stiffness) + "]; velocity = [" +
                           number(speed) + ", 0.0]; angular_velocity = " + number(spin));
}

std::string moved(const std::string& name, const std::string& coordinate, double rate) {
  return signal_entry("constant", name + " rate", "value = " + number(rate)) +
         element("prescribed_motion", name,
                 "a = 'wheel'; coordinate = '" + coordinate + "'; signal = '" + name + " rate'; as = 'velocity'");
}

// At 1e-12: forces of kilonewtons, by springs of 2e5 N/m.
constexpr double k_close = 1e-5; // N

} // namespace

TEST_CASE(
    "a tyre that is driven with a constant slip: its force follows over the relaxation length and is the slip stiffness times the slip") {
  const double speed = 10.0, spin = -1.02 * speed / k_radius, passing = k_radius * -spin, slip = speed + k_radius * spin;
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(wheel(speed, spin) + tyre() + moved("way", "x", speed) + moved("turn", "angle", spin), {method, 1e-12, 0.4, 0.01});
    const double bent = k_length * slip / passing, rate = passing / k_length;
    for (std::size_t i = 0; i < r.times().size(); ++i) {
      const double left = std::exp(-rate * r.times()[i]);
      CHECK(std::abs(-r.series("tyre.friction")[i] - (k_spring * bent * (1.0 - left) + k_damper * bent * rate * left)) < k_close);
    }
    CHECK(r.last("tyre.friction") == doctest::Approx(-k_slip * slip / passing).epsilon(1e-6)); // e^-20 is left
    CHECK(r.last("tyre.mode") == 1.0);
  }
}

TEST_CASE("a tyre that would slip more than friction gives slides, from the instant at which its bristles take that much") {
  const double speed = 10.0, spin = -0.8 * speed / k_radius, passing = k_radius * -spin, slip = speed + k_radius * spin;
  const double bent = k_length * slip / passing, rate = passing / k_length;
  REQUIRE(k_spring * bent > k_most);
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(wheel(speed, spin) + tyre() + moved("way", "x", speed) + moved("turn", "angle", spin), {method, 1e-12, 0.4});
    const std::vector<double> slides = r.event_times("tyre", "slips forward");
    REQUIRE(slides.size() == 1);
    CHECK(std::abs(slides[0] - std::log((k_spring * bent - k_damper * bent * rate) / (k_spring * bent - k_most)) / rate) < 1e-9);
    CHECK(r.last("tyre.friction") == doctest::Approx(-k_most).epsilon(1e-10));
    CHECK(r.last("tyre.bent") == doctest::Approx(k_most / k_spring).epsilon(1e-6));
    CHECK(r.last("tyre.mode") == 2.0);
  }
}

TEST_CASE("a tyre that stands is a spring beside a damper, and lets go at the instant at which it takes all of its friction") {
  // Pushed by g t: m x″ + b x′ + c x = g t from rest.
  const double growth = 2000.0, decay = 0.5 * k_damper / k_mass, turn = std::sqrt(k_spring / k_mass - decay * decay);
  const auto taken = [&](double t) { // g t less what accelerates the mass
    const double offset = growth * k_damper / (k_spring * k_spring), e = std::exp(-decay * t), c = std::cos(turn * t),
                 s = std::sin(turn * t);
    const double b = (offset * decay - growth / k_spring) / turn; // x = g/c t − offset + e (offset c + b s)
    const double acceleration = e * ((decay * decay - turn * turn) * (offset * c + b * s) - 2.0 * decay * turn * (b * c - offset * s));
    return growth * t - k_mass * acceleration;
  };
  double low = 1.0, high = 2.0; // it takes 2000 N after 1 s, 4000 N after 2 s, and swings by less than 200 N
  while (taken(low) < k_most) low += 1e-4;
  high = low;
  low -= 1e-4;
  for (int i = 0; i < 60; ++i) (taken(0.5 * (low + high)) < k_most ? low : high) = 0.5 * (low + high);
  const std::string text = wheel(0.0, 0.0) + tyre() + moved("turn", "angle", 0.0) +
                           element("force", "push", "a = 'wheel'; coordinate = 'x'; formula = \"'2000 N/s' * t\"");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-12, 2.0});
    const std::vector<double> slides = r.event_times("tyre", "slips forward");
    REQUIRE(!slides.empty());
    CHECK(std::abs(slides[0] - high) < 1e-8);
  }
}

TEST_CASE("a tyre that stands does not creep") {
  const std::string text =
      wheel(0.0, 0.0) + tyre() + moved("turn", "angle", 0.0) + element("load", "push", "at = 'wheel'; force = [1500.0, 0.0]");
  const Run r = run(text, {"dop853", 1e-10, 200.0});
  CHECK(r.last("wheel.x") == doctest::Approx(1500.0 / k_spring).epsilon(1e-8)); // swings have died out
  CHECK(r.last("tyre.mode") == 1.0);
}

TEST_CASE("a tread that slides from the start, from where the wheel lands or from where an action lets it says so") {
  const auto kinds = [](const Run& r) {
    std::string words;
    for (const Event& event : r.result.events)
      if (event.element == "tyre") words += (words.empty() ? "" : ", ") + event.words();
    return words;
  };
  CHECK(kinds(run(wheel(20.0, 0.0) + tyre() + moved("turn", "angle", 0.0), {"dop853", 1e-10, 0.1})) == "slips forward");
  const std::string falls = body("wheel", "mass = 400; inertia = 9; position = [0.0, 0.35]; velocity = [20.0, 0.0]");
  CHECK(kinds(run(falls + tyre() + moved("turn", "angle", 0.0), {"dop853", 1e-10, 0.11})) == "closes, slips forward");
  const std::string ice = "[[action]]\nname = 'ice'\nwhen = '0.5 s'\ndo = ['set tyre.friction = 0.01']\n"; // 39 N of 300
  const Run r =
      run(wheel(0.0, 0.0) + tyre() + moved("turn", "angle", 0.0) + element("load", "push", "at = 'wheel'; force = [300.0, 0.0]") + ice,
          {"dop853", 1e-10, 1.0});
  CHECK(kinds(r).starts_with("slips forward")); // bristles let go while the wheel swings back on them, and may hold once more
  CHECK(r.event_times("tyre", "slips forward").front() == 0.5);
}

TEST_CASE("a wheel that is locked comes to rest by μ g") {
  const double speed = 20.0;
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(wheel(speed, 0.0) + tyre() + moved("turn", "angle", 0.0), {method, 1e-12, 4.0, 0.5});
    const std::vector<double> rests = r.event_times("tyre", "sticks");
    REQUIRE(!rests.empty());
    CHECK(std::abs(rests[0] - speed / (k_friction * k_g)) < 1e-8);
    // It springs back by what its bristles were bent, and swings about that.
    CHECK(std::abs(r.last("wheel.x") - (speed * speed / (2.0 * k_friction * k_g) - k_most / k_spring)) < 0.02);
    CHECK(r.result.statistics.energy_residual < 1e-9 * r.result.statistics.energy_exchanged);
    CHECK(std::abs(r.result.statistics.dissipated - 0.5 * k_mass * speed * speed) < 40.0); // but for the energy of ½ (μ m g)²/c
  }
}

TEST_CASE("a wheel falls, is pressed, and rises as high as it was") {
  const double height = 0.2, speed = std::sqrt(2.0 * k_g * height), swing = std::sqrt(k_stiffness / k_mass);
  const double falls = speed / k_g, pressed = 2.0 / swing * (k_pi - std::atan(swing * speed / k_g));
  const std::string text = body("wheel", "mass = 400; inertia = 9; position = [0.0, " + number(k_radius + height) + "]") + tyre();
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-12, 2.0 * falls + pressed});
    CHECK(std::abs(r.event_times("tyre", "closes")[0] - falls) < 1e-9);
    CHECK(std::abs(r.event_times("tyre", "opens")[0] - falls - pressed) < 1e-9);
    CHECK(std::abs(r.last("wheel.y") - k_radius - height) < 1e-8);
  }
}

TEST_CASE("a wheel that lands without turning is spun up, and leaves nothing out of the account of its energy") {
  const std::string text = body("wheel", "mass = 400; inertia = 9; position = [0.0, 0.5]; velocity = [15.0, 0.0]") + tyre("damping = 2e3");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-11, 12.0, 0.5});
    CHECK(r.result.statistics.energy_residual < 1e-7 * r.result.statistics.energy_exchanged);
    CHECK(r.event_times("tyre", "closes").size() >= 2); // it bounces
    CHECK(!r.event_times("tyre", "sticks").empty());    // it lands sliding
    // In the end it rolls: what was lost to sliding is that of a blow, m v' + J v'/r² = m v.
    const double rolls = k_mass * 15.0 / (k_mass + 9.0 / (k_radius * k_radius));
    CHECK(r.last("wheel.vx") == doctest::Approx(rolls).epsilon(1e-8));
    CHECK(std::abs(r.last("tyre.slip_rate")) < 1e-4);
  }
}

TEST_CASE("of a road the nearest place is found") {
  // Random humps and hollows, of which none is as narrow as the points above are high.
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Vec2> points;
  for (int i = 0; i <= 40; ++i) points.emplace_back(0.5 * i, 0.08 * unit(generator));
  const Road road(points);
  const double reach = 1.0 / road.hollowest();
  REQUIRE(reach > 0.1);
  const auto height_of = [curve = SmoothCurve(points)](double x) { return curve.value(x); };
  for (int i = 0; i < 300; ++i) {
    const double x = 10.0 + 11.0 * unit(generator), above = 0.5 * reach * (1.0 + 0.6 * unit(generator)), y = height_of(x) + above;
    const RoadPoint<double> found = road.nearest(x, y);
    const double distance = std::hypot(found.x - x, found.height - y);
    CHECK(std::abs((found.x - x) + found.slope * (found.height - y)) < 1e-13 * (1.0 + std::abs(x)));
    double least = above;
    for (double s = x - above; s <= x + above; s += 1e-3) least = std::min(least, std::hypot(s - x, height_of(s) - y));
    CHECK(distance <= least + 1e-13);
    // Its derivatives, by differences.
    constexpr double h = 1e-5;
    const RoadPoint<Dual<2>> d = road.nearest(Dual<2>::variable(x, 0), Dual<2>::variable(y, 1));
    CHECK(d.x.v == found.x);
    CHECK(std::abs(d.x.d[0] - (road.nearest(x + h, y).x - road.nearest(x - h, y).x) / (2.0 * h)) <
          1e-5 * (1.0 + std::abs(d.x.d[0]))); // third derivatives jump at points
    CHECK(std::abs(d.height.d[1] - (road.nearest(x, y + h).height - road.nearest(x, y - h).height) / (2.0 * h)) <
          1e-5 * (1.0 + std::abs(d.height.d[1])));
  }
}

TEST_CASE("without friction a wheel slides over hills and keeps its energy") {
  const std::string text =
      body("wheel", "mass = 400; inertia = 9; position = [0.0, 0.28]; velocity = [6.0, 0.0]; angular_velocity = 1.0") +
      element(
          "tyre", "tyre",
          "a = 'wheel'; radius = 0.3; stiffness = 2e5; friction = 0.0; slip_stiffness = 4e4; relaxation_length = 0.2; tread_damping = 300; "
          "road = [[0.0, 0.0], [2.0, 0.0], [4.0, 0.6], [6.0, 1.0], [8.0, 0.4], [12.0, 0.3]]");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-11, 3.0, 0.05});
    CHECK(r.result.statistics.energy_residual < 1e-7 * 7200.0);
    CHECK(r.last("wheel.omega") == 1.0); // a force through the centre turns nothing
    CHECK(r.last("wheel.x") > 8.0);
    CHECK(!r.event_times("tyre", "opens").empty()); // over the top it flies
  }
}

TEST_CASE("a wheel on a slope that is held against turning rests on its bristles") {
  const double slope = 0.2;
  const std::string text = wheel(0.0, 0.0) + tyre("b = { body = 'ground', point = [0.0, 0.0], angle = 0.2 }") + moved("turn", "angle", 0.0);
  Found found = settle(text);
  Run r{std::move(found.system), {}};
  r.result = simulate(*r.system, found.rest.state, options({"dop853", 1e-10, 20.0, 1.0}));
  for (std::size_t i = 0; i < r.times().size(); ++i) {
    CHECK(r.series("tyre.friction")[i] == doctest::Approx(k_mass * k_g * std::sin(slope)).epsilon(1e-8));
    CHECK(r.series("tyre.force")[i] == doctest::Approx(k_mass * k_g * std::cos(slope)).epsilon(1e-8));
  }
}

TEST_CASE("how far a wheel has come along a road grows as its centre goes along it, and as fast as it says") {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Vec2> points;
  for (int i = 0; i <= 20; ++i) points.emplace_back(0.5 * i + 0.1 * unit(generator), 0.12 * unit(generator));
  const Road road(points);
  const double radius = 0.6 / road.hollowest();
  REQUIRE(radius > 0.05);
  const SmoothCurve curve(points);
  for (int i = 0; i < 300; ++i) { // beyond the ends, too
    const double touched = 5.0 + 6.0 * unit(generator), grown = std::sqrt(1.0 + std::pow(curve.jet(touched).slope, 2));
    const Vec2 along = Vec2(1.0, curve.jet(touched).slope) / grown, normal(-along.y(), along.x());
    const Vec2 centre = Vec2(touched, curve.jet(touched).value) + radius * normal;
    const RoadWay<double> there = road.way(centre.x(), centre.y(), radius, touched);
    CHECK(std::abs(there.by_x - along.x()) < 1e-12);
    CHECK(std::abs(there.by_y - along.y()) < 1e-12);
    // Anywhere else, in the air and inside the road, by differences; third derivatives of the road jump at its points.
    const double x = centre.x(), y = centre.y() + 0.5 * unit(generator);
    constexpr double h = 1e-5;
    const RoadWay<Dual<2>> d = road.way(Dual<2>::variable(x, 0), Dual<2>::variable(y, 1), radius, x);
    const double by_x = (road.way(x + h, y, radius, x).value - road.way(x - h, y, radius, x).value) / (2.0 * h);
    CHECK(std::abs(d.value.d[0] - by_x) < 1e-4 * (1.0 + std::abs(by_x)));
    CHECK(std::abs(d.value.d[0] - road.way(x, y, radius, x).by_x) < 1e-12 * (1.0 + std::abs(by_x)));
    CHECK(std::abs(d.value.d[1] - road.way(x, y, radius, x).by_y) < 1e-12);
  }
}

namespace {

// On two wheels that are held by the frame, all brakes on; its front springs are the softer ones.
std::string braked(const std::string& road, double slope) {
  const auto axle = [&](const std::string& name, double along, double stiffness) {
    return element("tyre", name,
                   "a = { body = 'frame', point = [" + number(along) + ", -0.2] }; radius = 0.3; stiffness = " + number(stiffness) +
                       "; damping = 2e3; friction = 0.9; slip_stiffness = 4e4; relaxation_length = 0.2; tread_damping = 500; " + road);
  };
  return body("frame", "mass = 1000; inertia = 1500; position = [" + number(-0.48 * std::sin(slope)) + ", " +
                           number(0.48 * std::cos(slope)) + "]; angle = " + number(slope)) +
         axle("front", 1.2, 1e5) + axle("rear", -1.2, 3e5);
}

} // namespace

TEST_CASE("a slope that the road has by its points is one that its marker has: same rest, same treads, same vibrations") {
  constexpr double k_slope = 0.3;
  const double rise = 10.0 * std::tan(k_slope);
  const std::string roads[2] = {"b = { body = 'ground', point = [0.0, 0.0], angle = 0.3 }",
                                "road = [[-10.0, " + number(-rise) + "], [10.0, " + number(rise) + "]]"};
  State rest[2];
  Run r[2];
  for (int i = 0; i < 2; ++i) {
    Found found = settle(braked(roads[i], k_slope));
    rest[i] = found.rest.state;
    found.rest.state.v[3] = 0.01; // it swings on its springs and treads
    r[i].system = std::move(found.system);
    r[i].result = simulate(*r[i].system, found.rest.state, options({"dop853", 1e-11, 1.0, 0.1}));
  }
  for (std::size_t k = 3; k < 6; ++k) CHECK(std::abs(rest[0].q[k] - rest[1].q[k]) < 1e-9); // settled to 1e-10
  for (const char* channel : {"frame.x", "frame.y", "frame.theta"})
    for (std::size_t k = 0; k < r[0].times().size(); ++k) CHECK(std::abs(r[0].series(channel)[k] - r[1].series(channel)[k]) < 1e-8);
  for (const char* channel : {"front.friction", "rear.friction", "front.force", "rear.force"}) // 1e-9 m of 3e5 N/m
    for (std::size_t k = 0; k < r[0].times().size(); ++k) CHECK(std::abs(r[0].series(channel)[k] - r[1].series(channel)[k]) < 1e-3);
}

TEST_CASE("bristles never give back what they have dissipated, however fast the tread passes") {
  // 60 m/s where 4 C/b is 4 m/s: what shakes the wheel has the frequency at which bristles of b alone would drive it.
  const std::string text =
      body("wheel", "mass = 400; inertia = 9; position = [0.0, " + number(k_radius - k_mass * k_g / k_stiffness) +
                        "]; velocity = [60.0, 0.0]; angular_velocity = -200.0") +
      element("tyre", "tyre",
              "a = 'wheel'; radius = 0.3; stiffness = 2e5; friction = 5.0; slip_stiffness = 1e3; relaxation_length = 0.5; "
              "tread_damping = 1e3") +
      signal_entry("harmonics", "shake", "amplitudes = [300.0]; frequencies = [10.0]; phases = [-1.5707963]") +
      element("load", "shaker", "at = 'wheel'; torque = 'shake'") + "[output]\nalso = [\"*.dissipated\"]\n";
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-10, 1.0, 0.001});
    const std::vector<double> lost = r.series("tyre.dissipated");
    for (std::size_t i = 1; i < lost.size(); ++i) CHECK(lost[i] >= lost[i - 1] - 1e-7); // 1e-10 of the 7e5 J that roll, per step, and less
    CHECK(lost.back() > 0.1);
    CHECK(r.result.statistics.energy_residual < 1e-3);
  }
}

TEST_CASE("a wheel that gets fast and slow again dissipates all that its energy loses") {
  // Driven through 4 C/b = 8 m/s by some 7 m/s, and braked back through it, with slip.
  const std::string text =
      wheel(6.0, -20.0) +
      element("tyre", "tyre",
              "a = 'wheel'; radius = 0.3; stiffness = 2e5; friction = 0.8; slip_stiffness = 4e3; relaxation_length = 0.2; "
              "tread_damping = 2000") +
      signal_entry("harmonics", "turn", "amplitudes = [900.0]; frequencies = [0.25]; phases = [1.5707963]") +
      element("load", "engine", "at = 'wheel'; torque = 'turn'");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-11, 4.0, 0.05});
    double fastest = 0.0, slowest = 100.0;
    for (const double omega : r.series("wheel.omega")) {
      fastest = std::max(fastest, -0.3 * omega);
      slowest = std::min(slowest, -0.3 * omega);
    }
    CHECK(fastest > 8.5);
    CHECK(slowest < 7.5);
    CHECK(r.result.statistics.energy_residual < 1e-7 * r.result.statistics.energy_exchanged);
  }
}

TEST_CASE("rolling resistance brakes a wheel by what it takes, and holds it at rest") {
  // T from m v′ = −T, J ω′ = −r T + f N, and v = −r ω (1 + T/C) where the bristles have settled: constant.
  const double arm = 0.02, inertia = 9.0, speed = 2.0, couple = arm * k_mass * k_g;
  double force = couple / k_radius;
  for (int i = 0; i < 50; ++i)
    force =
        (couple * k_radius / inertia) * (1.0 + force / k_slip) / (1.0 / k_mass + k_radius * k_radius / inertia * (1.0 + force / k_slip));
  const std::string text = wheel(speed, -speed / k_radius / (1.0 + force / k_slip)) + tyre() +
                           element("rolling_resistance", "resistance", "contacts = ['tyre']; arm = 0.02");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-11, 20.0, 0.25});
    const double stops = speed * k_mass / force;
    REQUIRE(stops < 5.0);
    for (std::size_t i = 6; r.times()[i] < 0.8 * stops; ++i)
      CHECK(r.series("tyre.friction")[i] == doctest::Approx(-force).epsilon(1e-3)); // what is left of the start's swing
    CHECK(std::abs(r.event_times("resistance", "sticks")[0] - stops) < 0.05);
    CHECK(r.last("resistance.mode") == 1.0);
    CHECK(std::abs(r.last("wheel.omega")) < 1e-12);
    CHECK(std::abs(r.last("wheel.vx")) < 1e-3);
  }
}

TEST_CASE("what a tyre cannot be is said") {
  const auto refused = [](const std::string& text, const std::string& words) {
    CAPTURE(text);
    try {
      (void)compile(scene(body("wheel", "mass = 2; inertia = 1; position = [0.0, 0.3]") + text + "[simulation]\nstep = 1e-3\n"));
      FAIL("accepted");
    } catch (const ModelError& error) {
      CHECK(std::string(error.what()).find(words) != std::string::npos);
    }
  };
  refused(tyre("b = 'wheel'"), "rolls on its own body");
  refused(tyre("road = [[0.0, 0.0]]"), "at least two points");
  refused(tyre("road = [[0.0, 0.0], [1.0, 0.1], [1.0, 0.2]]"), "must increase from row to row: 1 m follows 1 m");
  refused(tyre("road = [[0.0, 0.5], [0.5, 0.0], [1.0, 0.5]]"), "would touch it twice");
  refused(
      element("tyre", "tyre", "a = 'wheel'; radius = 0.3; stiffness = 2e5; friction = 0.8; slip_stiffness = 4e4; relaxation_length = 0.2"),
      "tread_damping");
  refused(tyre() + element("coulomb_stick", "more", "contacts = ['tyre']; static_friction = 0.3"), "'tyre' is no unilateral_contact");
  refused(tyre() + element("rolling_resistance", "resistance", "contacts = ['tyre', 'tyre']; arm = 0.01"), "name one contact");
  refused(element("spring_damper", "spring", "a = 'wheel'; stiffness = 3.0") +
              element("rolling_resistance", "resistance", "contacts = ['spring']; arm = 0.01"),
          "'spring' does not roll");
}
