// Boxes and other convex outlines that press on each other: against closed forms, conservation, other ways to say the same.
#include "mbd/rest/assembly.h"
#include "mbd/rest/equilibrium.h"
#include "mbd/system/element_failure.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81;

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}
std::string point(double x, double y) { return "[" + number(x) + ", " + number(y) + "]"; }
std::string gravity(double angle) { return "gravity = " + point(k_g * std::sin(angle), -k_g * std::cos(angle)) + "\n"; }

struct Box {
  std::string name;
  double x = 0.0, y = 0.0, w = 1.0, h = 1.0, angle = 0.0, mass = 1000.0;
  std::string more;
};

std::string text_of(const Box& b) {
  return body(b.name, "mass = " + number(b.mass) + "; inertia = " + number(b.mass * (b.w * b.w + b.h * b.h) / 12.0) +
                          "; position = " + point(b.x, b.y) + "; angle = " + number(b.angle) + "; outline = [" +
                          point(-0.5 * b.w, -0.5 * b.h) + ", " + point(0.5 * b.w, -0.5 * b.h) + ", " + point(0.5 * b.w, 0.5 * b.h) + ", " +
                          point(-0.5 * b.w, 0.5 * b.h) + "]" + (b.more.empty() ? "" : "; " + b.more));
}

std::string touch(const std::string& a, const std::string& b, const std::string& more) {
  return element("polygon_contact", a + " on " + b, "a = \"" + a + "\"; b = \"" + b + "\"; " + more);
}

struct Found {
  std::unique_ptr<System> system;
  Equilibrium rest;
};

Found settle(const std::string& text) {
  const Model model = scene(text + "\n[simulation]\nstep = 1e-3\n");
  Found found{compile(model), {}};
  State start = assembled_start(*found.system, assemble(model, *found.system));
  std::fill(start.v.begin(), start.v.end(), 0.0);
  found.rest = find_equilibrium(*found.system, start);
  return found;
}

// As initial = "equilibrium" does: what begins without its contacts' forces begins with a blow.
Run run_from_rest(const std::string& text, const Settings& settings) {
  Found found = settle(text);
  Run r;
  r.system = std::move(found.system);
  r.result = simulate(*r.system, found.rest.state, options(settings));
  return r;
}

double largest_change(const Run& r, const std::vector<std::string>& channels) {
  double most = 0.0;
  for (const std::string& channel : channels) {
    const std::vector<double> values = r.series(channel);
    most = std::max(most, std::abs(values.back() - values.front()));
  }
  return most;
}

} // namespace

// The cell of the floor under the roof of a rectangle w × d is a trapezoid of height d/2 with the sides w and w − d:
// m g = 2 k ½ (w + w − d) d/2 = k d (w − d/2).
TEST_CASE("a box on the ground and a stack of boxes rest at the depths of the closed form") {
  const double k = 1e7, m = 1000.0, w = 1.5;
  const auto depth = [&](double load) { return w - std::sqrt(w * w - 2.0 * load / k); };
  std::string text;
  for (int i = 0; i < 3; ++i) {
    const std::string name = "b" + std::to_string(i);
    text += text_of({name, 0.01 * i, 0.25 + 0.5 * i, w, 0.5, 0.0, m, ""}) +
            touch(name, i == 0 ? "ground" : "b" + std::to_string(i - 1), "stiffness = 1e7; static_friction = 0.4");
  }
  const Found one = settle(text_of({"b", 0.0, 0.5, w, 0.5, 0.0, m, ""}) + touch("b", "ground", "stiffness = 1e7"));
  CHECK(std::abs(one.rest.state.q[4] - (0.25 - depth(m * k_g))) < 1e-11); // forces to 1e-9 of a depth of a millimetre, and less
  // Boxes of the stack stand 1 cm aside of each other: the uppermost is free of couples, its overlap ends in two sides of
  // different boxes, so that the roof's ends are the same and so is the force.
  const Found stack = settle(text);
  CHECK(std::abs(stack.rest.state.q[4] - (0.25 - depth(3.0 * m * k_g))) < 1e-4);
  CHECK(stack.rest.state.q[10] < stack.rest.state.q[7] + 0.5);
  CHECK(stack.rest.state.q[10] > stack.rest.state.q[7] + 0.5 - 2.0 * depth(m * k_g));
  for (int i = 1; i <= 3; ++i) CHECK(std::abs(stack.rest.state.q[3 * i + 2]) < 1e-3);
}

