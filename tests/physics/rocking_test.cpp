// A box rocking on two feet without damping: small motions about the settled pose are harmonic, large ones
// lift the feet by turns and keep their energy; the mirrored box does the mirrored thing.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

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
angular_velocity = )" + angular_velocity + R"(
[[element]]
kind = "unilateral_contact"
name = "rear"
a = { body = "box", at = [-0.5, 0.0] }
stiffness = 4e5
preload = 490.5
)" + damping + R"(
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
