// The limit surface against published and exact values of simple shapes.
//
// Disc: F and T of a uniform disc by complete elliptic integrals (Goyal, Ruina and Papadopoulos,
// Wear 143, 1991; Weidman and Malhotra, PRL 95, 264303, 2005, for the terminal ratio 0.653).
// Rectangle: Eqs. (13)-(15) of the paper in closed form.
#include "patch_cases.h"

#include "elements/step_lap/patch/required_pressure.h"

#include <doctest/doctest.h>

#include <array>

using namespace steplap;

namespace {

Patch rectangle(double a, double b) {
  Patch patch;
  patch.add(Polygon{{{-a, -b}, {a, -b}, {a, b}, {-a, b}}, {}}, 1.0);
  return patch;
}

/// The friction wrench of counter-clockwise slip about c, as the paper writes it: −∇h.
Vec3 slip_wrench(const Patch& patch, const Vec2& c) { return -evaluate(patch, {c.y(), -c.x(), 1}).gradient; }

/// Regular polygon of n sides with the area of the unit disc.
Patch disc(int n) {
  const double step = 2 * std::numbers::pi / n;
  const double radius = std::sqrt(2 * std::numbers::pi / (n * std::sin(step)));
  Ring ring;
  for (int i = 0; i < n; ++i) ring.emplace_back(radius * std::cos(i * step), radius * std::sin(i * step));
  Patch patch;
  patch.add(Polygon{ring, {}}, 1 / std::numbers::pi); // capacity 1
  return patch;
}

struct DiscFriction {
  double force, torque;
};

/// At v/(Rω) = ratio, extrapolated to infinitely many sides. With equal areas the error is a
/// series in n⁻², but for centres on the rim, whose logarithm leaves n⁻⁴ log n: 1e-9 at 512.
DiscFriction disc_friction(double ratio) {
  static const std::array discs{disc(128), disc(256), disc(512)};
  std::array<Vec3, 3> w;
  for (std::size_t i = 0; i < 3; ++i) w[i] = evaluate(discs[i], {ratio, 0, 1}).gradient;
  const Vec3 first = w[1] + (w[1] - w[0]) / 3, second = w[2] + (w[2] - w[1]) / 3;
  const Vec3 limit = second + (second - first) / 15;
  return {limit[0], limit[2]};
}

constexpr double k_eight_digits = 1e-8; // the tables are given to eight or nine decimals

} // namespace

TEST_CASE("patch: rectangle table") {
  struct Case {
    double a, b, xc, fx, fy, m;
  };
  const Case table[] = {
      {.5, .5, 0, 0, 0, -.382597858},           {.5, .5, .25, 0, .432602324, -.329043384},
      {.5, .5, .5, 0, .790228819, -.198119006}, {.5, .5, 1, 0, .953435466, -.089985042},
      {1, .5, 0, 0, 0, -1.186466832},           {5, .5, 0, 0, 0, -25.319151189},
  };
  for (const Case& c : table) {
    const Vec3 w = slip_wrench(rectangle(c.a, c.b), {c.xc, 0});
    CAPTURE(c.xc);
    CHECK(std::abs(w[0] - c.fx) < 1e-9); // nine decimals
    CHECK(std::abs(w[1] - c.fy) < 1e-9);
    CHECK(std::abs(w[2] - c.m) < 1e-9);
  }
  const double exact = -(std::sqrt(2.0) + std::asinh(1.0)) / 6;
  CHECK(std::abs(slip_wrench(rectangle(.5, .5), {0, 0})[2] - exact) < 1e-15); // four edges' rounding
}

TEST_CASE("patch: disc table") {
  const double table[][3] = {{.1, .09987484, .66167605},   {.25, .24803131, .63578612}, {.5, .48384376, .54774835},
                             {.653, .61603194, .47169447}, {.75, .69267323, .41798322}, {.9, .79575931, .33321169},
                             {1.5, .94081938, .17379811},  {2, .96768751, .12780920},   {5, .99497468, .05016857},
                             {1, .848826363, .282942121}};
  for (const auto& [ratio, force, torque] : table) {
    const DiscFriction d = disc_friction(ratio);
    CAPTURE(ratio);
    CHECK(std::abs(d.force - force) < k_eight_digits);
    CHECK(std::abs(d.torque - torque) < k_eight_digits);
  }
  CHECK(std::abs(disc_friction(0).torque - 2.0 / 3) < k_eight_digits);
}

TEST_CASE("patch: a disc that slides and spins keeps the ratio 0.653 to the end") {
  // v' = −F, (Rω)' = −T/k² with k² = 1/2: the ratio ε stays where F = 2εT.
  double low = 0.5, high = 0.8;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    const DiscFriction d = disc_friction(middle);
    (d.force < 2 * middle * d.torque ? low : high) = middle;
  }
  // F − 2εT crosses zero with slope about 0.3: errors of 1e-9 in F and T move the root by 1e-8.
  CHECK(std::abs(low - 0.6530017892) < 3e-8);
}

TEST_CASE("patch: the ellipsoid overstates what a disc can bear by up to 7 %") {
  const double torque0 = disc_friction(0).torque;
  const auto radial = [&](double ratio) {
    const DiscFriction d = disc_friction(ratio);
    return std::hypot(d.force, d.torque / torque0); // 1 on the ellipsoid
  };
  // three decimals are given
  CHECK(std::abs(radial(.1) - .9975) < 5e-5);
  CHECK(std::abs(radial(.5) - .954) < 5e-4);
  CHECK(std::abs(radial(.75) - .934) < 5e-4);
  CHECK(std::abs(radial(1) - .949) < 5e-4);
  CHECK(std::abs(radial(1.5) - .976) < 5e-4);
  double least = 1;
  for (double ratio = 0.05; ratio < 3; ratio += 0.01) least = std::min(least, radial(ratio));
  CHECK(1 / least > 1.065);
  CHECK(1 / least < 1.075);
}

TEST_CASE("patch: the paper's joint") {
  // One limb: two mitred corners, 1165 interfaces each, μ = 0.25, p = 0.10 MPa.
  Patch patch;
  OverlapWorkspace workspace;
  for (const double k : {1.0, -1.0}) {
    const double r = std::sqrt(0.5), length = r, lap = 0.01;
    const Vec2 corner(-0.25, 1.15 * k), t(r, r * k), n(r, -r * k);
    const auto sheet = [&](double s0, double s1, double q0, double q1) {
      const auto at = [&](double s, double q) -> Vec2 { return corner + s * t + q * n; };
      return make_outline({{at(s0, q0), at(s1, q0), at(s1, q1), at(s0, q1)}, {}});
    };
    const Outline limb = sheet(0, length, -lap / 2, 0.05);
    const Outline yoke = sheet(-0.02, length + 0.02, -0.05, lap / 2);
    Region overlap;
    intersect(yoke, limb, {}, workspace, overlap);
    patch.add(overlap, 1165 * 0.25 * 0.10e6);
  }
  CHECK(std::abs(patch.force() - 411.9e3) < 0.05e3); // given to 0.1 kN
  CHECK(std::abs(patch.force() - 2 * 1165 * 0.25e5 * 0.01 * std::sqrt(0.5)) < 1e-7);
  const RequiredPressure rest = required_pressure(patch, {0, 88290, 0});
  CHECK(std::abs(rest.u * 100 - 21.4354) < 5e-5); // kPa, given to six digits
  CHECK(!rest.centre.has_value());
  CHECK(rest.direction.isApprox(Vec3(0, 1, 0), 1e-9));
}
