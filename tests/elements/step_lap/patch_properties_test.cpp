// What every limit surface must be: convex, even, homogeneous, normal, additive (Goyal, Ruina and
// Papadopoulos, Wear 143, 1991), and the same wherever the scene stands.
#include "elements/step_lap/patch/far_field.h"
#include "patch_cases.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

using namespace steplap;
using namespace steplap::patch_cases;

namespace {

// Rounding of h: closed forms sum terms of up to |c|² size (c at 6 radii) to an area, for shapes
// whose area is at least a hundredth of the size squared; 1e-12 of force × speed covers them.
constexpr double k_rounding = 1e-12;

/// Left and right of the line through the centroid along `direction`.
std::pair<Polygon, Polygon> halves(const Polygon& convex, double angle) {
  const Vec2 c = centroid(convex), t(std::cos(angle), std::sin(angle)), n(-t.y(), t.x());
  const auto half = [&](double side) {
    const Vec2 far = 9 * t, deep = 9 * side * n;
    Polygon box{{c - far, c + far, c + far + deep, c - far + deep}, {}};
    OverlapWorkspace workspace;
    Region out;
    intersect(make_outline(convex), make_outline(box), {}, workspace, out);
    return out.at(0);
  };
  return {half(1), half(-1)};
}

} // namespace

TEST_CASE("patch: even, homogeneous, convex, normal") {
  Draw draw(31);
  Patch patch;
  for (int i = 0; i < cases(100000); ++i) {
    if (i % 10 == 0) // building one takes longer than asking it
      patch = patch_cases::patch(draw);
    const Vec3 nu = draw.twist(), eta = draw.twist();
    const Dissipation d = evaluate_gradient(patch, nu), e = evaluate_gradient(patch, eta);
    const double tolerance = k_rounding * patch.force() * (fastest(patch, nu) + fastest(patch, eta));

    const Dissipation back = evaluate_gradient(patch, -nu);
    CHECK(back.h == d.h); // the same arithmetic but for signs
    CHECK(back.gradient == -d.gradient);

    CHECK(std::abs(d.gradient.dot(nu) - d.h) < tolerance);               // Euler
    CHECK(evaluate_gradient(patch, nu + eta).h < d.h + e.h + tolerance); // convex
    // the wrench of ν is bearable, and no wrench resists η better than η's own
    CHECK(d.gradient.dot(eta) < e.h + tolerance);
    CHECK((d.gradient - e.gradient).dot(nu - eta) > -tolerance);
  }
}

TEST_CASE("patch: Hessian semidefinite with the twist in its null space") {
  Draw draw(32);
  Patch patch;
  for (int i = 0; i < cases(20000); ++i) {
    if (i % 10 == 0) patch = patch_cases::patch(draw);
    const Vec3 nu = draw.twist(), eta = draw.twist();
    const Dissipation d = evaluate(patch, nu);
    // Rounding of a closed form, 1e-12 of force/speed, through the arms of both twists.
    const double far = reach(patch), rim = eta.head<2>().norm() + far * std::abs(eta[2]);
    const double slow = std::max(1e-300, nu.head<2>().norm() + far * std::abs(nu[2]));
    CHECK(eta.dot(d.hessian * eta) > -1e-11 * patch.force() * rim * rim / slow);
    const Vec3 zero = d.hessian * nu;
    CHECK(zero.head<2>().norm() < 1e-11 * patch.force());
    CHECK(std::abs(zero[2]) < 1e-11 * patch.force() * far);
  }
  const Dissipation none = evaluate(patch, Vec3::Zero());
  CHECK(none.h == 0);
  CHECK(none.gradient.isZero(0));
  CHECK(none.hessian.isZero(0));
}

TEST_CASE("patch: the whole is the sum of its parts") {
  Draw draw(33);
  for (int i = 0; i < cases(20000); ++i) {
    const Polygon polygon{star(draw, 4 + draw.index(5), 1, 1), {}};
    const auto [left, right] = halves(polygon, draw.within(0, 6.3));
    const Vec2 reference = draw.point(1);
    Patch whole(reference), one(reference), other(reference), both(reference);
    whole.add(polygon, 1.5);
    one.add(left, 1.5);
    other.add(right, 1.5);
    both.add(Region{left, right}, 1.5);
    const Vec3 nu = draw.twist();
    const Dissipation w = evaluate(whole, nu), b = evaluate(both, nu);
    const Dissipation sum{evaluate(one, nu).h + evaluate(other, nu).h, b.gradient, b.hessian};
    // a half can be thin: rounding by the whole's size, not by the half's area
    const double tolerance = 1e-12 * fastest(whole, nu) * 1.5;
    CHECK(std::abs(w.h - b.h) < tolerance);
    CHECK(std::abs(b.h - sum.h) < tolerance);
    CHECK((w.gradient - b.gradient).norm() < 1e-12 * 1.5 * 4); // moments within two sizes' arm
  }
}

