// Slips that end: each end is found, by every method at every tolerance, and what a joint bore on the way is told right.
#include "tests/elements/step_lap/step_lap_scene.h"
#include "tests/random/slip_ends.h"
#include "tests/sanitized.h"

#include <doctest/doctest.h>

namespace {

step_lap_scene::Run run_data(const char* file, const std::string& method, const std::string& tolerance, const std::string& end) {
  return step_lap_scene::run(
      steplap::read_model(std::string(STEPLAP_TEST_DATA) + "/" + file, steplap::transformer_catalog(),
                          {"simulation.integrator=" + method, "simulation.tolerance=" + tolerance, "simulation.end=" + end}));
}

} // namespace

TEST_CASE("random sheets that slide, turn or both come to rest when and as an integration of their own says") {
  for (std::uint64_t seed = 1; seed <= (steplap::testing::k_is_sanitized ? 50 : 200); ++seed) {
    const auto scene = steplap::random::slip_end_scene(seed);
    CAPTURE(seed);
    CAPTURE(scene.integrator);
    CAPTURE(scene.tolerance);
    CHECK(steplap::random::disagreement(scene) == "");
  }
}

TEST_CASE("a slip that static friction stops and kinetic would turn is not stepped over") {
  const std::vector<const char*> tolerances =
      steplap::testing::k_is_sanitized ? std::vector{"1e-6"} : std::vector{"1e-5", "1e-6", "1e-8", "1e-10"};
  for (const char* method : {"auto", "dop853", "tsit5", "rodas5p"})
    for (const char* tolerance : tolerances) {
      CAPTURE(method);
      CAPTURE(tolerance);
      const auto ends = run_data("slip_past_its_end.toml", method, tolerance, "0.11").times("ste6", "sticks");
      REQUIRE(ends.size() == 1);
      CHECK(std::abs(ends[0] - 0.10048444127734) < 1e-6);
    }
}

TEST_CASE("rodas5p keeps the energy of a step that an event ends") {
  for (const char* file : {"shaken_box.toml", "hunt_crossley_block.toml"})
    for (const char* tolerance : {"1e-7", "1e-8", "1e-9"}) {
      CAPTURE(file);
      CAPTURE(tolerance);
      CHECK(run_data(file, "rodas5p", tolerance, "0.05").relative_energy_residual() < 1e-5);
    }
}