// Under small motion a face of width w is a bed of springs: k w across, k w³/12 in turning. Two feet of stiffness k w/2 at
// ±w/(2 √3) are the same, but for the share d/w by which the ends of the roof are lower.
TEST_CASE("a box on its face moves as on two feet made by hand") {
  const double k = 1e8, w = 1.0, m = 1000.0;
  const double foot = w / (2.0 * std::sqrt(3.0));
  const auto start = [&](double share) { return text_of({"box", 0.0, 0.5 - m * k_g / (k * w), w, 1.0, share * m * k_g / (k * w), m, ""}); };
  std::string feet;
  for (const double x : {-foot, foot})
    feet += element("unilateral_contact", x < 0.0 ? "left" : "right",
                    "a = { body = \"box\", point = " + point(x, -0.5) + " }; b = \"ground\"; stiffness = " + number(0.5 * k * w));
  const Settings settings{"dop853", 1e-10, 0.1, 1e-3};
  const Run one = run(start(0.3) + touch("box", "ground", "stiffness = 1e8"), settings), two = run(start(0.3) + feet, settings);
  const std::vector<double> p = one.series("box.theta"), q = two.series("box.theta");
  REQUIRE(p.size() == q.size());
  const double amplitude = 0.3 * m * k_g / (k * w);
  // ω = √(k w³/12/J) = 224 /s for 0.1 s: 22 rad of phase, of which d/w = 1e-4 is off at most; doubled for the second order.
  for (std::size_t i = 0; i < p.size(); ++i) CHECK(std::abs(p[i] - q[i]) < 2.0 * 22.0 * 1e-4 * amplitude);
  const double omega = std::sqrt(k * w * w * w / 12.0 / (m / 6.0));
  CHECK(std::abs(p.back() - amplitude * std::cos(omega * 0.1)) < 2.0 * 22.0 * 1e-4 * amplitude);
}

// On a slope of angle α a box of w × h stands up to tan α = w/h, and holds up to tan α = μ. Short of the first by a share ε it
// presses with a wedge of length ℓ = 3 ε w/2 at its toe and leans by 2 N/(k ℓ²): 4e-4 rad here, of the ε w/h that it may lean
// before it goes over, 1e-2.
TEST_CASE("on a slope a box tips at atan(w/h) and slides at atan μ, with the acceleration of the closed form") {
  const auto on_slope = [](double tangent, double mu) {
    return gravity(std::atan(tangent)) + text_of({"box", 0.0, 0.5, 0.4, 1.0, 0.0, 500.0, ""}) +
           touch("box", "ground", "stiffness = 1e11; dissipation = 20.0; static_friction = " + number(mu));
  };
  const Settings settings{"auto", 1e-7, 1.5};
  const Run stands = run_from_rest(on_slope(0.39, 2.0), settings), tips = run(on_slope(0.41, 2.0), settings);
  CHECK(std::abs(stands.last("box.theta")) < 1e-3);
  CHECK(std::abs(stands.last("box.omega")) < 1e-6);
  CHECK(tips.last("box.theta") < -0.05); // it goes over downhill
  const Run holds = run_from_rest(on_slope(0.195, 0.2), settings), slides = run(on_slope(0.205, 0.2), settings);
  CHECK(std::abs(holds.last("box.vx")) < 1e-9);
  // While it settles at the start the normal force is not m g cos α: over 2/(α_HC g), 10 ms, or some such.
  const double angle = std::atan(0.205), a = k_g * (std::sin(angle) - 0.2 * std::cos(angle));
  CHECK(slides.last("box.vx") == doctest::Approx(a * 1.5).epsilon(0.02));
  CHECK(slides.last("box on ground.mode") == 2.0);
}

TEST_CASE("equilibrium: friction of outlines that cannot hold is told, what can holds") {
  const auto on_slope = [](double tangent) {
    return gravity(std::atan(tangent)) + text_of({"box", 0.0, 0.5, 1.0, 1.0, 0.0, 500.0, ""}) +
           touch("box", "ground", "stiffness = 1e9; static_friction = 0.3");
  };
  const Found found = settle(on_slope(0.29));
  REQUIRE(found.rest.margins.size() == 1);
  CHECK(found.rest.margins[0].used == doctest::Approx(0.29 / 0.3).epsilon(1e-6));
  CHECK_THROWS_AS(settle(on_slope(0.31)), NumericalFailure);
}

// A box that slides to rest goes v²/(2 μ g).
TEST_CASE("the slide of outlines is the way along the face, with its sign") {
  const std::string text = "[output]\nalso = [\"b on ground.slide\"]\n" + text_of({"b", 0.0, 0.049, 1.0, 0.1, 0.0, 1000.0, ""}) +
                           touch("b", "ground", "stiffness = 1e7; dissipation = 0.5; static_friction = 0.4");
  for (const double v : {2.0, -1.5}) {
    CAPTURE(v);
    Found found = settle(text);
    found.rest.state.v[3] = v;
    Run r;
    r.system = std::move(found.system);
    r.result = simulate(*r.system, found.rest.state, options({"dop853", 1e-10, 1.5}));
    const double slid = r.last("b on ground.slide");
    // The box leans forward by μ h/2 of the 1 m of its face: the normal force swings by less than a thousandth, and so does the way.
    CHECK(slid == doctest::Approx(std::copysign(v * v / (2.0 * 0.4 * k_g), v)).epsilon(2e-3));
    // While it slides or is held, its lean is less than depth · 6 μ h/w² = 2.4e-4 rad, at half its height.
    CHECK(std::abs(slid - r.last("b.x")) < 2e-5);
  }
}