TEST_CASE("patch: a linear traction is the sum of its parts too") {
  // Two halves, each with its own centroid and the same field, against the whole.
  Draw draw(34);
  for (int i = 0; i < cases(5000); ++i) {
    const Polygon polygon{star(draw, 4 + draw.index(5), 1, 1), {}};
    const auto [left, right] = halves(polygon, draw.within(0, 6.3));
    const Vec2 c = centroid(polygon), gradient = draw.point(0.3);
    Patch whole, both;
    whole.add(polygon, Traction{1.5, gradient});
    for (const Polygon& half : {left, right}) both.add(half, Traction{1.5 + gradient.dot(centroid(half) - c), gradient});
    const Vec3 nu = draw.twist();
    const Dissipation w = evaluate(whole, nu), b = evaluate(both, nu);
    CHECK(std::abs(w.h - b.h) < 1e-12 * 2 * fastest(whole, nu));
    CHECK((w.gradient - b.gradient).norm() < 1e-12 * 2 * 4);
    CHECK(std::abs(whole.force() - both.force()) < 1e-13 * whole.force());
    CHECK((whole.centroid() - both.centroid()).norm() < 1e-13);
    CHECK(std::abs(whole.gyration() - both.gyration()) < 1e-12);
  }
}

// The overlaps of a stack lie over each other at a corner: a prepared patch expands them together.
TEST_CASE("patch: pieces that lie over each other, taken together or one by one") {
  Draw draw(37);
  for (int i = 0; i < cases(200); ++i) {
    Patch alone, together;
    for (const Vec2& corner : {Vec2(0, 1.3), Vec2(0, -1.3)})
      for (int k = 0; k < 12; ++k) {
        const double length = 0.8 - 0.05 * (k % 4), q = 5e-3 * (k % 5 - 2), w = k % 5 == 4 ? 18e-3 : 4.5e-3;
        const Vec2 t = Vec2(1, corner.y() > 0 ? 1 : -1).normalized(), n(-t.y(), t.x());
        const auto at = [&](double s, double across) { return Vec2(corner + s * t + across * n); };
        const Polygon strip{{at(-0.5 * length, q), at(0.5 * length, q), at(0.5 * length - w, q + w), at(w - 0.5 * length, q + w)}, {}};
        const Traction traction{1e5 * (1 + k), k % 3 == 0 ? Vec2(1e4, -2e4) : Vec2(0, 0)};
        alone.add(strip, traction);
        together.add(strip, traction);
      }
    together.prepare();
    for (int j = 0; j < 50; ++j) {
      Vec3 nu = draw.twist();
      if (j % 2 == 0) nu[2] *= 0.05; // far centres of rotation
      const Dissipation a = evaluate(alone, nu), b = evaluate(together, nu);
      const double size = together.force() * fastest(together, nu), speed = nu.head<2>().norm() + std::abs(nu[2]);
      CHECK(std::abs(a.h - b.h) < k_rounding * size);
      CHECK((a.gradient - b.gradient).norm() * speed < 10 * k_rounding * size);
      CHECK((a.hessian - b.hessian).norm() * speed * speed < 1e-9 * size); // curvature near a piece loses digits
    }
  }
}

