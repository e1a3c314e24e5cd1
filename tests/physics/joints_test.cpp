// Joints against independent solutions: pendulum digits, sliding pendulum, rods, welds, conservation.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

using namespace steplap;
using namespace steplap::testing;

namespace {

// B3: point mass on 1 m from the horizontal, x(10 s), y(10 s); the period by elliptic integrals.
constexpr double k_x = -0.275087462576117, k_y = -0.961419205099125, k_period = 2.36784194757624;

std::string body(const std::string& name, const std::string& rest) { return "[[body]]\nname = \"" + name + "\"\n" + rest + "\n"; }

// Momentum, and angular momentum about the origin, of all bodies.
Vec3 momentum(const System& system, const State& state) {
  Vec3 sum = Vec3::Zero();
  for (int i = 1; i < system.body_count(); ++i) {
    const BodyData& b = system.bodies[i];
    const double *q = &state.q[3 * i], *v = &state.v[3 * i];
    sum += Vec3(b.mass * v[0], b.mass * v[1], b.inertia * v[2] + b.mass * (q[0] * v[1] - q[1] * v[0]));
  }
  return sum;
}

} // namespace

TEST_CASE("a pendulum, on a rod and on a pin, against elliptic integrals") {
  const std::string rod = body("bob", "mass = 1.0\ninertia = 0.1\nposition = [-1.0, 0.0]") + R"(
[[element]]
kind = "distance"
name = "rod"
a = "bob"
)";
  // Pinned at half a metre with J = m/4 it swings with the same reduced length of 1 m.
  const std::string pin = body("bob", "mass = 2.0\ninertia = 0.5\nposition = [-0.5, 0.0]") + R"(
[[element]]
kind = "revolute"
name = "pin"
a = { body = "bob", at = [0.0, 0.0] }
)";
  for (const std::string& text : {rod, pin}) {
    const double length = text == rod ? 1.0 : 0.5;
    for (const Settings& settings : {Settings{"dop853", 1e-13, 10.0}, Settings{"tsit5", 1e-13, 10.0}, Settings{"rk4", 5e-4, 10.0}}) {
      CAPTURE(settings.integrator);
      const Run r = run(text, settings);
      // rk4: (ωh)⁴/120·ωt with ω up to 4.4 rad/s
      const double tolerance = settings.integrator == "rk4" ? 1e-10 : 1e-11;
      CHECK(std::abs(r.last("bob.x") - length * k_x) < tolerance);
      CHECK(std::abs(r.last("bob.y") - length * k_y) < tolerance);
      CHECK(r.result.statistics.max_position_residual < 1e-10);
      CHECK(r.result.statistics.energy_residual < 1e-9);
    }
  }
  const Run r = run(rod, {"dop853", 1e-13, k_period});
  CHECK(std::abs(r.last("bob.x") + 1.0) < 1e-12);
  CHECK(std::abs(r.last("bob.y")) < 1e-11);
  // At the bottom the rod carries m(g + v²/l) = 3 m g, and pulls.
  const Run bottom = run(rod, {"dop853", 1e-13, 0.25 * k_period});
  CHECK(std::abs(bottom.last("rod.force") + 3.0 * 9.81) < 1e-10);
}

TEST_CASE("a rod between two free bodies carries the centripetal force and nothing moves but the rotation") {
  const Run r = run("gravity = [0.0, 0.0]\n" + body("a", "mass = 2.0\ninertia = 1.0\nposition = [1.0, 0.0]\nvelocity = [0.0, 3.0]") +
                        body("b", "mass = 4.0\ninertia = 1.0\nposition = [-0.5, 0.0]\nvelocity = [0.0, -1.5]") +
                        "[[element]]\nkind = \"distance\"\nname = \"rod\"\na = \"a\"\nb = \"b\"\n",
                    {"dop853", 1e-13, 2.0, 0.25});
  for (std::size_t i = 0; i < r.times().size(); ++i) {
    CHECK(std::abs(r.series("a.x")[i] - std::cos(3.0 * r.times()[i])) < 1e-11);
    CHECK(std::abs(r.series("b.y")[i] + 0.5 * std::sin(3.0 * r.times()[i])) < 1e-11);
    CHECK(std::abs(r.series("rod.force")[i] + 18.0) < 1e-10); // pulls a towards b
  }
}

