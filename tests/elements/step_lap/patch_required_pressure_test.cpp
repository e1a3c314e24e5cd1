// u(W), its direction and its bounds.
#include "patch_cases.h"

#include "elements/step_lap/patch/required_pressure.h"

#include <doctest/doctest.h>

#include <Eigen/LU>

using namespace steplap;
using namespace steplap::patch_cases;

namespace {

/// Wrench of the size of the patch's capacity, in any direction, sometimes pure.
Vec3 random_wrench(Draw& draw, const Patch& patch) {
  Vec3 w(draw.within(-1, 1), draw.within(-1, 1), draw.sign() * draw.scale(1e-4, 1e2));
  const double kind = draw.unit();
  if (kind < 0.05) w[2] = 0;
  else if (kind < 0.1) w[0] = w[1] = 0;
  return w * patch.force();
}

/// A friction wrench known to be on the boundary, from counter-clockwise slip about c.
Vec3 slip_wrench(const Patch& patch, const Vec2& c) {
  const Vec2 arm = c - patch.reference();
  return -evaluate(patch, {arm.y(), -arm.x(), 1}).gradient;
}

// The error of u is the square of the residual (1e-10), so only h's own rounding shows.
constexpr double k_u = 1e-12;

} // namespace

TEST_CASE("required pressure: the gauge of the bearable wrenches") {
  Draw draw(41);
  int most = 0;
  Patch patch;
  Capacity limits;
  for (int i = 0; i < cases(100000); ++i) {
    if (i % 10 == 0) { // building one takes longer than asking it
      patch = patch_cases::patch(draw);
      limits = capacity(patch);
    }
    const Vec3 w = random_wrench(draw, patch);
    const RequiredPressure r = required_pressure(patch, w);
    REQUIRE(r.converged);
    most = std::max(most, r.evaluations);
    // attained by the direction, and exceeded by none
    CHECK(std::abs(w.dot(r.direction) / evaluate(patch, r.direction).h - r.u) < k_u * r.u);
    for (int k = 0; k < 4; ++k) {
      const Vec3 nu = draw.twist();
      CHECK(w.dot(nu) < r.u * evaluate_gradient(patch, nu).h * (1 + k_u));
    }
    // on the boundary after scaling, with the direction as its normal
    const Vec3 boundary = evaluate(patch, r.direction).gradient;
    const Vec3 scale(1, 1, 1 / reach(patch));
    CHECK((boundary - w / r.u).cwiseProduct(scale).norm() < 1e-8 * patch.force() * 10);
    const UsageBounds bounds = usage_bounds(limits, w);
    CHECK(bounds.lower < r.u * (1 + k_u));
    CHECK(bounds.upper > r.u * (1 - k_u));
  }
  MESSAGE("most evaluations from a cold start: " << most);
  CHECK(most < 60);
}

TEST_CASE("required pressure: u <= 1 exactly where the wrench is bearable") {
  // Wrenches made to be just inside and just outside, checked by support in many directions.
  Draw draw(42);
  for (int i = 0; i < cases(1000); ++i) {
    const Patch patch = patch_cases::patch(draw);
    const Vec3 nu = draw.twist(), boundary = evaluate(patch, nu).gradient;
    const double share = draw.within(0.5, 1.5);
    const Vec3 w = share * boundary;
    const RequiredPressure r = required_pressure(patch, w);
    CHECK(std::abs(r.u - share) < k_u * 10); // rounding of a wrench with h's
    bool bearable = w.dot(nu) <= evaluate(patch, nu).h;
    for (int k = 0; k < 500; ++k) {
      const Vec3 other = draw.twist();
      bearable = bearable && w.dot(other) <= evaluate_gradient(patch, other).h;
    }
    CHECK(bearable == (r.u <= 1));
  }
}

