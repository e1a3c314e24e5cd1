// Static equilibrium and assembly: closed forms, contacts to be fallen upon, poses that would run away,
// joints that cannot be met.
#include "mbd/rest/assembly.h"
#include "mbd/rest/equilibrium.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

const std::string k_head = "[simulation]\nstep = 1e-3\n";

Equilibrium settle(const Model& model) {
  const auto system = compile(model);
  return find_equilibrium(*system, system->initial_state());
}

} // namespace

TEST_CASE("a mass dropped on two contacts settles where they carry its weight") {
  const Model model = scene(k_head + body("block", "mass = 1000; inertia = 100; position = [0.2, 1.3]") +
                            element("unilateral_contact", "left",
                                    "a = { body = 'block', point = [-0.5, -0.5] }; stiffness = 1e6; "
                                    "damping = 1e4") +
                            element("unilateral_contact", "right",
                                    "a = { body = 'block', point = [0.5, -0.5] }; stiffness = 1e6; "
                                    "damping = 1e4"));
  const Equilibrium rest = settle(model);
  // Both springs at m g / 2k = 4.905 mm; 1e-9 m/s² left over k/m = 2000 /s² is 5e-13 m.
  CHECK(std::abs(rest.state.q[4] - (0.5 - 1000 * 9.81 / 2e6)) < 1e-12);
  CHECK(std::abs(rest.state.q[5]) < 1e-12);
  CHECK(rest.residual < 1e-9);
}

TEST_CASE("a pendulum given upside down does not rest there") {
  const std::string pin = element("revolute", "pin", "a = { body = 'bob', at = [0.0, 0.0] }");
  for (const char* place : {"[0.0, 1.0]", "[0.6, 0.8]", "[1.0, 0.0]"}) {
    CAPTURE(place);
    const Equilibrium rest = settle(scene(k_head + body("bob", std::string("mass = 2; inertia = 0.1; position = ") + place) + pin));
    CHECK(std::abs(rest.state.q[3]) < 1e-9); // 1e-9 m/s² over g/L
    CHECK(std::abs(rest.state.q[4] + 1.0) < 1e-12);
  }
}

TEST_CASE("what nothing holds has no equilibrium, and the body is named") {
  const Model model = scene(k_head + "[[body]]\nname = \"stone\"\nmass = 1\ninertia = 1\n");
  const auto system = compile(model);
  CHECK_THROWS_WITH_AS((void)find_equilibrium(*system, system->initial_state()),
                       "no static equilibrium: 'stone' along -y moves without end: nothing holds it against the 9.81 N that drive it",
                       NumericalFailure);
}

TEST_CASE("poses given roughly are moved onto the joints, no further than needed") {
  const Model model =
      scene(k_head + body("bob", "mass = 2; inertia = 0.1; position = [1.1, 0.0]") + element("distance", "rod", "a = 'bob'; length = 1.0"));
  const auto system = compile(model);
  const State state = assemble(model, *system);
  // The least motion is along the rod; the projection tolerance is 1e-12 m.
  CHECK(std::abs(state.q[3] - 1.0) < 1e-12);
  CHECK(state.q[4] == 0.0);
  CHECK(state.q[5] == 0.0);
}