TEST_CASE("a slide on an inclined rail falls with g sin α and its rail carries m g cos α") {
  const double angle = -0.5;
  const Run r = run(body("slide", "mass = 2.0\ninertia = 1.0\nangle = 0.2") + R"(
[[marker]]
name = "rail"
body = "ground"
at = [0.0, 0.0]
angle = -0.5
[[element]]
kind = "prismatic"
name = "rail joint"
a = { body = "slide", at = [0.3, 0.4] }
b = "rail"
)",
                    {"rk4", 1e-2, 2.0});
  const double s = 0.5 * 9.81 * std::sin(0.5) * 4.0;
  CHECK(std::abs(r.last("slide.x") - s * std::cos(angle)) < 1e-12);
  CHECK(std::abs(r.last("slide.y") - s * std::sin(angle)) < 1e-12);
  CHECK(std::abs(r.last("slide.theta") - 0.2) < 1e-13);
  CHECK(std::abs(r.last("rail joint.force") - 2.0 * 9.81 * std::cos(0.5)) < 1e-11);
}

TEST_CASE("a pendulum on a sliding pivot: horizontal momentum and energy decide its motion") {
  // Its pivot on a horizontal line; uniform rod of 1 m: x of the centre stays, ½ m ẏ² + ½ J ω² + m g y = 0.
  const Run r = run(body("rod", "mass = 1.0\ninertia = 0.083333333333333329\nposition = [0.5, 0.0]") + R"(
[[element]]
kind = "point_on_line"
name = "line"
a = { body = "rod", at = [0.0, 0.0] }
)",
                    {"dop853", 1e-13, 3.0, 0.1});
  const std::vector<double> x = r.series("rod.x"), y = r.series("rod.y"), theta = r.series("rod.theta"), w = r.series("rod.omega");
  for (std::size_t i = 0; i < x.size(); ++i) {
    CHECK(std::abs(x[i] - 0.5) < 1e-12);
    CHECK(std::abs(y[i] - 0.5 * std::sin(theta[i])) < 1e-12); // the pivot is on the line
    const double c = 0.5 * std::cos(theta[i]);
    CHECK(std::abs(0.5 * (c * c + 1.0 / 12.0) * w[i] * w[i] + 9.81 * y[i]) < 1e-10);
  }
  CHECK(std::abs(w.back()) > 0.01);
}

TEST_CASE("free bodies joined by pins, rods, welds, slides and springs keep momentum and angular momentum") {
  const std::string text = "gravity = [0.0, 0.0]\n" +
                           body("a", "mass = 2.0\ninertia = 0.7\nposition = [0.0, 0.0]\nvelocity = [1.0, 0.3]\nangular_velocity = 2.0") +
                           body("b", "mass = 1.0\ninertia = 0.2\nposition = [1.0, 0.2]\nvelocity = [0.5, -0.3]") +
                           body("c", "mass = 3.0\ninertia = 1.1\nposition = [2.0, -0.4]\nangle = 0.4\nvelocity = [0.0, 0.9]") +
                           body("d", "mass = 0.5\ninertia = 0.1\nposition = [2.5, 0.6]\nvelocity = [-1.0, 0.0]") +
                           body("e", "mass = 1.5\ninertia = 0.3\nposition = [3.2, 0.1]\nvelocity = [0.0, 0.5]") + R"(
[[element]]
kind = "revolute"
name = "pin"
a = { body = "a", at = [0.5, 0.1] }
b = { body = "b", at = [0.5, 0.1] }
[[element]]
kind = "prismatic"
name = "slide"
a = { body = "b", at = [1.4, 0.0] }
b = { body = "c", at = [1.5, 0.0], angle = 0.3 }
[[element]]
kind = "weld"
name = "weld"
a = { body = "d", at = [2.2, 0.1] }
b = "c"
[[element]]
kind = "distance"
name = "rod"
a = { body = "d", at = [2.6, 0.5] }
b = "e"
[[element]]
kind = "spring_damper"
name = "spring"
a = { body = "a", at = [0.1, 0.5] }
b = { body = "e", at = [3.0, 0.3] }
stiffness = 30.0
damping = 0.4
[[element]]
kind = "spring_damper"
name = "axial"
a = { body = "b", at = [1.0, 0.4] }
b = { body = "d", at = [2.4, 0.9] }
axis = [0.6, 0.8]
stiffness = 50.0
damping = 0.3
[[element]]
kind = "bushing"
name = "bushing"
a = { body = "e", at = [2.8, -0.2] }
b = { body = "a", at = [2.8, -0.2] }
stiffness = [20.0, 10.0]
damping = [0.1, 0.2]
rotational_stiffness = 3.0
)";
  // The velocities as given do not fit the joints: what projection takes away is internal, too.
  for (const Settings& settings : {Settings{"rk4", 1e-3, 5.0}, Settings{"dop853", 1e-10, 5.0}}) {
    const Run r = run(text, settings);
    const Vec3 before = momentum(*r.system, r.system->initial_state()), after = momentum(*r.system, r.result.final_state);
    // Forces in pairs cancel to rounding in every stage, whatever the method's own error.
    CHECK((after - before).head<2>().norm() < 1e-12);
    // Angular momentum is quadratic: the methods keep it to their accuracy.
    CHECK(std::abs(after.z() - before.z()) < 1e-8);
  }
}