// Patches that are not prepared are integrated node by node where the centre of rotation is far, along each side with as many
// nodes as it takes; prepared ones are expanded. Both leave rounding alone, which a fan with dents and holes sums a few times.
TEST_CASE("patch: integrated node by node as by the expansion, at every distance") {
  Draw draw(38);
  for (int i = 0; i < cases(20000); ++i) {
    const Polygon polygon = draw.coin() ? convex_polygon(draw) : concave_polygon(draw);
    Patch once(centroid(polygon)), prepared(centroid(polygon));
    const Traction traction{1, draw.coin() ? draw.point(0.3) : Vec2(0, 0)};
    once.add(polygon, traction);
    prepared.add(polygon, traction);
    prepared.prepare();
    const double size = once.pieces()[0].radius, angle = draw.within(0, 6.3);
    const double ratio = i % 10 == 0 ? draw.scale(1, 1e18) : draw.scale(1 + 1e-9, 60);
    const Vec3 nu(std::cos(angle), std::sin(angle), draw.sign() / (ratio * k_far_ratio * size));
    const Dissipation a = evaluate(once, nu), b = evaluate(prepared, nu);
    const double rounding = 1e-14 * once.force();
    CHECK(std::abs(a.h - b.h) < rounding);
    CHECK((a.gradient - b.gradient).head<2>().norm() < rounding);
    CHECK(std::abs(a.gradient[2] - b.gradient[2]) < rounding * size);
    CHECK((a.hessian - b.hessian).topLeftCorner<2, 2>().norm() < rounding);
    CHECK((a.hessian - b.hessian).topRightCorner<2, 1>().norm() < rounding * size);
    CHECK(std::abs(a.hessian(2, 2) - b.hessian(2, 2)) < rounding * size * size);
    // about another centre, with a circle of its own, and without a patch
    Patch spare;
    const Vec3 g = gradient_about(polygon, traction, centroid(polygon), centroid(polygon), nu, spare);
    CHECK((g - a.gradient).head<2>().norm() < k_rounding * once.force()); // its circle may be wider: the closed form's, then
    CHECK(std::abs(g[2] - a.gradient[2]) < k_rounding * once.force() * size);
  }
}

TEST_CASE("patch: moving and turning the scene, and the point of reference, change nothing") {
  Draw draw(35);
  for (int i = 0; i < cases(10000); ++i) {
    const Polygon polygon = convex_polygon(draw);
    const Pose at = pose(draw, 2);
    Polygon there = polygon;
    for (Vec2& p : there.outer) p = placed(p, at);
    const Vec2 reference = draw.point(1);
    Patch here(reference), moved(placed(reference, at));
    here.add(polygon, 1);
    moved.add(there, 1);
    const Vec3 nu = draw.twist();
    const double c = std::cos(at.theta), s = std::sin(at.theta);
    const Vec3 turned(c * nu[0] - s * nu[1], s * nu[0] + c * nu[1], nu[2]);
    const Dissipation a = evaluate_gradient(here, nu), b = evaluate_gradient(moved, turned);
    // coordinates up to 4 in the moved scene: rounding 4e-16 of them against a size of 1
    CHECK(std::abs(a.h - b.h) < 1e-12 * fastest(here, nu));
    // the wrench turns with the centre of rotation: rounding of c over its distance to a vertex
    CHECK(std::abs(a.gradient[2] - b.gradient[2]) < 1e-10);

    const Vec2 point = draw.point(1), arm = point - reference;
    const Dissipation other = evaluate_about(here, point, {nu[0] - nu[2] * arm.y(), nu[1] + nu[2] * arm.x(), nu[2]});
    CHECK(std::abs(a.h - other.h) < 1e-12 * fastest(here, nu));
  }
}

TEST_CASE("patch: unusable tractions are refused, empty pieces left out") {
  Patch patch;
  const Polygon unit{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}};
  CHECK_THROWS_AS(patch.add(unit, -1.0), std::invalid_argument);
  CHECK_THROWS_AS(patch.add(unit, std::nan("")), std::invalid_argument);
  CHECK_THROWS_AS(patch.add(unit, Traction{1.0, {3, 0}}), std::invalid_argument); // −0.5 at x = 0
  CHECK(patch.empty());
  patch.add(unit, 0.0);
  patch.add(Polygon{{{0, 0}, {1, 0}, {2, 0}}, {}}, 1.0);
  CHECK(patch.empty());
  patch.add(unit, 2.0);
  CHECK(patch.force() == 2);
  CHECK(patch.area() == 1);
  CHECK(patch.gyration() == doctest::Approx(1 / std::sqrt(6.0)).epsilon(1e-14));
  patch.clear({1, 0});
  CHECK(patch.empty());
  CHECK(patch.force() == 0);
}

// Stages that are rejected later may have no finite velocities. x^(n−2) < 2^-57 at the order n, as far as k_order reaches.
TEST_CASE("the order of the far field suffices, and is the highest one for what is no number") {
  CHECK(FarField::needed_order(std::numeric_limits<double>::quiet_NaN()) == FarField::k_order);
  CHECK(FarField::needed_order(1.0) == FarField::k_order);
  for (double x = 0x1p-56; x < 1.0; x *= 1.3) {
    const int n = FarField::needed_order(x);
    CAPTURE(x);
    CHECK((n == FarField::k_order || std::pow(x, n - 2) < 0x1p-57));
  }
}