TEST_CASE("a box pushed past the edge of a table falls off it, one that is short of it stays") {
  const auto on_table = [](double x) {
    return body("table", "mass = 1; inertia = 1; fixed = true; outline = [[-2.0, -0.2], [0.0, -0.2], [0.0, 0.0], [-2.0, 0.0]]") +
           text_of({"box", x, 0.25, 0.8, 0.5, 0.0, 100.0, ""}) +
           touch("box", "table", "stiffness = 1e8; dissipation = 5.0; static_friction = 0.5");
  };
  const Settings settings{"auto", 1e-7, 2.0};
  const Run stays = run_from_rest(on_table(-0.02), settings), falls = run(on_table(0.02), settings);
  CHECK(std::abs(stays.last("box.y") - 0.25) < 1e-3);
  CHECK(std::abs(stays.last("box.omega")) < 1e-6);
  CHECK(falls.last("box.y") < -1.0);
  CHECK_FALSE(falls.event_times("box on table", "opens").empty());
  for (const Run* r : {&stays, &falls})
    CHECK(r->result.statistics.energy_residual < 1e-4 * std::max(1.0, r->result.statistics.energy_exchanged));
}

TEST_CASE("without dissipation energy is kept, and momentum without the ground: corners on faces, corners and edges") {
  // Three bodies fly into each other; a triangle, a box, a hexagon.
  std::string text = k_no_gravity;
  text += body("tri", "mass = 3; inertia = 0.1; position = [-1.0, 0.1]; velocity = [2.0, 0.1]; angular_velocity = 1.5; "
                      "outline = [[-0.2, -0.2], [0.4, -0.2], [-0.2, 0.4]]");
  text += body("box", "mass = 5; inertia = 0.3; position = [0.0, 0.0]; angular_velocity = -2.0; "
                      "outline = [[-0.3, -0.4], [0.3, -0.4], [0.3, 0.4], [-0.3, 0.4]]");
  text += body("hex", "mass = 4; inertia = 0.2; position = [1.1, -0.1]; velocity = [-2.5, 0.2]; "
                      "outline = [[0.3, 0.0], [0.15, 0.26], [-0.15, 0.26], [-0.3, 0.0], [-0.15, -0.26], [0.15, -0.26]]");
  for (const auto& [a, b] : {std::pair{"tri", "box"}, {"box", "hex"}, {"tri", "hex"}}) text += touch(a, b, "stiffness = 2e6");
  const double masses[] = {3.0, 5.0, 4.0}, inertias[] = {0.1, 0.3, 0.2};
  const auto momenta = [&](const std::vector<double>& q, const std::vector<double>& v) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      const double* const p = &q[3 * i + 3];
      const double* const u = &v[3 * i + 3];
      sum += Vec3(masses[i] * u[0], masses[i] * u[1], inertias[i] * u[2] + masses[i] * (p[0] * u[1] - p[1] * u[0]));
    }
    return sum;
  };
  for (const char* method : {"dop853", "rodas5p", "auto"}) {
    CAPTURE(std::string(method));
    const Run r = run(text, {method, 1e-9, 1.2});
    REQUIRE(r.result.events.size() >= 4); // two blows at least, and their ends
    const RunStatistics& s = r.result.statistics;
    CHECK(s.energy_residual < 1e-6 * s.energy_exchanged); // some hundred steps of 1e-9, some ten times that in one blow
    const State first = r.system->initial_state();
    const Vec3 before = momenta(first.q, first.v), after = momenta(r.result.final_state.q, r.result.final_state.v);
    CHECK((after - before).norm() < 1e-7); // forces are equal and opposite to rounding; places of application as exact as steps
  }
}

