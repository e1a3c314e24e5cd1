// The least overloaded sharing against closed forms, duality and brute force over the vertices of small problems.
#include "mbd/dynamics/least_usage.h"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <random>

using namespace steplap;

namespace {

// Intervals, and ellipsoids wᵀ S⁻² w ≤ 1 with S = diag(size) for parts of three dimensions.
struct Sets final : Gauges {
  std::vector<Vec3> size;
  [[nodiscard]] double support(int part, const double* rate) const override {
    if (size[part][1] == 0.0) return size[part][0] * std::abs(rate[0]);
    return size[part].cwiseProduct(Vec3::Map(rate)).norm();
  }
  double gauge(int part, const double* wrench, double* normal) const override {
    const Vec3 w = Vec3::Map(wrench).cwiseQuotient(size[part]);
    const double u = w.norm();
    Vec3::Map(normal) = u > 0.0 ? Vec3(w.cwiseQuotient(size[part]) / u) : Vec3(1.0 / size[part][0], 0.0, 0.0);
    return u;
  }
};

struct Problem {
  Sets sets;
  std::vector<int> dimension, pivots;
  MatX basis;
  VecX wrench;
  [[nodiscard]] LeastUsage make() const {
    return {dimension, basis, pivots, std::vector<double>(static_cast<std::size_t>(basis.rows()), 1.0)};
  }
};

// `is_integer`: entries of −1, 0, 1 and equal capacities, so that corners coincide.
Problem random_problem(int rows, int unknowns, bool is_integer, std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::uniform_int_distribution<int> sign(-1, 1);
  Problem p;
  p.dimension.assign(static_cast<std::size_t>(rows), 1);
  p.basis = MatX::Zero(rows, unknowns);
  p.wrench.resize(rows);
  for (int r = 0; r < rows; ++r) {
    p.sets.size.emplace_back(is_integer ? 1.0 : 1.5 + unit(generator), 0.0, 0.0);
    p.wrench[r] = is_integer ? sign(generator) : unit(generator);
    for (int j = 0; j < unknowns; ++j)
      p.basis(r, j) = r < unknowns ? (r == j ? 1.0 : 0.0) : (is_integer ? sign(generator) : unit(generator));
  }
  for (int j = 0; j < unknowns; ++j) p.pivots.push_back(j);
  return p;
}

double usage_at(const Problem& p, const VecX& z) {
  const VecX w = p.wrench + p.basis * z;
  double most = 0.0;
  for (Eigen::Index r = 0; r < w.size(); ++r) most = std::max(most, std::abs(w[r]) / p.sets.size[static_cast<std::size_t>(r)][0]);
  return most;
}

// The least over all vertices of {(z, u): |w_r| ≤ u c_r}: every choice of unknowns + 1 rows and signs.
double brute_force(const Problem& p) {
  const int rows = static_cast<int>(p.basis.rows()), k = static_cast<int>(p.basis.cols());
  double best = usage_at(p, VecX::Zero(k));
  std::vector<int> choice(static_cast<std::size_t>(rows), 0);
  std::fill(choice.end() - (k + 1), choice.end(), 1);
  do
    for (int signs = 0; signs < 1 << (k + 1); ++signs) {
      MatX a(k + 1, k + 1);
      VecX right(k + 1);
      int i = 0;
      for (int r = 0; r < rows; ++r) {
        if (choice[static_cast<std::size_t>(r)] == 0) continue;
        const double s = signs >> i & 1 ? 1.0 : -1.0;
        a.row(i).head(k) = s * p.basis.row(r);
        a(i, k) = -p.sets.size[static_cast<std::size_t>(r)][0];
        right[i++] = -s * p.wrench[r];
      }
      const Eigen::FullPivLU<MatX> lu(a);
      if (!lu.isInvertible()) continue;
      best = std::min(best, usage_at(p, lu.solve(right).head(k)));
    }
  while (std::next_permutation(choice.begin(), choice.end()));
  return best;
}

void check_certificate(const Problem& p, const LeastUsage& least) {
  // Rounding of k pivots; the sharing carries the load, and the mechanism gives the same bound from below.
  const double exact = 1e-12;
  CHECK(least.usage() - least.lower() <= exact * least.usage());
  const VecX moved = least.wrench() - p.wrench - p.basis * least.coefficients();
  CHECK(moved.norm() < exact * (1.0 + p.wrench.norm()));
  CHECK((p.basis.transpose() * least.rates()).norm() < 1e-11);
  CHECK(std::abs(least.rates().dot(p.wrench) - least.lower()) < exact);
  // Only parts at the bound move, and the way they are loaded.
  Eigen::Index row = 0;
  double taken = 0.0;
  for (std::size_t e = 0; e < p.dimension.size(); row += p.dimension[e++]) {
    const VecX rate = least.rates().segment(row, p.dimension[e]), wrench = least.wrench().segment(row, p.dimension[e]);
    taken += p.sets.support(static_cast<int>(e), rate.data());
    if (rate.norm() == 0.0) continue;
    const double power = rate.dot(wrench), most = p.sets.support(static_cast<int>(e), rate.data());
    CHECK(std::abs(power - most * least.usage()) < 1e-6); // of 1 in all: curved sets are met to the root of rounding
  }
  CHECK(std::abs(taken - 1.0) < exact * 10.0);
}

} // namespace

