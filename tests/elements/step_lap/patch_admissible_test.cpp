// The friction wrench of one joint: optimality, onset, and singular mobilities.
#include "patch_cases.h"

#include "elements/step_lap/patch/admissible_projection.h"

#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::patch_cases;

namespace {

/// Symmetric, positive semidefinite, of the given rank, scaled to the patch.
Mat3 mobility(Draw& draw, const Patch& patch, int rank) {
  Mat3 a = Mat3::Zero();
  const double size = reach(patch);
  for (int k = 0; k < rank; ++k) {
    const Vec3 row(draw.within(-1, 1), draw.within(-1, 1), draw.within(-1, 1) / size);
    a += row * row.transpose();
  }
  return a / patch.force();
}

// The dual's residual is 1e-11 of the capacity; the wrench is the gradient at η, the acceleration
// what A makes of z, so the law of motion holds to that times A, and u to that.
constexpr double k_optimal = 1e-10;

void check_optimal(const Patch& patch, const Mat3& a, const Vec3& b, const AdmissibleWrench& r) {
  const Vec3 scale(1, 1, reach(patch)); // angular parts as speeds at the rim
  REQUIRE(r.converged);
  CHECK(r.residual <= 1e-10); // what is told of the solution: of the gauge where it sticks, else of the dual
  const double u = required_pressure(patch, r.wrench).u;
  CHECK(u < 1 + k_optimal);
  const Vec3 rest = a * r.wrench + b - r.acceleration;
  const Mat3 stiffest = scale.asDiagonal() * a * scale.asDiagonal();
  const double size = stiffest.norm() * patch.force() + (scale.asDiagonal() * b).norm();
  CHECK((scale.asDiagonal() * rest).norm() < k_optimal * size);
  if (r.slips) {
    CHECK(std::abs(u - 1) < k_optimal);
    // friction opposes the slip with all it has: −η in the normal cone of W
    const double h = evaluate(patch, r.acceleration).h;
    CHECK(std::abs(r.wrench.dot(r.acceleration) + h) < k_optimal * h);
  } else {
    CHECK(r.acceleration.isZero(0));
  }
}

} // namespace

TEST_CASE("admissible wrench: optimal for regular mobilities") {
  Draw draw(51);
  int slips = 0, most = 0;
  Patch patch;
  for (int i = 0; i < cases(30000); ++i) {
    if (i % 10 == 0) patch = patch_cases::patch(draw);
    const Mat3 a = mobility(draw, patch, 4);
    const Vec3 b = draw.scale(1e-2, 1e3) * Vec3(draw.within(-1, 1), draw.within(-1, 1), draw.within(-1, 1) / reach(patch));
    const AdmissibleWrench r = admissible_wrench(patch, a, b);
    check_optimal(patch, a, b, r);
    slips += r.slips;
    most = std::max(most, r.evaluations);
  }
  CHECK(slips > cases(5000));
  CHECK(slips < cases(29000));
  MESSAGE("most evaluations: " << most);
}

TEST_CASE("admissible wrench: loads that exceed the bound by no more than rounding") {
  // A square pushed along x by its capacity, where the slip's acceleration is rounding of its terms: the wrench is the
  // bound's, not some other.
  const double half = 0.3, traction = 2.5e6, force = 4.0 * half * half * traction;
  Patch square;
  square.add(Polygon{{{-half, -half}, {half, -half}, {half, half}, {-half, half}}, {}}, traction);
  const Mat3 a = Vec3(1e-7, 1e-7, 1.0 / 7e6).asDiagonal();
  for (const double excess : {1e-16, 3e-16, 1e-15, 4e-14, 1e-13, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4}) {
    CAPTURE(excess);
    const Vec3 b(a(0, 0) * force * (1.0 + excess), 0.0, 0.0);
    const AdmissibleWrench r = admissible_wrench(square, a, b);
    check_optimal(square, a, b, r);
    CHECK(std::abs(r.wrench[0] + force) < 1e-10 * force);
    CHECK(std::abs(r.wrench[2]) < 1e-10 * force * half);
  }
  Draw draw(53);
  Patch patch;
  for (int i = 0; i < cases(10000); ++i) {
    if (i % 10 == 0) patch = patch_cases::patch(draw);
    const Mat3 any = mobility(draw, patch, 4);
    const Vec3 w(draw.within(-1, 1), draw.within(-1, 1), draw.within(-1, 1) * reach(patch));
    const double excess = draw.scale(1e-16, 1e-2);
    const Vec3 b = any * w * (excess + 1.0) / required_pressure(patch, w).u;
    check_optimal(patch, any, b, admissible_wrench(patch, any, b));
  }
}

