// Stick-slip with known digits: a mass on a moving belt, and Den Hartog's forced oscillator.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// 1 kg on a spring of 100 N/m, pressed with its weight on a body "belt", μ = 0.3, not turning.
std::string oscillator(const std::string& belt_contact, const std::string& more) {
  return R"(
[[signal]]
name = "still"
kind = "constant"
value = 0.0
[[body]]
name = "mass"
mass = 1.0
inertia = 1.0
[[element]]
kind = "prescribed_motion"
name = "upright"
a = "mass"
coordinate = "angle"
signal = "still"
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [1.0, 0.0]
stiffness = 100.0
[[element]]
kind = "unilateral_contact"
name = "sole"
a = "mass"
stiffness = 1e5
damping = 100.0
preload = 9.81
)" + belt_contact +
         R"(
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["sole"]
static_friction = 0.3
)" + more;
}

std::string on_belt() {
  return oscillator("b = \"belt\"\n", R"(
[[signal]]
name = "speed"
kind = "constant"
value = 0.2
[[body]]
name = "belt"
mass = 5.0
inertia = 1.0
[[element]]
kind = "prismatic"
name = "rollers"
a = "belt"
[[element]]
kind = "prescribed_motion"
name = "motor"
a = "belt"
signal = "speed"
as = "velocity"
)");
}

std::string den_hartog() {
  return oscillator("", R"(
[[signal]]
name = "force"
kind = "harmonics"
amplitudes = [8.0]
frequencies = [0.47746482927568606]
[[element]]
kind = "load"
name = "push"
at = "mass"
force_x = "force"
)");
}

const std::vector<Settings>& methods(double end) {
  static std::vector<Settings> list;
  list = {{"rk4", 1e-4, end}, {"tsit5", 1e-12, end}, {"dop853", 1e-12, end}};
  return list;
}

} // namespace

TEST_CASE("a mass on a belt sticks, slips and then only grazes the belt's speed") {
  for (const Settings& settings : methods(3.0)) {
    CAPTURE(settings.integrator);
    const Run r = run(on_belt(), settings);
    const std::vector<double> sticks = r.event_times("friction", "sticks"), slips = r.event_times("friction", "slips backward");
    REQUIRE(!sticks.empty());
    REQUIRE(slips.size() >= 2);
    CHECK(slips[0] == 0.0); // the belt moves under it from the start
    CHECK(std::abs(sticks[0] - 0.0747188139815066) < 1e-11);
    CHECK(std::abs(slips[1] - 0.182668443438953) < 5e-11); // 20 N/s: 1e-9 N of bound
    CHECK(std::abs(r.last("mass.x") - 0.0314469318813080) < 1e-10);
    CHECK(std::abs(r.last("mass.vx") + 0.198980397472595) < 1e-10);
  }
  const Run r = run(on_belt(), {"dop853", 1e-12, 0.0747188139815066});
  CHECK(std::abs(r.last("mass.x") - 0.00784007410851070) < 1e-13);
}

TEST_CASE("Den Hartog's oscillator: twenty phases of slip and stick in ten seconds") {
  for (const Settings& settings : methods(10.0)) {
    CAPTURE(settings.integrator);
    const Run r = run(den_hartog(), settings);
    const std::vector<double> events = r.event_times("friction");
    const double expected[] = {0.0, 0.279920279335179, 0.851888409415235, 1.45131468114814, 1.97262699328603, 2.41252234708784};
    // rk4: (ωh)⁴/120 with ω = 10 rad/s, h = 1e-4 s: 1e-14 a radian; the rest is root finding
    REQUIRE(events.size() >= 6);
    for (int i = 0; i < 6; ++i) CHECK(std::abs(events[i] - expected[i]) < 1e-11);
    CHECK(events.size() == 20); // one for each phase, the first of which begins with the run
    CHECK(std::abs(r.last("mass.x") + 0.0363829137728667) < 1e-10);
    CHECK(std::abs(r.last("mass.vx") - 0.370762125122938) < 1e-9);
    const RunStatistics& s = r.result.statistics;
    CHECK(s.energy_residual < 1e-9 * s.energy_exchanged);
  }
}

TEST_CASE("the mode at the start is found: at rest, loaded beyond and within the bound") {
  // 8 N at t = 0 against 2.943 N: it slips at once; with μ = 0.9 it holds until the spring… never here.
  CHECK(run(den_hartog(), {"dop853", 1e-8, 1e-3}).last("friction.mode") == 2.0);
  Model held = parse_model(den_hartog() + "\n[simulation]\nstep = 1e-3\n", "scene.toml", transformer_catalog(),
                           {"element.friction.static_friction=0.9"});
  const Run r = run(held, {"dop853", 1e-10, 10.0, 0.1});
  CHECK(r.event_times("friction").empty());
  for (const double x : r.series("mass.x")) CHECK(std::abs(x) < 1e-12);
  for (std::size_t i = 0; i < r.times().size(); ++i)
    CHECK(std::abs(r.series("friction.friction")[i] + 8.0 * std::cos(3.0 * r.times()[i])) < 1e-9);
}
