// What 'auto' costs beside the better of the two methods that it chooses from, counted in evaluations.
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <string>

using namespace steplap;
using namespace steplap::testing;
using steplap::random::RandomNumber;

namespace {

constexpr int k_scenes = 100;
constexpr double k_worse = 4.0; // an explicit method that is tried now and then, and trials of the implicit one
constexpr long k_some = 3000;   // evaluations, before anything can be known
constexpr long k_most = 200000; // a method that needs more is not the better one

// A light pad, pressed on a wagon that goes to and fro: its mode is as fast as the motion or up to 10⁶ times as fast, and damped.
std::string pad_on_wagon(RandomNumber& r) {
  const auto number = [](double value) { return random::number(value); };
  const double mass = r.decades(-7.0, 1.0), stiffness = r.decades(3.0, 7.0), damping = std::sqrt(mass * stiffness) * r.decades(-1.0, 1.0);
  return "[[body]]\nname = \"wagon\"\nmass = 1.0\ninertia = 1.0\n[[element]]\nkind = \"prismatic\"\nname = \"rail\"\na = \"wagon\"\n"
         "[[element]]\nkind = \"spring_damper\"\nname = \"buffer\"\na = \"wagon\"\naxis = [1.0, 0.0]\nstiffness = " +
         number(r.decades(2.0, 4.0)) + "\n[[signal]]\nname = \"shove\"\nkind = \"harmonics\"\namplitudes = [5.0]\nfrequencies = [" +
         number(r.between(1.0, 9.0)) +
         "]\n[[element]]\nkind = \"load\"\nname = \"shover\"\nat = \"wagon\"\nforce_x = \"shove\"\n"
         "[[body]]\nname = \"pad\"\nmass = " +
         number(mass) + "\ninertia = 1.0\nposition = [0.0, " + number(r.between(-2.0, 2.0)) +
         "]\n"
         "[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"pad\"\nb = \"wagon\"\naxis = [0.0, 1.0]\n"
         "[[element]]\nkind = \"unilateral_contact\"\nname = \"press\"\na = \"pad\"\nb = \"wagon\"\nnormal = [0.0, 1.0]\npreload = "
         "20.0\nstiffness = " +
         number(stiffness) + "\ndamping = " + number(damping) +
         "\n[[signal]]\nname = \"push\"\nkind = \"constant\"\nvalue = -20.0\n[[element]]\nkind = \"load\"\nname = \"pusher\"\nat = "
         "\"pad\"\nforce_y = \"push\"\n";
}

// Of a run to its end; infinite where it needs more than k_most or stops.
double evaluations(const System& system, const std::string& integrator, double tolerance, double end, long most) {
  Settings settings{integrator, tolerance, end, 0.0};
  try {
    Simulation simulation(system, system.initial_state(), options(settings));
    while (simulation.advance())
      if (simulation.statistics().evaluations > most) return std::numeric_limits<double>::infinity();
    return static_cast<double>(simulation.statistics().evaluations);
  } catch (const NumericalFailure&) {
    return std::numeric_limits<double>::infinity();
  }
}

} // namespace

TEST_CASE("auto costs a few times the better method at most, at all tolerances") {
  int stiff = 0, soft = 0;
  for (int seed = 1; seed <= k_scenes; ++seed) {
    RandomNumber r(static_cast<std::uint64_t>(seed));
    const auto system = compile(scene(pad_on_wagon(r) + "\n[simulation]\nstep = 1e-3\n"));
    const double tolerance = r.decades(-11.5, -5.0), end = r.between(0.1, 0.6);
    const double forward = evaluations(*system, "dop853", tolerance, end, k_most),
                 implicit = evaluations(*system, "rodas5p", tolerance, end, k_most);
    const double better = std::min(forward, implicit);
    if (!(better < k_most)) continue;
    ++(implicit < forward ? stiff : soft);
    INFO("seed " << seed << ", tolerance " << tolerance << ": dop853 " << forward << ", rodas5p " << implicit);
    CHECK(evaluations(*system, "auto", tolerance, end, 10 * k_most) <= k_worse * better + k_some);
  }
  CHECK(stiff >= k_scenes / 4);
  CHECK(soft >= k_scenes / 8);
}