TEST_CASE("admissible wrench: optimal for singular mobilities, held or not") {
  Draw draw(52);
  Patch patch;
  for (int i = 0; i < cases(20000); ++i) {
    if (i % 10 == 0) patch = patch_cases::patch(draw);
    const Mat3 a = mobility(draw, patch, 1 + draw.index(2));
    Vec3 b(draw.within(-1, 1), draw.within(-1, 1), draw.within(-1, 1) / reach(patch));
    if (draw.coin()) // a free acceleration that some wrench could hold
      b = a * Vec3(b[0], b[1], b[2]) * patch.force() * draw.scale(1e-2, 1e2);
    check_optimal(patch, a, b, admissible_wrench(patch, a, b));
  }
}

TEST_CASE("admissible wrench: at the onset of slip") {
  // Just inside the wrench is the one that holds; just outside it is the same to the excess.
  Draw draw(53);
  for (int i = 0; i < cases(1000); ++i) {
    const Patch patch = patch_cases::patch(draw);
    const Mat3 a = mobility(draw, patch, 5);
    const Vec3 nu = draw.twist(), boundary = evaluate(patch, nu).gradient;
    const Vec3 scale(1, 1, 1 / reach(patch));
    for (const double excess : {-1e-3, -1e-9, 1e-9, 1e-6, 1e-3}) {
      const Vec3 b = -a * boundary * (1 + excess);
      const AdmissibleWrench r = admissible_wrench(patch, a, b);
      check_optimal(patch, a, b, r);
      CHECK(r.slips == (excess > 0));
      const Vec3 off = (r.wrench - boundary).cwiseProduct(scale);
      // the set is convex and the projection in the norm of A: within the excess times A's spread
      if (excess < 0) CHECK(off.norm() < 2 * std::abs(excess) * patch.force() + 1e-9 * patch.force());
    }
  }
}

TEST_CASE("admissible wrench: a block on a plane is Coulomb's") {
  // Force through the centroid, no coupling: |F| = μN against the slip, or what holds it.
  Patch patch({0.5, 0.5});
  patch.add(Polygon{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}}, 10.0); // μN = 10 N
  Mat3 a = Mat3::Zero();
  a.diagonal() << 0.5, 0.5, 3; // 2 kg, 1/3 kg m²
  const AdmissibleWrench holds = admissible_wrench(patch, a, {4, 0, 0});
  CHECK(!holds.slips);
  CHECK((holds.wrench - Vec3(-8, 0, 0)).norm() < 1e-13);
  const AdmissibleWrench slips = admissible_wrench(patch, a, {9, 0, 0});
  CHECK(slips.slips);
  CHECK((slips.wrench - Vec3(-10, 0, 0)).norm() < 1e-12);
  CHECK((slips.acceleration - Vec3(4, 0, 0)).norm() < 1e-12);

  const AdmissibleWrench nothing = admissible_wrench(patch, a, Vec3::Zero());
  CHECK(!nothing.slips);
  CHECK(nothing.wrench.isZero(0));
  patch.clear({0, 0});
  const AdmissibleWrench apart = admissible_wrench(patch, a, {9, 0, 0});
  CHECK(apart.slips);
  CHECK(apart.wrench.isZero(0));
  CHECK(apart.acceleration == Vec3(9, 0, 0));
}