// Two rods of 1 m with their pins off by centimetres and their speeds wrong: the joints are met, the motion is
// mass-weighted (the heavy rod hardly moves), and what was met already is not touched.
TEST_CASE("rough poses and velocities are assembled, and each body's move is told") {
  const Model model =
      scene(k_head + body("heavy", "mass = 1000; inertia = 80; position = [0.53, 0.02]; angle = 0.05; velocity = [0.0, 0.3]") +
            body("light", "mass = 1; inertia = 0.08; position = [1.46, -0.03]; angle = -0.04; velocity = [0.2, 0.5]") +
            body("apart", "mass = 1; inertia = 0.1; position = [5.0, 0.0]") +
            element("revolute", "wall", "a = { body = 'heavy', point = [-0.5, 0.0] }") +
            element("revolute", "elbow",
                    "a = { body = 'light', point = [-0.5, 0.0] }; "
                    "b = { body = 'heavy', point = [0.5, 0.0] }"));
  const auto system = compile(model);
  const State given = system->initial_state(), state = assemble(model, *system);
  const auto pin = [&](const State& s, int body, double side) {
    const double* q = &s.q[3 * body];
    return Vec2(Vec2(q[0], q[1]) + 0.5 * side * Vec2(std::cos(q[2]), std::sin(q[2])));
  };
  CHECK(pin(state, 1, -1.0).norm() < 1e-12);
  CHECK((pin(state, 2, -1.0) - pin(state, 1, 1.0)).norm() < 1e-12);
  // Speeds: both rods turn about their pins, q̇ = ω ẑ×r, J q̇ = 0 to rounding.
  CHECK(std::abs(state.v[3] + state.v[5] * state.q[4]) < 1e-12);
  CHECK(std::abs(state.v[4] - state.v[5] * state.q[3]) < 1e-12);
  const auto moves = assembly_moves(given, state);
  REQUIRE(moves.size() == 2);
  for (const AssemblyMove& move : moves) {
    const double* from = &given.q[3 * move.body];
    const double* to = &state.q[3 * move.body];
    CHECK(move.shift == doctest::Approx(std::hypot(to[0] - from[0], to[1] - from[1])));
    CHECK(move.shift < 0.1);
    CHECK(move.velocity > 0.0);
  }
  // Mass-weighted: the heavy rod meets its own pin as if the light one were not there, but for the ratio of
  // their masses, 1e-3, times the distances moved, 0.1 m.
  const Model alone_model = scene(k_head + body("heavy", "mass = 1000; inertia = 80; position = [0.53, 0.02]; angle = 0.05") +
                                  element("revolute", "wall", "a = { body = 'heavy', point = [-0.5, 0.0] }"));
  const auto alone_system = compile(alone_model);
  const State alone = assemble(alone_model, *alone_system);
  for (int k = 3; k < 6; ++k) CHECK(std::abs(state.q[k] - alone.q[k]) < 1e-3);
}

// Nearest to (x0, y0) on a circle round the origin is the point in that direction, however far it is off.
TEST_CASE("a bob far off its rod is put on the circle at the nearest point") {
  for (const Vec2& given : {Vec2(1.3, 0.9), Vec2(0.1, -0.35), Vec2(-2.5, 1.5)}) {
    const Model model =
        scene(k_head + "[[body]]\nname = \"bob\"\nmass = 2\ninertia = 0.1\nposition = [" + std::to_string(given.x()) + ", " +
              std::to_string(given.y()) + "]\n[[element]]\nkind = \"distance\"\nname = \"rod\"\na = \"bob\"\nlength = 1.0\n");
    const auto system = compile(model);
    const State state = assemble(model, *system);
    CHECK((Vec2(state.q[3], state.q[4]) - given.normalized()).norm() < 1e-11);
    CHECK(state.q[5] == 0.0);
  }
}

