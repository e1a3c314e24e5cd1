// Convex quadratic problems with bounds (mbd/events/box_problem.h): against the conditions that make a minimum.
#include "mbd/events/box_problem.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace steplap;

namespace {

// g against w at a bound, no g inside; `rounding` of the terms of g.
void check_minimum(const MatX& a, const VecX& b, const VecX& c, const BoxSolution& s, double rounding) {
  REQUIRE(s.is_solved);
  const VecX g = a * s.w + b;
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    CAPTURE(i);
    const double terms = a.row(i).cwiseAbs().dot(s.w.cwiseAbs()) + std::abs(b[i]);
    CHECK(std::abs(s.w[i]) <= c[i]);
    CHECK(std::abs(s.g[i] - g[i]) <= rounding * terms);
    if (std::abs(s.w[i]) < c[i]) CHECK(std::abs(g[i]) <= rounding * terms);
    else CHECK(s.w[i] * g[i] <= rounding * terms * c[i]);
  }
}

} // namespace

TEST_CASE("bounded quadratic problems end at a minimum, of full rank or not") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    CAPTURE(trial);
    const int n = 1 + trial % 8, rank = 1 + trial % 5;
    MatX j(n, rank);
    VecX b(n), c(n);
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < rank; ++k) j(i, k) = number(random);
      b[i] = number(random);
      c[i] = trial % 3 == 0 && i == 0 ? 0.0 : std::abs(number(random)); // one without any friction, now and then
    }
    const MatX a = j * j.transpose();
    // A is known to rounding, and where rows depend on each other to 1e-11 of their length (k_dependent).
    check_minimum(a, b, c, solve_box_problem(a, b, c, VecX::Constant(n, 1e-14)), 1e-10);
  }
}

TEST_CASE("two feet of one body share what one bound bears, and slide beyond it") {
  MatX a(2, 2);
  a << 1.0, 1.0, 1.0, 1.0;
  const VecX c = VecX::Constant(2, 3.0), rounding = VecX::Constant(2, 1e-14);
  const BoxSolution held = solve_box_problem(a, VecX::Constant(2, -5.0), c, rounding);
  REQUIRE(held.is_solved);
  CHECK(held.w.sum() == doctest::Approx(5.0).epsilon(1e-12));
  const BoxSolution slides = solve_box_problem(a, VecX::Constant(2, -7.0), c, rounding);
  REQUIRE(slides.is_solved);
  CHECK(slides.w.isApprox(c, 1e-15));
  CHECK(slides.g.isApprox(VecX::Constant(2, -1.0), 1e-12));
  CHECK_FALSE(slides.is_free[0]);
}

// Three feet side by side on a box of 95 kg that is off the level by 2.5e-5: what the outer ones answer apart from each other is
// 3e-9 of what they answer together, and the middle one's row is the mean of theirs. The mode problem at the end of a swing.
TEST_CASE("three feet of a body that has hardly turned: the minimum is found, not the rounding of the way there") {
  for (const double tilt : {2.45367703e-5, 3e-4, 1e-5})
    for (const double wide : {1.0, 0.5, 1.7}) {
      CAPTURE(tilt);
      CAPTURE(wide);
      MatX a(3, 3);
      VecX b(3), c(3);
      const double lever[3] = {0.3961983 - 0.5971321 * tilt, 0.3961983, 0.3961983 + 0.5971321 * tilt};
      for (int i = 0; i < 3; ++i) {
        b[i] = 5.5439743917528732 - 49.0 * (lever[i] - lever[1]);
        for (int k = 0; k < 3; ++k) a(i, k) = 1.0 / 95.11844 + lever[i] * lever[k] / 14.00286;
      }
      c << 316.921, 472.912 * wide, 505.071;
      check_minimum(a, b, c, solve_box_problem(a, b, c, VecX::Constant(3, 1.8e-11)), 1e-11);
    }
}

TEST_CASE("a coordinate that drives alone decide slides at its bound") {
  const MatX a = MatX::Zero(1, 1);
  const BoxSolution s = solve_box_problem(a, VecX::Constant(1, 0.5), VecX::Constant(1, 2.0), VecX::Constant(1, 1e-14));
  REQUIRE(s.is_solved);
  CHECK(s.w[0] == -2.0);
  CHECK_FALSE(s.is_free[0]);
}

TEST_CASE("sets of bounds that repeat themselves end, and are told") {
  // Of no convex problem (its determinant is −6), as rounding could make one: freeing the first coordinate drives it back to
  // the bound it was taken from. No set is right, and the caller has to know, not to wait.
  MatX a(2, 2);
  a << 3.0, -3.0, -3.0, 1.0;
  VecX b(2), c(2);
  b << 0.0, 3.0;
  c << 1.0, 1.0;
  const BoxSolution s = solve_box_problem(a, b, c, VecX::Zero(2));
  CHECK_FALSE(s.is_solved);
  for (Eigen::Index i = 0; i < 2; ++i) CHECK(std::abs(s.w[i]) <= c[i]);
}

// Ropes: bounded on one side only. Their conditions say all: w ≤ 0, A w + b ≤ 0, one of them zero.
TEST_CASE("bounds on one side: what pulls does not push") {
  unsigned seed = 7;
  const auto number = [&seed] {
    seed = seed * 1664525U + 1013904223U;
    return static_cast<double>(seed >> 8U) / 8388608.0 - 1.0;
  };
  for (int round = 0; round < 200; ++round) {
    const Eigen::Index n = 1 + round % 6;
    MatX j(n, 4); // beyond 4 rows they depend on each other
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k < 4; ++k) j(i, k) = number();
    const MatX a = j * j.transpose();
    VecX v(4);
    for (Eigen::Index k = 0; k < 4; ++k) v[k] = number();
    const VecX b = j * v; // what dependent rows are off by depends likewise
    const VecX lower = VecX::Constant(n, -std::numeric_limits<double>::infinity());
    const BoxSolution s = solve_box_problem(a, b, lower, VecX::Zero(n), VecX::Constant(n, 1e-13));
    REQUIRE(s.is_solved);
    for (Eigen::Index i = 0; i < n; ++i) {
      CHECK(s.w[i] <= 0.0);
      CHECK(s.g[i] <= 1e-9); // the condition of rows of 4 random numbers
      CHECK(std::abs(s.w[i] * s.g[i]) <= 1e-8 * (1.0 + std::abs(s.w[i])));
    }
  }
}