TEST_CASE("a chain of welded bodies moves as the one body they make") {
  // Three bodies; merged by hand: mass, centre, inertia by Steiner's rule.
  const double m[3] = {2.0, 1.0, 3.0}, j[3] = {0.4, 0.2, 0.9};
  const Vec2 p[3] = {{0.0, 0.0}, {0.8, 0.3}, {1.5, -0.4}};
  double mass = 0.0, inertia = 0.0;
  Vec2 centre = Vec2::Zero();
  for (int i = 0; i < 3; ++i) {
    mass += m[i];
    centre += m[i] * p[i];
  }
  centre /= mass;
  for (int i = 0; i < 3; ++i) inertia += j[i] + m[i] * (p[i] - centre).squaredNorm();
  const auto number = [](double x) {
    std::ostringstream out;
    out.precision(17);
    out << std::fixed << x;
    return out.str();
  };
  const auto place = [&](const Vec2& at) { return "position = [" + number(at.x()) + ", " + number(at.y()) + "]"; };
  std::string chain, springs;
  for (int i = 0; i < 3; ++i)
    chain += body(std::string(1, static_cast<char>('a' + i)),
                  "mass = " + number(m[i]) + "\ninertia = " + number(j[i]) + "\nangle = 0." + std::to_string(i) + "\n" + place(p[i]));
  chain += "[[element]]\nkind = \"weld\"\nname = \"first\"\na = \"a\"\nb = \"b\"\n"
           "[[element]]\nkind = \"weld\"\nname = \"second\"\na = { body = \"c\", at = [1.0, 0.1] }\nb = \"b\"\n";
  const std::string one = body("a", "mass = " + number(mass) + "\ninertia = " + number(inertia) + "\n" + place(centre));
  const auto spring = [](const std::string& on, const std::string& at) {
    return "[[element]]\nkind = \"spring_damper\"\nname = \"s " + at + "\"\na = { body = \"" + on + "\", at = [" + at +
           "] }\nb = { body = \"ground\", at = [0.5, 2.0] }\nstiffness = 60.0\ndamping = 0.5\n";
  };
  const Settings settings{"dop853", 1e-12, 4.0, 0.1};
  const Run merged = run(chain + spring("a", "0.1, 0.2") + spring("c", "1.7, -0.1"), settings);
  const Run single = run(one + spring("a", "0.1, 0.2") + spring("a", "1.7, -0.1"), settings);
  for (std::size_t i = 0; i < merged.times().size(); ++i) {
    const double theta = single.series("a.theta")[i];
    const Vec2 at = Vec2(single.series("a.x")[i], single.series("a.y")[i]) + rotated(p[2] - centre, theta);
    CHECK(std::abs(merged.series("c.theta")[i] - 0.2 - theta) < 1e-9);
    CHECK(std::abs(merged.series("c.x")[i] - at.x()) < 1e-9);
    CHECK(std::abs(merged.series("c.y")[i] - at.y()) < 1e-9);
    // The first weld carries what moves body a: m a − m g − the spring, in b's axes (turned by 0.1).
    const Vec2 force(2.0 * merged.series("a.ax")[i], 2.0 * (merged.series("a.ay")[i] + 9.81));
    const double angle = merged.series("b.theta")[i];
    const Vec2 carried = rotated({merged.series("first.force_x")[i], merged.series("first.force_y")[i]}, angle);
    const Vec2 hook = Vec2(merged.series("a.x")[i], merged.series("a.y")[i]) + rotated(Vec2(0.1, 0.2), merged.series("a.theta")[i]);
    const Vec2 away = (hook - Vec2(0.5, 2.0)).normalized();
    const Vec2 pull = merged.series("s 0.1, 0.2.force")[i] * away;
    CHECK((carried + pull - force).norm() < 1e-9);
  }
  CHECK(merged.result.statistics.evaluations < single.result.statistics.evaluations + 100);
}