TEST_CASE("with friction and dissipation energy never grows") {
  std::string text = text_of({"box", 0.0, 1.0, 0.6, 0.3, 0.7, 50.0, "angular_velocity = 3.0; velocity = [2.0, 0.0]"}) +
                     touch("box", "ground", "stiffness = 1e7; dissipation = 2.0; static_friction = 0.5; kinetic_friction = 0.3");
  const Run r = run(text, {"auto", 1e-8, 5.0, 1e-3});
  const std::vector<double> x = r.series("box.vx"), y = r.series("box.vy"), w = r.series("box.omega"), at = r.series("box.y");
  double lowest = 1e300;
  // Stored in the contact is not counted here: it comes back as motion, but never beyond what was before.
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double energy = 25.0 * (x[i] * x[i] + y[i] * y[i]) + 0.5 * 50.0 * 0.45 / 12.0 * w[i] * w[i] + 50.0 * k_g * at[i];
    if (r.series("box on ground.force")[i] == 0.0) {
      CHECK(energy < lowest + 1e-4 * 700.0); // of the energy at the start; steps of 1e-8
      lowest = std::min(lowest, energy);
    }
  }
  CHECK(r.result.statistics.energy_residual < 1e-6 * r.result.statistics.energy_exchanged);
  CHECK(std::abs(r.last("box.omega")) < 1e-3);
  CHECK(std::abs(std::remainder(r.last("box.theta"), 1.57079632679489662)) < 1e-3); // on one of its faces
}

TEST_CASE("the same scene turned by any angle moves the same way, and with a and b exchanged too") {
  const auto at = [](double angle, bool is_swapped) {
    const auto place = [angle](double x, double y) {
      return point(std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y);
    };
    std::string text = "gravity = " + place(0.0, -k_g) + "\n";
    text += body("lower", "mass = 50; inertia = 2.0; position = " + place(0.0, 0.2) + "; angle = " + number(angle) +
                              "; outline = [[-0.4, -0.2], [0.4, -0.2], [0.3, 0.2], [-0.3, 0.2]]");
    text += body("upper", "mass = 20; inertia = 0.5; position = " + place(0.15, 0.75) + "; velocity = " + place(0.5, 0.0) +
                              "; angle = " + number(angle + 0.2) + "; outline = [[-0.3, -0.2], [0.3, -0.2], [0.0, 0.3]]");
    const std::string law = "stiffness = 1e7; dissipation = 2.0; static_friction = 0.4";
    text += element("polygon_contact", "floor", "a = \"lower\"; normal = " + place(0.0, 1.0) + "; " + law);
    text += element("polygon_contact", "ground", "a = \"upper\"; normal = " + place(0.0, 1.0) + "; " + law);
    text += element("polygon_contact", "seat", (is_swapped ? "a = \"lower\"; b = \"upper\"; " : "a = \"upper\"; b = \"lower\"; ") + law);
    return text;
  };
  const Settings settings{"dop853", 1e-10, 0.4};
  const auto end = [&](double angle, bool is_swapped) {
    const Run r = run(at(angle, is_swapped), settings);
    const Vec2 p = rotated(Vec2(r.last("upper.x"), r.last("upper.y")), -angle);
    return Vec3(p.x(), p.y(), r.last("upper.theta") - angle);
  };
  const Vec3 straight = end(0.0, false);
  // A blow or two turn a tolerance into some thousand.
  for (const double angle : {0.7, -2.5}) CHECK((end(angle, false) - straight).norm() < 1e-6);
  CHECK((end(0.0, true) - straight).norm() < 1e-6);
}

