// A box rocking on two feet without damping: small motions about the settled pose are harmonic, large ones
// lift the feet by turns and keep their energy; the mirrored box does the mirrored thing.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_mass = 100.0, k_inertia = 60.0, k_height = 0.8, k_half = 0.5, k_stiffness = 4e5;

std::string box(const std::string& angular_velocity, const std::string& damping) {
  return R"(
[[body]]
name = "box"
mass = 100.0
inertia = 60.0
position = [0.0, 0.8]
angular_velocity = )" +
         angular_velocity + R"(
[[element]]
kind = "unilateral_contact"
name = "rear"
a = { body = "box", at = [-0.5, 0.0] }
stiffness = 4e5
preload = 490.5
)" + damping +
         R"(
[[element]]
kind = "unilateral_contact"
name = "front"
a = { body = "box", at = [0.5, 0.0] }
stiffness = 4e5
preload = 490.5
)" + damping;
}

} // namespace

TEST_CASE("small rocking is harmonic: J θ'' = −(2 k l² − m g h) θ") {
  const double w = std::sqrt((2.0 * k_stiffness * k_half * k_half - k_mass * 9.81 * k_height) / k_inertia);
  const Run r = run(box("1e-6", ""), {"dop853", 1e-13, 1.0, 0.01});
  const std::vector<double> theta = r.series("box.theta");
  // Terms of third order in θ = 2e-8 rad vanish; what is left is the method's absolute error.
  for (std::size_t i = 0; i < theta.size(); ++i) CHECK(std::abs(theta[i] - 1e-6 / w * std::sin(w * r.times()[i])) < 1e-13);
  CHECK(r.result.events.empty());
}

TEST_CASE("a box that lifts its feet by turns keeps its energy, and its mirror image mirrors it") {
  for (const Settings& settings : {Settings{"dop853", 1e-12, 2.0, 0.01}, Settings{"rk4", 1e-4, 2.0, 0.01}}) {
    CAPTURE(settings.integrator);
    const Run r = run(box("0.4", ""), settings), m = run(box("-0.4", ""), settings);
    CHECK(r.event_times("rear", "opens").size() >= 3);
    CHECK(r.event_times("front", "opens").size() >= 3);
    // rk4: (ωh)⁴/120 a radian with ω = 58 rad/s, over 100 rad, of 5 J in motion.
    CHECK(r.result.statistics.energy_residual < (settings.integrator == "rk4" ? 1e-6 : 1e-9));
    const std::vector<double> theta = r.series("box.theta"), image = m.series("box.theta");
    for (std::size_t i = 0; i < theta.size(); ++i) CHECK(std::abs(theta[i] + image[i]) < 1e-11);
    const std::vector<double> rear = r.event_times("rear"), front = m.event_times("front");
    REQUIRE(rear.size() == front.size());
    for (std::size_t i = 0; i < rear.size(); ++i) CHECK(std::abs(rear[i] - front[i]) < 1e-11);
  }
}

TEST_CASE("with damping it comes to rest on both feet, upright, at its settled height") {
  const Run r = run(box("0.4", "damping = 800.0\n"), {"dop853", 1e-10, 6.0});
  CHECK(std::abs(r.last("box.theta")) < 1e-10);
  CHECK(std::abs(r.last("box.y") - 0.8) < 1e-10);
  CHECK(r.last("rear.force") == doctest::Approx(490.5).epsilon(1e-6));
  // All of its motion has been dissipated.
  CHECK(r.result.statistics.dissipated == doctest::Approx(0.5 * 60.0 * 0.16).epsilon(1e-7));
}

// A brick tilted by 35° on its lower right edge, with both right edges in one friction. It turns about the edge that stands, J α
// = m g x with J about that edge, and not about the upper one, 0.18 m above the floor, on whose side the sign of its tilt alone
// would be.
TEST_CASE("friction acts at the foot that stands, whatever the angle at which both would") {
  std::string text = R"(
[[body]]
name = "brick"
mass = 4.06
inertia = 0.0207875
position = [0.0219314428, 0.1219785882]
angle = "-35 deg"
)";
  for (const std::string edge : {"lower", "upper"})
    text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"" + edge + "\"\na = { body = \"brick\", point = [0.052, " +
            (edge == "lower" ? "-" : "") + "0.1125] }\nstiffness = 1e8\ndamping = 1e4\n";
  text += "[[element]]\nkind = \"coulomb_stick\"\nname = \"friction\"\ncontacts = [\"lower\", \"upper\"]\nstatic_friction = 0.6\n";
  const Run r = run(text, {"dop853", 1e-8, 0.05});
  // Of θ − θ₀ = −½ α t² over 50 ms with α = m g x/J = 10.5 rad/s²; α grows with x by 2 % meanwhile, and the edge sinks by
  // microns.
  const double j = 0.0207875 + 4.06 * (0.0219314 * 0.0219314 + 0.1219786 * 0.1219786), alpha = 4.06 * 9.81 * 0.0219314 / j;
  CHECK(r.last("brick.theta") + 35.0 * 3.14159265358979 / 180.0 == doctest::Approx(-0.5 * alpha * 0.05 * 0.05).epsilon(0.03));
}

