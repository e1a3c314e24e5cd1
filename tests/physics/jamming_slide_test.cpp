// Friction on a guide's reaction has two answers where the guide is rigid; pads that give way tell which.
#include "tests/physics/scene.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

Run begun_at(double angle, double end) {
  Run r;
  r.system = compile(read_model(STEPLAP_MODELS "/machines/jamming_slide.toml", transformer_catalog()));
  State start = r.system->initial_state();
  start.q[5] = angle;
  r.result = simulate(*r.system, start, options({"auto", 1e-8, end}));
  return r;
}

} // namespace

// f = φ F/(1 + κ) with κ = 2 μ c/L = 1.2, φ = 2 μ e/L = 0.6. The pads' vibration at the start, ζ = 0.15 at 3300 /s, is over after
// 20 ms; what it did to the mean friction until then is of the size of the tilt times speed over its period, 1e-5.
TEST_CASE("a slide that stands level goes on with the friction of the closed form") {
  const Run r = begun_at(0.0, 0.2);
  CHECK(r.last("slide.ax") == doctest::Approx((100.0 - 60.0 / 2.2) / 10.0).epsilon(1e-6));
  CHECK(r.last("slide.vx") == doctest::Approx(1.0 + 0.2 * 7.2727272727).epsilon(1e-4));
}

TEST_CASE("begun beyond the tilt of the other answer its pads bite, short of it they do not") {
  CHECK(begun_at(-0.8e-4, 0.008).last("slide.vx") > 0.99);
  CHECK(begun_at(-1.5e-4, 0.008).last("slide.vx") < 0.5);
}