// Contacts that share their bodies and the outline of a place it once: the force of each must not depend on which contact comes before it.
TEST_CASE("forces of contacts between the same bodies are the same in every order") {
  const std::string bodies = body("block", "mass = 1.0; inertia = 1.0; velocity = [0.1, -0.2]; angular_velocity = 0.3");
  const auto contact = [](const std::string& name, double x_a, double x_b) {
    const auto square = [](double x) {
      return "[" + point(x - 0.1, -0.1) + ", " + point(x + 0.1, -0.1) + ", " + point(x + 0.1, 0.1) + ", " + point(x - 0.1, 0.1) + "]";
    };
    return element("polygon_contact", name,
                   "a = { body = 'block', point = [0.0, 0.0] }; b = { body = 'ground', at = [0.0, -0.19] }; outline_a = " + square(x_a) +
                       "; outline_b = " + square(x_b) + "; stiffness = 1e6; dissipation = 2.0");
  };
  const std::vector<std::string> names = {"left", "left again", "right"};
  const std::vector<std::string> texts = {contact(names[0], -0.5, -0.45), contact(names[1], -0.5, -0.52), contact(names[2], 0.5, 0.47)};
  std::vector<std::size_t> order = {0, 1, 2};
  std::vector<double> first;
  do {
    std::string text = k_no_gravity + bodies;
    for (const std::size_t i : order) text += texts[i];
    const Run r = run(scene(text + "[simulation]\nstep = 1e-6\n"), {"rk4", 1e-6, 1e-6});
    std::vector<double> forces;
    for (const std::string& name : names) forces.push_back(r.series(name + ".force").front());
    if (first.empty()) first = forces;
    for (std::size_t i = 0; i < names.size(); ++i) {
      CHECK(forces[i] > 0.0);
      CHECK(forces[i] == first[i]); // to the bit
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("a corner that falls exactly on a corner, and edges exactly on edges") {
  const std::string diamond = "outline = [[0.0, -0.2], [0.2, 0.0], [0.0, 0.2], [-0.2, 0.0]]";
  const std::string text = body("anvil", "mass = 1; inertia = 1; fixed = true; " + diamond) +
                           body("drop", "mass = 10; inertia = 0.2; position = [0.0, 0.6]; " + diamond) +
                           touch("drop", "anvil", "stiffness = 1e7");
  const double fall = std::sqrt(2.0 * 0.2 / k_g);
  const Run r = run(text, {"dop853", 1e-10, 2.0 * fall + 0.01});
  REQUIRE(r.event_times("drop on anvil").size() >= 2);
  CHECK(std::abs(r.event_times("drop on anvil", "closes")[0] - fall) < 1e-8);
  CHECK(r.last("drop.x") == doctest::Approx(0.0)); // no side is the right one: it goes up again as it came
  CHECK(r.result.statistics.energy_residual < 1e-6);
  // Boxes of one width, stacked flush.
  std::string flush;
  for (int i = 0; i < 3; ++i)
    flush += text_of({"b" + std::to_string(i), 0.0, 0.25 + 0.5 * i, 1.0, 0.5, 0.0, 500.0, ""}) +
             touch("b" + std::to_string(i), i == 0 ? "ground" : "b" + std::to_string(i - 1),
                   "stiffness = 1e9; dissipation = 10; static_friction = 0.4");
  const Run stack = run(flush, {"auto", 1e-7, 5.0, 1.0});
  for (int i = 0; i < 3; ++i) CHECK(std::abs(stack.last("b" + std::to_string(i) + ".x")) < 1e-6);
  CHECK(std::abs(stack.last("b2.vy")) < 1e-6);
}

// ½ m v² = 5000 J against ½ k L d² = 10 kJ for the whole plate: it cannot go through, and comes back with what it had.
TEST_CASE("a fast box is not through a thin plate before anyone looks") {
  for (const char* method : {"dop853", "rodas5p", "auto"})
    for (const double tolerance : {1e-9, 1e-6, 1e-4}) {
      CAPTURE(std::string(method));
      CAPTURE(tolerance);
      const std::string text =
          k_no_gravity +
          body("plate", "mass = 1; inertia = 1; fixed = true; outline = [[0.0, -1.0], [0.001, -1.0], [0.001, 1.0], [0.0, 1.0]]") +
          text_of({"bullet", -7.0, 0.0, 0.02, 0.02, 0.0, 0.01, "velocity = [1000.0, 0.0]"}) + touch("bullet", "plate", "stiffness = 1e12");
      const Run r = run(text, {method, tolerance, 0.0135});
      CHECK(r.event_times("bullet on plate", "closes").size() == 1);
      CHECK(std::abs(r.last("bullet.vx") + 1000.0) < 1000.0 * std::max(1e-6, 1e3 * tolerance));
    }
}

// Time stepping locates no events: steps that would carry a contact from one side to the other are divided.
TEST_CASE("time stepping does not pass through what is thinner than a step goes") {
  for (const double from : {-7.0, -7.05, -7.03}) {
    const std::string text =
        k_no_gravity + body("ball", "mass = 0.01; inertia = 1e-6; position = " + point(from, 0.0) + "; velocity = [1000.0, 0.0]") +
        element("segment_contact", "plate", "a = \"ball\"; from = [0.0, -1.0]; to = [0.0, 1.0]; thickness = 0.002; stiffness = 3e10");
    const Model model = scene(text + "\n[simulation]\nstep = 1e-4\n");
    Run r;
    r.system = compile(model);
    SimulationOptions o;
    o.end = o.output_step = 0.01;
    o.integrator = "moreau";
    o.settings.step = 1e-4;
    r.result = simulate(*r.system, r.system->initial_state(), o);
    CHECK(r.last("ball.x") < 0.0); // implicit steps take out most of the blow's energy: it stays in front, or comes back
  }
}

// Half bricks at the ends of every other row, 1 mm apart.
TEST_CASE("a wall of bricks rests for an hour without creep") {
  std::string text;
  std::vector<std::string> places;
  std::vector<std::vector<Box>> rows(4);
  for (int r = 0; r < 4; ++r) {
    const std::vector<double> cuts = r % 2 == 0 ? std::vector{0.0, 0.25, 0.5, 0.75} : std::vector{0.0, 0.125, 0.375, 0.625, 0.75};
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double w = cuts[i + 1] - cuts[i];
      rows[r].push_back(
          {"r" + std::to_string(r) + "c" + std::to_string(i), cuts[i] + 0.5 * w, 0.035 + 0.07 * r, w - 0.001, 0.07, 0.0, 140.0 * w, ""});
    }
    for (const Box& brick : rows[r]) {
      text += text_of(brick);
      for (const char* c : {".x", ".y", ".theta"}) places.push_back(brick.name + c);
      const std::string law = "stiffness = 1e10; dissipation = 10.0; static_friction = 0.5";
      if (r == 0) text += touch(brick.name, "ground", law);
      else
        for (const Box& below : rows[r - 1])
          if (std::abs(below.x - brick.x) < 0.5 * (below.w + brick.w)) text += touch(brick.name, below.name, law);
    }
  }
  const Run r = run_from_rest(text, {"auto", 1e-6, 3600.0, 3600.0});
  CHECK(r.result.events.empty());
  CHECK(largest_change(r, places) < 1e-10); // constraints are kept to 1e-12 m
}

namespace {

// Corners on a circle, in order, with the centre inside; thin ones and blunt ones.
std::vector<Vec2> random_outline(std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const int n = 3 + static_cast<int>(5.0 * unit(generator));
  const double flat = 0.3 + 0.7 * unit(generator), size = 0.15 + 0.2 * unit(generator), turn = 6.28 * unit(generator);
  std::vector<Vec2> corners;
  for (int i = 0; i < n; ++i) {
    const double angle = turn + 6.283185307179586 * (i + 0.4 * unit(generator)) / n;
    corners.emplace_back(size * std::cos(angle), flat * size * std::sin(angle));
  }
  return corners;
}

// Of a homogeneous plate: area, middle, second moment about it.
struct Plate {
  double area = 0.0, moment = 0.0;
  Vec2 middle = Vec2::Zero();
};

Plate plate_of(const std::vector<Vec2>& corners) {
  Plate plate;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 &p = corners[i], &q = corners[(i + 1) % corners.size()];
    const double c = cross(p, q);
    plate.area += 0.5 * c;
    plate.middle += c / 6.0 * (p + q);
    plate.moment += c / 12.0 * (p.dot(p) + p.dot(q) + q.dot(q));
  }
  plate.middle /= plate.area;
  plate.moment -= plate.area * plate.middle.dot(plate.middle);
  return plate;
}

std::string random_pile(unsigned seed, int count) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::string text = table_text("marker", "name = \"left\"\n", "body = \"ground\"; at = [-0.8, 0.0]") +
                     table_text("marker", "name = \"right\"\n", "body = \"ground\"; at = [0.8, 0.0]");
  const std::string law = "stiffness = 1e9; dissipation = " + number(8.0 * unit(generator) + 1.0) +
                          "; static_friction = " + number(unit(generator)) + "; kinetic_friction = 0.0";
  for (int i = 0; i < count; ++i) {
    const std::string name = "p" + std::to_string(i);
    const std::vector<Vec2> corners = random_outline(generator);
    const Plate plate = plate_of(corners);
    std::string outline;
    for (const Vec2& p : corners) outline += (outline.empty() ? "" : ", ") + point(p.x(), p.y());
    text += body(name, "mass = " + number(2000.0 * plate.area) + "; inertia = " + number(2000.0 * plate.moment) +
                           "; cg = " + point(plate.middle.x(), plate.middle.y()) +
                           "; position = " + point(i % 2 == 0 ? -0.36 : 0.36, 0.4 + 0.75 * (i / 2)) +
                           "; velocity = " + point(4.0 * unit(generator) - 2.0, 0.0) +
                           "; angular_velocity = " + number(10.0 * unit(generator) - 5.0) + "; outline = [" + outline + "]");
    text += touch(name, "ground", law) + touch(name, "left", law + "; normal = [1.0, 0.0]") +
            touch(name, "right", law + "; normal = [-1.0, 0.0]");
    for (int k = 0; k < i; ++k) text += touch(name, "p" + std::to_string(k), law);
  }
  return text;
}

} // namespace

