// In place of mbd/events/box_problem.cpp: no problem is ever solved, as if its set of bounds repeated itself. This executable then
// decides all friction by the sweeps that are kept for that, and all cases of test_friction_modes.cpp must come out the same.
#include "mbd/events/box_problem.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

namespace {

long asked = 0;

} // namespace

steplap::BoxSolution steplap::solve_box_problem(const MatX& a, const VecX& b, const VecX& c, const VecX& rounding) {
  return solve_box_problem(a, b, -c, c, rounding);
}

steplap::BoxSolution steplap::solve_box_problem(const MatX& /*a*/, const VecX& b, const VecX& lower, const VecX& /*upper*/,
                                                const VecX& /*rounding*/) {
  ++asked;
  BoxSolution wrong; // not to be used
  wrong.w = lower;
  wrong.g = VecX::Constant(b.size(), 1e3);
  wrong.is_free.assign(static_cast<std::size_t>(b.size()), 0);
  return wrong;
}

TEST_CASE("sweeps decide friction where the problem with bounds has no end") {
  const long before = asked;
  const std::string text = R"(
[simulation]
step = 1e-3
[[body]]
name = "box"
mass = 2.0
inertia = 1.0
[[element]]
kind = "unilateral_contact"
name = "sole"
a = "box"
stiffness = 1e5
damping = 400.0
preload = 19.62
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["sole"]
static_friction = 0.5
[[element]]
kind = "load"
name = "push"
at = "box"
force = [12.0, 0.0]
)";
  const steplap::testing::Run r = steplap::testing::run(steplap::testing::scene(text), {"rk4", 1e-3, 0.1});
  CHECK(asked > before);
  CHECK(r.last("box.ax") == doctest::Approx((12.0 - 9.81) / 2.0).epsilon(1e-9));
}
