// What stops a run rather than let it go on with nonsense, each provoked.
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "tests/transformer/swing.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <string>

using namespace steplap;

namespace {

std::string failure_of(const std::string& text, const std::vector<std::string>& overrides) {
  const Model model = parse_model(text, "scene.toml", transformer_catalog(), overrides);
  const auto system = compile(model);
  try {
    (void)simulate(*system, system->initial_state(), options_of(model));
  } catch (const NumericalFailure& failure) {
    return failure.what();
  }
  return "";
}

bool says(const std::string& message, const std::string& part) {
  CAPTURE(message);
  return message.find(part) != std::string::npos;
}

const std::string k_swing = swing("[simulation]\nend = 1.0\nstep = 0.01\nintegrator = \"rk4\"\n", "1", "158");

} // namespace

TEST_CASE("rk4 far beyond stability stops, by its energy or because the motion became infinite") {
  CHECK(failure_of(k_swing, {}).empty()); // ω h = 0.13
  // ω h = 10: the first step alone takes the velocity to 1 − (ωh)²/2 + (ωh)⁴/24 = 368 times what it was.
  CHECK(says(failure_of(k_swing, {"element.spring.stiffness=1e6"}), "turned over: its result is not to be trusted"));
  // (ωh)⁴ = 1e352 is no number: the step goes from 1 m/s to none at all.
  const std::string infinite = failure_of(k_swing, {"element.spring.stiffness=1e180"});
  CHECK(says(infinite, "the motion became infinite at t = 0.01 s"));
  CHECK(says(infinite, "'rk4' is unstable with steps of 0.01 s here"));
  CHECK(says(infinite, "try a smaller step, or rodas5p"));
}

TEST_CASE("moreau: a step without an end is halved as long as that may help, then stops and says so") {
  // 1e200 N on 1e-200 kg: no acceleration that is a number, however short the step.
  const std::string pulled = k_swing + "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"mass\"\nforce = [1e200, 0.0]\n";
  const std::string message = failure_of(pulled, {"simulation.integrator=moreau", "body.mass.mass=1e-200"});
  CHECK(says(message, "a time step at t = 0 s, halved down to "));
  CHECK(says(message, "has no consistent end: "));
}