TEST_CASE("required pressure: agrees with (13)-(15) solved for p, x_c, y_c") {
  // Plain Newton from a point nearby, where the equations are regular: counter-clockwise slip
  // about a centre within a few sizes.
  Draw draw(43);
  int solved = 0;
  for (int i = 0; i < cases(2000); ++i) {
    const Patch patch = patch_cases::patch(draw);
    const Vec2 near = patch.centroid() + draw.point(2);
    const double share = draw.within(0.1, 3);
    const Vec3 w = share * slip_wrench(patch, near);
    const RequiredPressure r = required_pressure(patch, w);
    REQUIRE(r.centre.has_value());
    CHECK(r.direction[2] < 0); // slip is against it
    Vec3 x(share * 1.05, near.x() + 0.01, near.y() - 0.01);
    for (int k = 0; k < 30; ++k) {
      const Vec2 arm = Vec2(x[1], x[2]) - patch.reference();
      const Dissipation d = evaluate(patch, {arm.y(), -arm.x(), 1});
      Mat3 jacobian;
      jacobian << -d.gradient, x[0] * d.hessian.col(1), -x[0] * d.hessian.col(0);
      x -= jacobian.fullPivLu().solve(-x[0] * d.gradient - w);
    }
    if (!(std::abs(x[0] - share) < 1e-6)) continue; // plain Newton went elsewhere: nothing to compare with
    ++solved;
    CHECK(std::abs(x[0] - r.u) < 1e-10 * r.u); // Newton's own end, and that of the direction
  }
  CHECK(solved > cases(2000) * 8 / 10);
}

TEST_CASE("required pressure: ordinary special cases") {
  Patch patch({1, 0.5});
  const Polygon unit{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, {}};
  CHECK(std::isinf(required_pressure(patch, {1, 0, 0}).u));
  CHECK(required_pressure(patch, {0, 0, 0}).u == 0);
  patch.add(unit, 3.0);

  const RequiredPressure none = required_pressure(patch, Vec3::Zero());
  CHECK(none.u == 0);
  CHECK(none.direction.isZero(0));
  CHECK(!none.centre);
  CHECK(std::isinf(none.margin()));

  // What dies out exponentially comes to where its square is zero: there it is none; before, it is what it is.
  const RequiredPressure faint = required_pressure(patch, {-3.41196e-202, 1.90031e-228, 0});
  CHECK(faint.u == 0);
  CHECK(faint.residual == 0);
  CHECK(required_pressure(patch, {3e-140, 0, 0}).u == doctest::Approx(0.5e-140).epsilon(1e-12));

  const RequiredPressure push = required_pressure(patch, {3, 0, 0}); // through the centroid
  CHECK(std::abs(push.u - 0.5) < 1e-15);
  CHECK(!push.centre);

  const RequiredPressure couple = required_pressure(patch, {0, 0, -3 * 1.186466832});
  CHECK(std::abs(couple.u - 1) < 1e-9); // the table's decimals
  REQUIRE(couple.centre);
  CHECK((*couple.centre - Vec2(1, 0.5)).norm() < 1e-9);

  for (const double e : {1e-3, 1e-6, 1e-9, 1e-12}) { // nearly pure translation
    const RequiredPressure r = required_pressure(patch, {6, 0, 6 * e});
    CHECK(r.converged);
    CHECK(r.u > 1 - 1e-15);
    CHECK(r.u < 1 + 10 * e * e + 1e-15); // polar radius² / gyration² · e²
  }
  // far outside, and tiny: only the direction matters
  const RequiredPressure large = required_pressure(patch, {3e12, 1e12, 4e11});
  const RequiredPressure small = required_pressure(patch, {3e-12, 1e-12, 4e-13});
  CHECK(large.u == doctest::Approx(1e24 * small.u).epsilon(1e-12));
}

TEST_CASE("required pressure: a warm start saves work and changes nothing") {
  Draw draw(44);
  long cold = 0, warm = 0;
  for (int i = 0; i < cases(5000); ++i) {
    const Patch patch = patch_cases::patch(draw);
    const Vec3 w = random_wrench(draw, patch);
    const RequiredPressure before = required_pressure(patch, w);
    const Vec3 next = w + 1e-3 * w.norm() * Vec3(draw.within(-1, 1), draw.within(-1, 1), 0);
    const RequiredPressure a = required_pressure(patch, next);
    const RequiredPressure b = required_pressure(patch, next, before.direction);
    CHECK(b.converged);
    CHECK(std::abs(a.u - b.u) < k_u * a.u);
    cold += a.evaluations;
    warm += b.evaluations;
    // a misleading start does no harm
    const RequiredPressure c = required_pressure(patch, next, -before.direction);
    const RequiredPressure d = required_pressure(patch, next, draw.twist());
    CHECK(std::abs(c.u - a.u) < k_u * a.u);
    CHECK(std::abs(d.u - a.u) < k_u * a.u);
  }
  CHECK(warm < cold);
}
