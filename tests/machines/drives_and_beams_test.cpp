// Machines with bands, cams, beams and controllers, each against a closed form or an integration written by hand.
#include "tests/machines/machine.h"
#include "tests/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81, k_pi = std::numbers::pi;

// The classical method of Runge and Kutta.
template <std::size_t N, class Rate>
std::array<double, N> integrated(std::array<double, N> z, double start, double end, long steps, const Rate& rate) {
  const double h = (end - start) / static_cast<double>(steps);
  const auto moved = [](std::array<double, N> from, const std::array<double, N>& by, double share) {
    for (std::size_t i = 0; i < N; ++i) from[i] += share * by[i];
    return from;
  };
  for (long n = 0; n < steps; ++n) {
    const double t = start + static_cast<double>(n) * h;
    const auto k1 = rate(t, z), k2 = rate(t + 0.5 * h, moved(z, k1, 0.5 * h)), k3 = rate(t + 0.5 * h, moved(z, k2, 0.5 * h)),
               k4 = rate(t + h, moved(z, k3, h));
    for (std::size_t i = 0; i < N; ++i) z[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  }
  return z;
}

} // namespace

TEST_CASE("a band brake that grips itself stops its drum e^{μπ} times sooner than the other way round") {
  const double inertia = 2.0, radius = 0.2, pull = 6.0 * k_g * 1.0 / 0.3, grip = std::exp(0.3 * k_pi);
  for (const double speed : {-30.0, 20.0}) {
    CAPTURE(speed);
    const MachineRun r("band_brake", {"parameters.speed=" + std::to_string(speed) + " rad/s", "simulation.end=3"});
    REQUIRE(r.is_complete());
    const double couple = speed < 0.0 ? radius * pull * (grip - 1.0) : radius * pull * (1.0 - 1.0 / grip),
                 stops = inertia * std::abs(speed) / couple;
    REQUIRE(stops < 2.9);
    // The lever gives by some tenths of a millimetre as the band stretches, against its dashpot.
    CHECK(std::abs(r.at("drum.omega", 0.5 * stops)) == doctest::Approx(0.5 * std::abs(speed)).epsilon(0.01));
    const std::vector<double> sticks = r.events("band", EventKind::sticks);
    REQUIRE(!sticks.empty());
    CHECK(std::any_of(sticks.begin(), sticks.end(), [&](double t) { return std::abs(t - stops) < 0.02 * stops; }));
    CHECK(std::abs(r.last("drum.omega")) < 1e-2);
  }
}

TEST_CASE("a follower jumps off its cam from the jump speed on, at the time of the closed form") {
  const double held = k_g + 20.0 / 0.5, natural = 1e7 / 0.5, jump = std::sqrt(held / (0.01 + held / natural));
  CHECK(jump == doctest::Approx(70.55).epsilon(1e-3));
  for (const double share : {0.995, 1.02}) {
    const double speed = share * jump, a = 0.01 * natural / (natural - speed * speed) * speed * speed;
    const MachineRun r("cam_jump",
                       {"parameters.speed=" + std::to_string(speed) + " rad/s", "simulation.tolerance=1e-11", "simulation.end=0.1"});
    REQUIRE(r.is_complete());
    const std::vector<double> off = r.events("contact", EventKind::opens);
    CHECK(off.empty() == (share < 1.0));
    if (!off.empty()) CHECK(std::abs(off[0] - std::acos(-held / a) / speed) < 1e-7); // the speed has six digits behind its point
  }
}

TEST_CASE("both cells of a weighing bridge show the lorry's weight, each its share by the levers") {
  if (k_is_sanitized) return; // minutes there, of code that beam_test goes through
  const MachineRun r("weighing_bridge", {"parameters.speed=0.4 m/s"});
  REQUIRE(r.is_complete());
  const double lorry = 18e3 * k_g, bridge = 7850.0 * 0.05 * 12.0 * k_g;
  double sum = 0.0, moment = 0.0;
  int count = 0;
  for (double t = 1.0; t < 6.0; t += 0.01) { // wheels roll over the seams of segments that bend: ripples, whose mean is zero
    const double left = r.at("cell 0.force", t), right = r.at("cell 1.force", t);
    sum += left + right;
    moment += 12.0 * right - lorry * r.at("lorry.x", t);
    ++count;
    CHECK(left + right == doctest::Approx(lorry + bridge).epsilon(0.05));
  }
  CHECK(sum / count == doctest::Approx(lorry + bridge).epsilon(2e-3));
  CHECK(moment / count == doctest::Approx(6.0 * bridge).epsilon(0.01)); // 6 m of its own weight
}

