// Every hard case under every integrator: the known answer, energy, constraints, no number that is
// none.
#include "tests/hard/hard_cases.h"
#include "tests/sanitized.h"

#include <doctest/doctest.h>

using namespace steplap::hard;

namespace {

// Under the sanitizers each case is run by some of the methods in turn: that they are right is for the optimised build.
#ifdef STEPLAP_TESTS_SANITIZED
constexpr std::size_t k_every = 5;
#else
constexpr std::size_t k_every = 1;
#endif

} // namespace

TEST_CASE("hard cases: every integrator gives the known answer") {
  std::size_t turn = 0;
  for (const HardCase& hard_case : hard_cases())
    for (const std::string& integrator : integrators()) {
      if (++turn % k_every != 0) continue;
#ifdef STEPLAP_TESTS_SANITIZED // some 3e5 steps, each with a dozen evaluations
      if (hard_case.file == "belt_cycles" && is_first_order(integrator)) continue;
#endif
      CAPTURE(hard_case.name);
      CAPTURE(integrator);
      const double bound = bound_for(hard_case, integrator);
      const Outcome outcome = run(hard_case, integrator, true);
      CHECK(outcome.is_finite == outcome.failure.empty());
      // Does not claim the case: it only must not hang or give nonsense.
      if (bound == 0.0) continue;
      CAPTURE(outcome.failure);
      CHECK(outcome.failure.empty());
      CHECK(outcome.error <= bound);
      CHECK(outcome.statistics.max_position_residual < 1e-6); // before projection; after it 1e-12
    }
}

// A foot that dips by d: an amplitude off by δ changes the time of contact by the share δ/(2 d), here 5e8 δ over the
// stroke. So the time is no measure of a method; the depth is, and follows the tolerance. The dip, a thousandth of a
// step long, is never missed as long as d is above the tolerance.
TEST_CASE("hard cases: the depth of a graze follows the tolerance") {
  const auto of = [](const char* unit) {
    for (const HardCase& hard_case : hard_cases())
      if (hard_case.file == "graze" && hard_case.unit == unit) return hard_case;
    return HardCase{};
  };
  for (const std::string integrator : {"tsit5", "dop853", "rodas5p", "auto"}) {
    CAPTURE(integrator);
    for (const double tolerance : {1e-10, 1e-12}) {
      const std::vector<std::string> setting = {"simulation.tolerance=" + std::string(tolerance < 1e-11 ? "1e-12" : "1e-10")};
      const Outcome depth = run(of("stroke"), integrator, true, setting);
      CHECK(depth.error <= 5.0 * tolerance); // errors of steps add up over some twenty radians, less what methods gain
      const Outcome time = run(of("time of contact"), integrator, true, setting);
      // δ/(2 d), and as much again for the middle of the dip; beyond the first order a little more.
      CHECK(time.error <= 2.2 * depth.error / (2.0 * 1e-9) + 1e-5);
    }
  }
}