TEST_CASE("least usage: two that share one load use it in proportion to their capacities") {
  // λ₁ + λ₂ = F: u = F/(c₁ + c₂), both at once.
  Problem p;
  p.sets.size = {{3.0, 0.0, 0.0}, {5.0, 0.0, 0.0}};
  p.dimension = {1, 1};
  p.basis.resize(2, 1);
  p.basis << -1.0, 1.0;
  p.pivots = {1};
  p.wrench.resize(2);
  p.wrench << 6.0, 0.0;
  LeastUsage least = p.make();
  least.solve(p.sets, p.wrench);
  CHECK(least.usage() == doctest::Approx(6.0 / 8.0).epsilon(1e-15));
  CHECK(least.wrench()[0] == doctest::Approx(2.25).epsilon(1e-15));
  CHECK(least.wrench()[1] == doctest::Approx(3.75).epsilon(1e-15));
  CHECK(least.rates().minCoeff() > 0.0);
}

TEST_CASE("least usage: random intervals against all vertices, also where many vertices coincide") {
  std::mt19937 generator(5);
  for (const bool is_integer : {false, true})
    for (const auto& [rows, unknowns] : {std::pair{3, 1}, {4, 2}, {6, 2}, {6, 3}, {7, 4}})
      for (int draw = 0; draw < 20; ++draw) {
        const Problem p = random_problem(rows, unknowns, is_integer, generator);
        LeastUsage least = p.make();
        least.solve(p.sets, p.wrench);
        const double expected = brute_force(p);
        if (least.usage() <= LeastUsage::k_surely_holds) {
          CHECK(expected <= least.usage() + 1e-12);
          continue;
        }
        CHECK(std::abs(least.usage() - expected) < 1e-12); // of about 1: rounding of a few pivots
        check_certificate(p, least);
      }
}

TEST_CASE("least usage: many parts, certified from both sides") {
  std::mt19937 generator(6);
  for (const bool is_integer : {false, true})
    for (const int unknowns : {10, 30}) {
      Problem p = random_problem(2 * unknowns, unknowns, is_integer, generator);
      p.wrench *= 3.0;
      LeastUsage least = p.make();
      least.solve(p.sets, p.wrench);
      check_certificate(p, least);
    }
}

TEST_CASE("least usage: curved sets, certified, and two equal ones side by side share in halves") {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int draw = 0; draw < 20; ++draw) {
    Problem p;
    p.sets.size = {Vec3(1.0, 2.0, 0.5), Vec3(1.0, 2.0, 0.5), Vec3(0.7 + 0.5 * unit(generator), 0.0, 0.0)};
    p.dimension = {3, 3, 1};
    p.basis = MatX::Zero(7, 4);
    p.basis.topLeftCorner(3, 3).setIdentity();
    p.basis.block(3, 0, 3, 3) = -MatX::Identity(3, 3);
    // The interval carries part of the first one's load along a direction of its own.
    for (int r = 0; r < 3; ++r) p.basis(r, 3) = unit(generator);
    p.basis.block(0, 3, 3, 1) *= draw % 2 == 0 ? 0.0 : 1.0;
    p.basis(6, 3) = 1.0;
    if (draw % 2 != 0) // the interval's column alone has an entry in its row: pivots as they have to be
      p.basis.block(3, 3, 3, 1).setZero();
    p.pivots = {3, 4, 5, 6};
    p.wrench.setZero(7);
    for (int r = 0; r < 3; ++r) p.wrench[r] = 4.0 * unit(generator);
    LeastUsage least = p.make();
    least.solve(p.sets, p.wrench);
    check_certificate(p, least);
    if (draw % 2 == 0) {
      const Vec3 half = 0.5 * p.wrench.head(3);
      double normal[3];
      CHECK(std::abs(least.usage() - p.sets.gauge(0, half.data(), normal)) < 1e-12);
    }
  }
}

TEST_CASE("least usage: the reported sharing is admissible as long as one is, and proportional where it can be") {
  // A lever of three supports: forces in the middle and moments balance, one unknown.
  Problem p;
  p.dimension = {1, 1, 1};
  p.basis.resize(3, 1);
  p.basis << 1.0, -2.0, 1.0;
  p.pivots = {0};
  for (const double middle : {0.2, 1.0, 5.0})
    for (double load = 0.1; load < 12.0; load += 0.1) {
      p.sets.size = {{1.0, 0.0, 0.0}, {middle, 0.0, 0.0}, {3.0, 0.0, 0.0}};
      p.wrench.resize(3);
      p.wrench << 0.6 * load, 0.0, 0.4 * load;
      LeastUsage least = p.make();
      least.solve(p.sets, p.wrench);
      const double reported = usage_at(p, least.settled());
      if (least.usage() <= 1.0) CHECK(reported <= 1.0 + 1e-12);
      else CHECK(reported <= least.usage() * (1.0 + 1e-12));
    }
}
