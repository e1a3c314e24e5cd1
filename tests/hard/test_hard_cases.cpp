// Every hard case under every integrator: the known answer, energy, constraints, no number that is
// none.
#include "tests/hard/hard_cases.h"

#include <doctest/doctest.h>

using namespace steplap::hard;

TEST_CASE("hard cases: every integrator gives the known answer") {
  for (const HardCase& hard_case : hard_cases())
    for (const std::string& integrator : integrators()) {
      CAPTURE(hard_case.name);
      CAPTURE(integrator);
      const double bound = bound_for(hard_case, integrator);
      const Outcome outcome = run(hard_case, integrator, true);
      CHECK(outcome.is_finite);
      // Does not claim the case, or is known to be unfit (docs/hard_cases.md): it only must not hang or give nonsense.
      if (bound == 0.0 || is_known_to_fail(hard_case, integrator)) continue;
      CAPTURE(outcome.failure);
      CHECK(outcome.failure.empty());
      CHECK(outcome.error <= bound);
      CHECK(outcome.statistics.max_position_residual < 1e-6); // before projection; after it 1e-12
    }
}