// A box tips over its front foot. A foot further in front, which hangs in the air and touches nothing, changes nothing: whatever is
// computed from it alone would be the place of a friction that it cannot carry.
TEST_CASE("a foot that hangs in the air holds nothing") {
  const auto tipped = [](const std::string& contacts) {
    std::string text = "[[body]]\nname = \"box\"\nmass = 100.0\ninertia = 40.0\nposition = [0.0, 1.0]\n";
    const auto foot = [&](const std::string& name, const std::string& at, const std::string& more) {
      text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"" + name + "\"\na = { body = \"box\", at = " + at +
              " }\nstiffness = 1e8\ndamping = 1e5\n" + more + "\n";
    };
    foot("rear", "[-0.4, 0.0]", "preload = 490.5");
    foot("front", "[0.4, 0.0]", "preload = 490.5");
    foot("outrigger", "[0.9, 0.3]", "gap = 0.3");
    text += "[[element]]\nkind = \"coulomb_stick\"\nname = \"soles\"\ncontacts = " + contacts + "\nstatic_friction = 0.7\n";
    text += "[[signal]]\nname = \"push\"\nkind = \"rectangle\"\npeak = 600.0\nduration = 0.3\n";
    text += "[[element]]\nkind = \"load\"\nname = \"push\"\nat = { body = \"box\", at = [0.0, 1.6] }\nforce_x = \"push\"\n";
    return run(text, {"dop853", 1e-10, 0.5, 0.01});
  };
  const Run two = tipped("[\"rear\", \"front\"]"), three = tipped("[\"outrigger\", \"rear\", \"front\"]");
  CHECK(two.last("box.theta") < -0.3);
  CHECK(two.event_times("soles").empty());
  CHECK(three.event_times("soles").empty());
  // The order of the contacts rounds the sum of their forces differently; tipping magnifies that by e^{3.5 · 0.5}.
  for (const char* name : {"box.theta", "box.x", "soles.friction", "soles.slip_rate"}) {
    const std::vector<double> a = two.series(name), b = three.series(name);
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i] - b[i]) < 1e-9);
  }
}

// The whole scene, gravity and floor with it, turned about the origin: the same motion, turned. Rocking magnifies differences by
// some 3 at each of seven impacts; what the turned numbers are rounded by, 1e-16, and the tolerance stay far below 1e-6.
TEST_CASE("a block that rocks on a floor drawn at an angle rocks as on a level one") {
  const auto rocking = [](double turned) {
    const double c = std::cos(turned), s = std::sin(turned);
    const auto place = [&](double x, double y) {
      char pair[80];
      std::snprintf(pair, sizeof pair, "[%.17g, %.17g]", c * x - s * y, s * x + c * y);
      return std::string(pair);
    };
    char angle[40];
    std::snprintf(angle, sizeof angle, "%.17g", turned - 0.1);
    std::string text =
        "gravity = " + place(0.0, -9.81) +
        "\n[[body]]\nname = \"block\"\nmass = 100.0\ninertia = 41.666666666666664\nposition = " + place(0.0798503332, 1.0486708) +
        "\nangle = " + angle + "\n";
    for (const std::string side : {"-0.5", "0.5"})
      text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"corner " + side + "\"\na = { body = \"block\", point = [" + side +
              ", -1.0] }\nnormal = " + place(0.0, 1.0) + "\nstiffness = 1e7\ndamping = 4e4\n";
    text += "[[element]]\nkind = \"coulomb_stick\"\nname = \"friction\"\ncontacts = [\"corner -0.5\", \"corner "
            "0.5\"]\nstatic_friction = 0.6\n";
    return run(text, {"dop853", 1e-11, 2.0, 0.01}).series("block.theta");
  };
  const std::vector<double> level = rocking(0.0);
  for (const double turned : {0.3, -1.2, 2.5}) {
    CAPTURE(turned);
    const std::vector<double> other = rocking(turned);
    REQUIRE(other.size() == level.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < level.size(); ++i) worst = std::max(worst, std::abs(other[i] - turned - level[i]));
    CHECK(worst < 1e-6);
  }
}