TEST_CASE("outlines of all kinds dropped at random: energy never grows, nothing goes through anything") {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const Model model = scene(random_pile(seed, 4) + "\n[simulation]\nstep = 1e-3\n");
    const auto system = compile(model);
    SimulationOptions o = options({"auto", 1e-6, 1.2});
    o.has_extremes = true;
    Simulation simulation(*system, system->initial_state(), o);
    std::vector<Motion<double>> motion;
    double least = std::numeric_limits<double>::infinity(), first = 0.0;
    while (simulation.advance()) {
      const State state = simulation.current_state();
      place_bodies(state.q, state.v, motion);
      const double energy = system->kinetic_energy(state) + system->potential_energy(motion.data());
      if (first == 0.0) first = energy;
      CHECK(energy < least + 1e-5 * first); // each of some thousand steps may be off by 1e-6 of what it turns over, a share of this
      least = std::min(least, energy);
    }
    const RunResult result = std::move(simulation).result();
    CHECK(result.statistics.energy_residual < 1e-5 * first);
    for (const ChannelRange& range : result.ranges)
      if (range.channel->name.ends_with(".gap")) CHECK(range.low.value > -0.02); // ½ m v² = k d³/3 for 200 kg at 5 m/s: 2 cm
  }
}

TEST_CASE("outlines that are none are refused") {
  const auto error = [](const std::string& outline) -> std::string {
    try {
      (void)run(body("a", "mass = 1; inertia = 1; outline = " + outline) + touch("a", "ground", "stiffness = 1e6"), {"dop853", 1e-6, 0.1});
    } catch (const ModelError& e) {
      return e.what();
    }
    return "";
  };
  const auto has = [](const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; };
  CHECK(has(error("[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]"), "has no area"));
  CHECK(has(error("[[0.0, 0.0], [1.0, 0.0]]"), "has no area"));
  CHECK(has(error("[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]]"), "is not convex at [1, 0.5]"));
  CHECK(has(error("[[0.0, 1.0], [0.588, -0.809], [-0.951, 0.309], [0.951, 0.309], [-0.588, -0.809]]"), "crosses itself"));
  CHECK(has(error("[]"), "has no outline"));
  CHECK(has(error("[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]"), "scene.toml:"));
  CHECK(error("[[0.0, 0.0], [0.0, 1.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.5], [1.0, 0.0]]").empty()); // clockwise, repeated, straight
}