// With φ₁, φ₂ the angles of two pinned rods all poses on the joints are known; the distance to the given ones,
// ½ Σ m |c − c₀|² + J (φ − φ₀)², is stationary where its derivatives by both angles vanish, and least where its
// second derivatives are positive.
TEST_CASE("two rods off by decimetres are put together where no small motion leads nearer") {
  const double mass[2] = {3.0, 1.0}, inertia[2] = {0.25, 0.08};
  const double rough[][6] = {{0.7, 0.3, 0.2, 1.2, -0.4, -0.5}, {0.3, -0.6, -0.4, 0.5, -1.9, -1.6}, {-0.2, 0.9, 1.2, 0.6, 1.4, 0.1}};
  for (const auto& given : rough) {
    std::string text = k_head;
    for (int i : {0, 1}) {
      const double* q = given + 3 * i;
      text += std::string("[[body]]\nname = \"") + (i == 0 ? "first" : "second") + "\"\nmass = " + std::to_string(mass[i]) +
              "\ninertia = " + std::to_string(inertia[i]) + "\nposition = [" + std::to_string(q[0]) + ", " + std::to_string(q[1]) +
              "]\nangle = " + std::to_string(q[2]) + "\n";
    }
    const Model model = scene(text + element("revolute", "wall", "a = { body = 'first', point = [-0.5, 0.0] }") +
                              element("revolute", "elbow",
                                      "a = { body = 'second', point = [-0.5, 0.0] }; "
                                      "b = { body = 'first', point = [0.5, 0.0] }"));
    const auto system = compile(model);
    const State state = assemble(model, *system);
    const double *p = &state.q[3], *q = &state.q[6];
    const Vec2 e1(std::cos(p[2]), std::sin(p[2])), e2(std::cos(q[2]), std::sin(q[2]));
    // Each of four rows is met to the projection's tolerance, 1e-12 m; the second pin's place adds up two joints.
    CHECK((Vec2(p[0], p[1]) - 0.5 * e1).norm() < 2e-12);
    CHECK((Vec2(q[0], q[1]) - e1 - 0.5 * e2).norm() < 4e-12);
    const Vec2 off1 = Vec2(p[0] - given[0], p[1] - given[1]), off2 = Vec2(q[0] - given[3], q[1] - given[4]);
    const Vec2 n1(-e1.y(), e1.x()), n2(-e2.y(), e2.x());
    // 1e-12 of the way moved is left, decimetres at most; a kilogram and a metre.
    CHECK(std::abs(mass[0] * off1.dot(0.5 * n1) + mass[1] * off2.dot(n1) + inertia[0] * (p[2] - given[2])) < 1e-11);
    CHECK(std::abs(mass[1] * off2.dot(0.5 * n2) + inertia[1] * (q[2] - given[5])) < 1e-11);
    const double a = 0.25 * mass[0] + mass[1] + inertia[0] - mass[0] * off1.dot(0.5 * e1) - mass[1] * off2.dot(e1);
    const double b = 0.25 * mass[1] + inertia[1] - mass[1] * off2.dot(0.5 * e2);
    const double c = 0.5 * mass[1] * n1.dot(n2);
    CHECK(a > 0.0);
    CHECK(a * b - c * c > 0.0);
  }
}

TEST_CASE("joints that no motion meets are an error at the joint") {
  const Model model = scene(k_head + body("bob", "mass = 2; inertia = 0.1; position = [1.0, 0.0]") +
                            element("distance", "left rod", "a = 'bob'; length = 1.0") +
                            element("distance", "right rod", "a = 'bob'; b = { body = 'ground', at = [5.0, 0.0] }; length = 1.0"));
  const auto system = compile(model);
  try {
    (void)assemble(model, *system);
    FAIL("was assembled");
  } catch (const ModelError& error) {
    REQUIRE(error.diagnostics().size() == 1);
    CHECK(error.diagnostics()[0].where.line == 13); // the second rod's [[element]]
    CHECK(std::string(error.what()).find("rod' cannot be assembled") != std::string::npos);
  }
}

// On a slope of angle a friction takes tan a of the normal force: the share used is tan a / mu.
TEST_CASE("a block at rest on a slope uses tan a / mu of its friction") {
  for (const double slope : {0.05, 0.2, 0.35}) {
    CAPTURE(slope);
    const double mu = 0.4;
    const Model model = scene(k_head + R"(
[[body]]
name = "block"
mass = 100
inertia = 10
position = [0.0, 0.2]
[[marker]]
name = "slope"
body = "ground"
at = [0.0, 0.0]
[[element]]
kind = "unilateral_contact"
name = "upper"
a = { body = "block", point = [-0.5, -0.2] }
b = "slope"
stiffness = 1e6
damping = 1e3
preload = 490
[[element]]
kind = "unilateral_contact"
name = "lower"
a = { body = "block", point = [0.5, -0.2] }
b = "slope"
stiffness = 1e6
damping = 1e3
preload = 490
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["upper", "lower"]
static_friction = 0.4
)" + ("[[element]]\nkind = \"load\"\nname = \"tilt\"\nat = \"block\"\nforce = [" + std::to_string(981.0 * std::tan(slope)) + ", 0.0]\n"));
    const Equilibrium rest = settle(model); // a force of m g tan a is gravity on the slope, divided by cos a
    REQUIRE(rest.margins.size() == 1);
    // Six decimals in the load of the model's text.
    CHECK(rest.margins[0].used == doctest::Approx(std::tan(slope) / mu).epsilon(1e-6));
  }
}
