// Are estimated errors honest? Error over estimate for every number of some machines and mechanisms, at coarse and fine
// settings of adaptive, fixed-step and time stepping methods. The whole table: the program honesty; docs/evidence/accuracy.md.
#include "tests/honest/honesty.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// The estimate rests on how errors follow tolerance and step, which they do within some factor, not exactly.
constexpr double k_most = 6.0;

void check(const Truth& truth, const std::string& integrator, double setting, double most) {
  CAPTURE(integrator);
  CAPTURE(setting);
  const Judged judged = truth.judged(integrator, setting);
  REQUIRE(judged.failure.empty());
  for (const Honesty& h : judged.kinds) {
    if (h.kind == "times of extremes") continue; // of two peaks as high within the error either may be named
    CAPTURE(h.kind);
    CAPTURE(h.where);
    CAPTURE(h.error);
    CAPTURE(h.estimate);
    CHECK(h.worst <= most);
    CHECK(h.unknown <= h.count / 10); // "unknown" for everything would be honest, too
  }
}

} // namespace

TEST_CASE("errors are not larger than estimated, but for a factor") {
  for (const char* file : {"/paper/no_interference.toml", "/layouts/three_limb.toml", "/benchmarks/stick_slip_belt.toml",
                           "/benchmarks/rocking_block.toml"}) {
    CAPTURE(std::string(file));
    const Truth truth(std::string(STEPLAP_MODELS) + file, 0.3);
    REQUIRE(truth.failure().empty());
    check(truth, "dop853", 1e-6, k_most);
    check(truth, "dop853", 1e-8, k_most);
    check(truth, "tsit5", 1e-6, k_most);
    check(truth, "rodas5p", 1e-6, k_most);
    check(truth, "rk4", 2e-4, k_most);
  }
}

TEST_CASE("time stepping: of first order, events known to some steps") {
  for (const char* file : {"/paper/no_interference.toml", "/benchmarks/bouncing_mass.toml"}) {
    CAPTURE(std::string(file));
    const Truth truth(std::string(STEPLAP_MODELS) + file, 0.2);
    check(truth, "moreau", 2e-4, k_most);
  }
}