// It presses 5 cm deep and turns at 3.5 rad/s as the hold passes from a corner to the middle of an edge, which moves by 3 cm/s
// where the corner rested. That is taken by what friction bears, not by a blow.
TEST_CASE("friction that passes to another place of a body that turns takes what moves there by its force alone") {
  const double inertia = 0.08717434, friction = 0.2865161, reach = 0.61, step = 1e-5;
  const Run r = run("gravity = [0.0, -9.81]\n" +
                        body("b", "mass = 0.5954125; inertia = " + number(inertia) +
                                      "; position = [-12.1, 1.024608]; velocity = [-2.953353, 0.0]; "
                                      "outline = [[0.573, 0.194], [-0.199, 0.572], [-0.604, 0.0311], [-0.268, -0.542], [0.201, -0.571]]") +
                        touch("b", "ground", "stiffness = 3989.479; static_friction = " + number(friction)),
                    {"dop853", 1e-10, 0.365, step});
  const std::vector<double> omega = r.series("b.omega"), force = r.series("b on ground.force");
  const std::vector<double> changes = r.event_times("b on ground", "changes foot");
  REQUIRE(changes.size() >= 2);
  CHECK(std::abs(changes.back() - 0.3609) < 1e-4);
  for (std::size_t i = 1; i < omega.size(); ++i) {
    const double most = 1.1 * std::max(force[i], force[i - 1]); // the force changes little in a step
    REQUIRE(std::abs(omega[i] - omega[i - 1]) <= most * (1.0 + friction) * reach / inertia * step + 1e-9);
  }
}

// Without weight a box that comes at a speed v upon an elastic floor leaves it with v: energy. A method whose step takes it from above the
// floor to below, where no part of the floor's edge is within it, must not take the silence there for a step without an error.
TEST_CASE("a thin box that falls fast comes back from the floor, by every method and at every tolerance") {
  for (const char* method : {"dop853", "tsit5", "rodas5p"})
    for (const double tolerance : {1e-3, 1e-4, 1e-6, 1e-8})
      for (const double speed : {0.5, 5.0, 50.0})
        for (const double angle : {0.0, 0.3}) {
          const std::string text = "gravity = [0.0, 0.0]\n" +
                                   text_of({"box", 0.0, 2.0, 0.5, 0.1, angle, 100.0, "velocity = " + point(0.0, -speed)}) +
                                   touch("box", "ground", "stiffness = 1e9");
          CAPTURE(method);
          CAPTURE(tolerance);
          CAPTURE(speed);
          CAPTURE(angle);
          const Run r = run(text, {method, tolerance, 8.0 / speed});
          CHECK(r.event_times("box on ground", "closes").size() >= 1);
          const double vy = r.last("box.vy"), omega = r.last("box.omega"), inertia = 100.0 * (0.25 + 0.01) / 12.0;
          const double energy = 50.0 * vy * vy + 0.5 * inertia * omega * omega, before = 50.0 * speed * speed;
          CHECK(r.last("box.y") > 0.0);
          CHECK(vy > -speed);
          // A contact takes up to some fifty steps, whose errors may add up; velocities off by the tolerance are twice that of the energy.
          CHECK(std::abs(energy - before) < 100.0 * tolerance * before);
        }
}