TEST_CASE("a wedge that locks itself goes in and comes out at the forces of the friction cones, and stays between them") {
  const double slope = 10.0 * k_pi / 180.0, phi = std::atan(0.2), weight = 100.0 * k_g, own = 0.2 * 2.0 * k_g;
  const double in = weight * (std::tan(slope + phi) + 0.2) + own, out = weight * (std::tan(phi - slope) + 0.2) + own;
  const MachineRun r("locking_wedge");
  REQUIRE(r.is_complete());
  const std::vector<double> forward = r.events("upper face", EventKind::slips_forward),
                            backward = r.events("upper face", EventKind::slips_backward);
  const std::vector<double> all = [&] {
    std::vector<double> times = forward;
    times.insert(times.end(), backward.begin(), backward.end());
    std::sort(times.begin(), times.end());
    return times;
  }();
  REQUIRE(all.size() == 2);
  CHECK(std::abs(all[0] - in / 600.0) < 1e-3); // ramps of 600 and 230 N/s; the contacts give by micrometres
  CHECK(std::abs(all[1] - (2.0 + out / 230.0)) < 1e-3);
  // Let go it stays, to the stretch of its contacts.
  CHECK(std::abs(r.at("wedge.x", 2.9) - r.at("wedge.x", 1.2)) < 2e-5);
  // With less friction than half of the slope asks for it does not.
  CHECK_THROWS_AS(MachineRun("locking_wedge", {"parameters.friction=0.05"}), NumericalFailure); // nor does it rest at the start
}

TEST_CASE("a governor with a servo follows its equations, also while the servo is at its limits") {
  // (θ, θ', speed, valve); the arm hangs 0.05 m from the axis, its ball 0.3 m below.
  const auto rate = [](double t, const std::array<double, 4>& z) {
    const double s = std::sin(z[0]), c = std::cos(z[0]), x = 0.05 + 0.3 * s;
    const double turning = (-2.0 * k_g * 0.3 * s + 2.0 * z[2] * z[2] * x * 0.3 * c - 0.8 * z[1]) / (0.004 + 2.0 * 0.09);
    return std::array<double, 4>{z[1], turning, (200.0 * std::clamp(z[3], 0.0, 1.0) - (t < 5.0 ? 40.0 : 80.0)) / 30.0,
                                 std::clamp(1.5 * (0.6 - z[0]), -0.5, 0.5)};
  };
  const MachineRun r("engine_governor", {"simulation.tolerance=1e-10"});
  REQUIRE(r.is_complete());
  const auto half = integrated<4>({0.6, 0.0, 5.2, 0.2}, 0.0, 5.0, 50000, rate); // the load jumps there
  const auto end = integrated<4>(half, 5.0, 20.0, 150000, rate);
  CHECK(r.at("arm.theta", 5.0) == doctest::Approx(half[0]).epsilon(1e-6));
  CHECK(r.last("arm.theta") == doctest::Approx(end[0]).epsilon(1e-5)); // kinks of the servo cost the steps by hand some digits
  CHECK(r.last("speed.value") == doctest::Approx(end[2]).epsilon(1e-5));
  CHECK(r.last("valve.value") == doctest::Approx(end[3]).epsilon(1e-5));
}

TEST_CASE("a drum with balls in a ring balances itself above its critical speed, and shakes more below") {
  const MachineRun r("balanced_drum");
  REQUIRE(r.is_complete());
  CHECK(std::hypot(r.last("tub.x"), r.last("tub.y")) < 1e-5); // 40 s of a balance that comes by e^(-0.4 t)
  double most = 0.0;
  for (const double x : r.series("tub.x")) most = std::max(most, std::abs(x));
  CHECK(most > 1e-3); // before
  const auto between = [&](const std::string& ball) {
    return std::abs(std::remainder(r.last(ball + ".theta") - r.last("drum.theta"), 2.0 * k_pi));
  };
  const double expected = k_pi - std::acos(0.4 / (2.0 * 1.0 * 0.25));
  CHECK(between("ball 0") == doctest::Approx(expected).epsilon(1e-3));
  CHECK(between("ball 1") == doctest::Approx(expected).epsilon(1e-3));
}

TEST_CASE("a controller with an integral part brings its arm to the angle, and the integral carries weight and couple") {
  for (const double unknown : {5.0, -3.0}) {
    const MachineRun r("pid_pendulum",
                       {"parameters.unknown=" + std::to_string(unknown) + " N m", "simulation.tolerance=1e-10", "simulation.end=30"});
    REQUIRE(r.is_complete());
    const double target = k_pi / 3.0;
    CHECK(std::abs(r.last("arm.theta") - target) < 1e-6);
    CHECK(r.last("integral.value") == doctest::Approx(4.0 * k_g * 0.5 * std::sin(target) + unknown).epsilon(1e-5));
    // (J + m l²) θ'' = −m g l sin θ − M + motor; the integral waits while the motor is at its end.
    const auto rate = [&](double, const std::array<double, 3>& z) {
      const double asked = 60.0 * (target - z[0]) - 20.0 * z[1] + z[2], couple = std::clamp(asked, -40.0, 40.0);
      return std::array<double, 3>{z[1], (couple - 4.0 * k_g * 0.5 * std::sin(z[0]) - unknown) / (0.12 + 4.0 * 0.25),
                                   std::abs(asked) < 40.0 ? 60.0 * (target - z[0]) : 0.0};
    };
    const auto expected = integrated<3>({0.0, 0.0, 0.0}, 0.0, 2.0, 400000, rate);
    CHECK(r.at("arm.theta", 2.0) ==
          doctest::Approx(expected[0]).epsilon(1e-5)); // the jump of the integral's rate falls between steps of 5 µs
  }
}
