// models/machines/ratchet.toml against its geometry: whole teeth, the swing from which on it wins any, and the work that this takes.
#include "tests/machines/machine.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_degree = std::numbers::pi / 180.0, k_pitch = 30.0 * k_degree, k_load = 20.0;

MachineRun ratchet(double swing, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"parameters.swing=" + std::to_string(swing) + " rad", "output.also=[\"whole.*\", \"*.work\"]"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return MachineRun("ratchet", overrides);
}

// A pawl falls behind a tooth where its corner passes the tooth's tip: where circles about the axle and about the pin meet. Both pawls
// are alike, the lever's turned by 45 degrees: it falls behind the next tooth, and lets the other fall, where the lever has gone
// so far to either side.
double least_swing() {
  const double pin_x = 0.09, pin_y = 0.115, tip = 0.1, arm = std::hypot(0.09, 0.0335), away = std::hypot(pin_x, pin_y);
  const double meets = std::atan2(pin_y, pin_x) + std::acos((tip * tip + away * away - arm * arm) / (2.0 * tip * away));
  return 0.5 * k_pitch + meets - 90.0 * k_degree;
}

// By what the contact of the holding pawl gives under a load the wheel leans back: flush on the pawl's end, 11.5 mm wide and 87 mm from the
// axle, F = M/r presses it in by F/(k w), by twice that at one of its ends.
double gives(double load) { return 2.0 * load / (0.087 * 1e9 * 0.0115) / 0.087; }

} // namespace

TEST_CASE("a ratchet wins one tooth a stroke where its pawls can fall behind the teeth, and none where they cannot") {
  const double least = least_swing();
  CHECK(least / k_degree == doctest::Approx(17.8).epsilon(0.005)); // as the model says
  // Beside it by as much as the lever gives and the pawl takes to fall: 20 N m over 20 kN m/rad, and 1 mm by its weight in 14 ms.
  for (const double swing : {0.5 * least, least - 0.4 * k_degree, least + 0.4 * k_degree, 23.0 * k_degree, 40.0 * k_degree}) {
    CAPTURE(swing / k_degree);
    const MachineRun r = ratchet(swing);
    REQUIRE(r.is_complete());
    const double won = swing > least ? k_pitch : 0.0;
    const double first = r.at("wheel.theta", 1.5);
    CHECK(first < 0.0);
    CHECK(first > -gives(k_load));
    // Of a motion at a tolerance of 1e-6, on contacts that give by 1e-6 m.
    for (int stroke = 1; stroke < 4; ++stroke) CHECK(std::abs(r.at("wheel.theta", 1.5 + 2.0 * stroke) - first - stroke * won) < 2e-5);
  }
}

TEST_CASE("between strokes the second pawl holds the load, and what is won is the work of the hand") {
  for (const double load : {20.0, 5.0, 40.0}) {
    CAPTURE(load);
    const MachineRun r = ratchet(23.0 * k_degree, {"element.load.couple=" + std::to_string(-load), "simulation.tolerance=1e-8"});
    REQUIRE(r.is_complete());
    for (int stroke = 0; stroke < 3; ++stroke) { // while the lever is within 15 degrees on its way back, and until it is there again
      const double held = r.at("wheel.theta", 1.3 + 2.0 * stroke);
      for (double t = 0.85; t < 1.73; t += 0.05)
        CHECK(std::abs(r.at("wheel.theta", t + 2.0 * stroke) - held) < gives(load)); // of a tooth's 0.52
    }
    const auto energy = [&](double t) {
      return r.at("whole.kinetic", t) + r.at("whole.potential", t) + r.at("whole.dissipated", t) - r.at("whole.work", t);
    };
    const double work = r.at("hand.work", 7.5) - r.at("hand.work", 1.5);
    CHECK(std::abs(energy(7.5) - energy(1.5)) < 1e-5 * work);
    CHECK(std::abs(r.at("load.work", 7.5) - r.at("load.work", 1.5) + load * 3.0 * k_pitch) < 1e-3 * load); // by the angle of three teeth
    CHECK(work > load * 3.0 * k_pitch);
  }
}

TEST_CASE("without the second pawl nothing is won") {
  const MachineRun r = ratchet(23.0 * k_degree, {"element.pin of pawl 1.active=false"});
  REQUIRE(r.is_complete());
  CHECK(r.last("wheel.theta") < -k_pitch);
}