TEST_CASE("what lies wholly within the other feels nothing: a run says so and goes no further") {
  const auto refusal = [](const std::string& text, const char* method) -> std::string {
    try {
      const Run r = run(text, {method, 1e-6, 1.0});
      return "it came to y = " + number(r.last("box.y"));
    } catch (const ElementFailure& failure) {
      return failure.what();
    } catch (const NumericalFailure& failure) {
      return failure.what();
    }
  };
  for (const char* method : {"dop853", "tsit5", "rodas5p", "auto"}) {
    CAPTURE(method);
    // ½ m v² is a hundred times what the floor can take, 2 k ∫ d dA over the box.
    const std::string soft =
        text_of({"box", 0.0, 1.0, 0.5, 0.1, 0.1, 1000.0, "velocity = [0.0, -10.0]"}) + touch("box", "ground", "stiffness = 1e6");
    CHECK(refusal(soft, method).find("one body of 'box on ground' lies wholly within the other, where nothing pushes it out") !=
          std::string::npos);
    const std::string below = text_of({"box", 0.0, -1.0, 0.5, 0.1, 0.1, 1000.0, ""}) + touch("box", "ground", "stiffness = 1e9");
    CHECK(refusal(below, method).find("place them apart, or touching") != std::string::npos);
    const std::string stone = text_of({"box", 0.0, 1.0, 0.1, 0.1, 0.0, 10.0, ""}) +
                              text_of({"block", 0.0, 1.0, 1.0, 1.0, 0.0, 1000.0, ""}) + touch("box", "block", "stiffness = 1e9");
    CHECK(refusal(stone, method).find("'box on block' lies wholly within the other") != std::string::npos);
  }
}

// A box that friction holds at a sideways pull a leans on its contact, whose stiffness against turning is k w³/12 less m g h of the weight,
// and stays where it stood: θ = −m a h/(k w³/12 − m g h), x = −h θ. On the way the search rocks it from corner to corner.
TEST_CASE("a box rests where it stood, however it is pulled within its friction") {
  const double k = 2e8, m = 1e4, h = 1.0, w = 2.0;
  for (const double pull : {0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.28}) {
    CAPTURE(pull);
    double place[2] = {};
    for (const int side : {0, 1}) {
      const double a = (side == 0 ? pull : -pull) * k_g;
      const Found found = settle("gravity = " + point(a, -k_g) + "\n" + text_of({"b", 0.0, h, w, 2.0 * h, 0.0, m, ""}) +
                                 touch("b", "ground", "stiffness = " + number(k) + "; static_friction = 0.3"));
      const double turned = -m * a * h / (k * w * w * w / 12.0 - m * k_g * h);
      place[side] = found.rest.state.q[3];
      CHECK(std::abs(found.rest.state.q[5] - turned) <= 1e-3 * std::abs(turned) + 1e-12); // the depth is 1e-4 of the width
      CHECK(std::abs(place[side] + h * turned) <= 1e-3 * h * std::abs(turned) + 1e-12);
      CHECK(found.rest.slid.empty());
    }
    CHECK(std::abs(place[0] + place[1]) < 1e-12);
  }
}

// Cells at the ends of a contact that is 1e-7 of its width deep are triangles of 1e-14 of its square. Summed about a distant origin their
// energy was off by 1e-7 J, more than the energy guard permits of a box at rest.
TEST_CASE("a box at rest on a stiff slope keeps its energy") {
  for (const double k : {1e9, 1e10, 1e11})
    for (const double slope : {-0.19, -0.05, 0.0, 0.11, 0.24}) {
      CAPTURE(k);
      CAPTURE(slope);
      const double w = 2.1, h = 1.8, c = std::cos(slope), s = std::sin(slope);
      const Run r = run_from_rest(text_of({"b", -0.5 * s * h, 0.5 * c * h, w, h, slope, 50.0, ""}) +
                                      "[[marker]]\nname = \"plane\"\nbody = \"ground\"\nat = [0, 0]\nangle = " + number(slope) + "\n" +
                                      touch("b", "plane", "stiffness = " + number(k) + "; dissipation = 1.0; static_friction = 0.4"),
                                  {"tsit5", 1e-9, 0.05, 0.0});
      // The weight of 490 N moves by no more than the rounding of places, 1e-15 m; k A d of the contact rounds like k w d times that.
      CHECK(r.result.statistics.energy_residual < 1e-10);
      CHECK(r.result.statistics.energy_worst_step < 1.0);
    }
}