// The smallest pivot of a chain falls as one over its length: no singular position, whose care would double the
// evaluations. Straight and let go, a rod of a chain of any length is in free fall but for the first ones.
TEST_CASE("a long chain takes four evaluations for a step of four stages") {
  constexpr int rods = 6000, steps = 20;
  std::string text;
  for (int i = 0; i < rods; ++i) {
    const std::string name = std::to_string(i), before = std::to_string(i - 1);
    text += body(name, "mass = 1.0\ninertia = 0.083\ncg = [0.5, 0.0]") + "[[element]]\nkind = \"revolute\"\nname = \"pin " + name +
            "\"\na = { body = \"" + name + "\", point = [0.0, 0.0] }\nangle = 0.0\n";
    if (i > 0) text += "b = { body = \"" + before + "\", point = [1.0, 0.0] }\n";
  }
  const Run r = run(text, {"rk4", 1e-4, steps * 1e-4});
  // Besides: a handful for the start and the samples.
  CHECK(r.result.statistics.evaluations <= 4 * steps + 8);
  const double t = steps * 1e-4;
  CHECK(std::abs(r.last(std::to_string(rods / 2) + ".y") + 0.5 * 9.81 * t * t) < 1e-12);
}

// Three equal cranks of 1 kg and 1 m, pinned at their ends, under a bar of 1 kg that they lead on a circle: two are enough, the
// third one's rows depend on the others'. θ'' = −(3/2 + 1) g cos θ/J, J = 3 (0.1 + 1/4) + 1: by the classical Runge–Kutta method,
// whose error at 1e-4 s is below 1e-12. Flat, as at 0.534 s and 1.067 s, a parallelogram could fold another way.
TEST_CASE("cranks under a bar pass their flat positions with every method, as well as the tolerance asks") {
  const double c = 0.5, s = std::sqrt(0.75), end = 2.0, h = 1e-4; // let go at 60°
  std::ostringstream text;
  text.precision(17);
  text << "[[body]]\nname = \"bar\"\nmass = 1.0\ninertia = 0.1\nposition = [" << 2.0 + c << ", " << s << "]\n";
  for (int i = 0; i < 3; ++i) {
    text << "[[body]]\nname = \"crank " << i << "\"\nmass = 1.0\ninertia = 0.1\nposition = [" << 2.0 * i + 0.5 * c << ", " << 0.5 * s
         << "]\n";
    text << "[[element]]\nkind = \"revolute\"\nname = \"foot " << i << "\"\na = { body = \"crank " << i << "\", at = [" << 2.0 * i
         << ", 0.0] }\nb = { body = \"ground\", at = [" << 2.0 * i << ", 0.0] }\n";
    text << "[[element]]\nkind = \"revolute\"\nname = \"head " << i << "\"\na = { body = \"crank " << i << "\", at = [" << 2.0 * i + c
         << ", " << s << "] }\nb = { body = \"bar\", at = [" << 2.0 * i + c << ", " << s << "] }\n";
  }
  double theta = std::acos(c), omega = 0.0;
  const auto pull = [](double angle) { return -2.5 * 9.81 / 2.05 * std::cos(angle); };
  for (int i = 0; i < std::lround(end / h); ++i) {
    const double a1 = pull(theta), a2 = pull(theta + 0.5 * h * omega), a3 = pull(theta + 0.5 * h * (omega + 0.5 * h * a1)),
                 a4 = pull(theta + h * (omega + 0.5 * h * a2));
    theta += h * omega + h * h / 6.0 * (a1 + a2 + a3);
    omega += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
  }
  for (const Settings& method : {Settings{"dop853", 1e-8}, Settings{"tsit5", 1e-8}, Settings{"auto", 1e-8}, Settings{"rodas5p", 1e-6},
                                 Settings{"rodas5p", 1e-8}, Settings{"rodas5p", 1e-10}}) {
    CAPTURE(method.integrator);
    CAPTURE(method.step_or_tolerance);
    const Run r = run(text.str(), {method.integrator, method.step_or_tolerance, end});
    // Steps err by the tolerance of 1 m; after four swings up and down by a few times as much.
    CHECK(std::hypot(r.last("bar.x") - 2.0 - std::cos(theta), r.last("bar.y") - std::sin(theta)) < 10.0 * method.step_or_tolerance);
    CHECK(r.result.statistics.energy_residual < method.step_or_tolerance * r.result.statistics.energy_scale);
    CHECK(r.result.statistics.evaluations < 20000); // dop853 takes 2490 at 1e-10; who creeps takes millions
  }
}
