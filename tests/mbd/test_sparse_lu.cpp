// Sparse factors against dense ones: the same solutions, while numbers change, pivots vanish and
// patterns change.
#include "mbd/integrators/sparse_lu.h"

#include <Eigen/LU>
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

using namespace steplap;

namespace {

struct MatrixPosition {
  int row, column;
};

// A few entries in each row and column, some places twice; the diagonal may be missing.
std::vector<MatrixPosition> random_pattern(int n, std::mt19937& random) {
  std::uniform_int_distribution<int> any(0, n - 1);
  std::vector<MatrixPosition> entries;
  for (int i = 0; i < n; ++i) {
    entries.push_back({i, (i + 1) % n}); // a cycle: not singular by its structure
    if (i % 3 != 0) entries.push_back({i, i});
    for (int k = 0; k < 3; ++k) entries.push_back({any(random), i});
  }
  return entries;
}

// Largest error of A x = b, relative; -1 if the matrix was found singular.
double error(SparseLu& lu, int n, const std::vector<MatrixPosition>& entries, const std::vector<double>& values) {
  MatX a = MatX::Zero(n, n);
  lu.begin(n);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    a(entries[k].row, entries[k].column) += values[k];
    lu.add(entries[k].row, entries[k].column, values[k]);
  }
  if (!lu.factor()) return -1.0;
  const VecX x = VecX::LinSpaced(n, 1.0, 2.0);
  VecX found = a * x;
  lu.solve(found.data());
  const double condition = 1.0 / a.partialPivLu().rcond();
  return (found - x).cwiseAbs().maxCoeff() / condition;
}

std::vector<double> random_values(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<double> values(count);
  for (double& value : values) value = any(random);
  return values;
}

} // namespace

TEST_CASE("sparse factors solve as dense ones do, through changes of numbers and patterns") {
  std::mt19937 random(7);
  SparseLu lu;
  for (const int n : {1, 2, 5, 40, 40, 120, 40}) {
    CAPTURE(n);
    std::vector<MatrixPosition> entries = random_pattern(n, random);
    for (int repeat = 0; repeat < 20; ++repeat) {
      if (repeat == 8) entries.push_back({0, n - 1}); // one entry more
      if (repeat == 12) std::swap(entries.front(), entries.back());
      if (repeat == 16) entries.pop_back();
      // Rounding of elimination with pivots that are a thousandth of what there is, at worst.
      const double e = error(lu, n, entries, random_values(entries.size(), random));
      CHECK(e >= 0.0);
      CHECK(e <= 1e-12);
    }
  }
}

TEST_CASE("sparse factors choose other pivots where those of before vanish, and tell of singular "
          "matrices") {
  SparseLu lu;
  const std::vector<MatrixPosition> entries = {{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  CHECK(error(lu, 2, entries, {1.0, 2.0, 3.0, 4.0}) <= 1e-15);
  CHECK(error(lu, 2, entries, {0.0, 2.0, 3.0, 4.0}) <= 1e-15);
  CHECK(error(lu, 2, entries, {3.0, 4.0, 0.0, 2.0}) <= 1e-15); // the pivot of before is zero
  CHECK(error(lu, 2, entries, {1.0, 2.0, 2.0, 4.0}) == -1.0);
  CHECK(error(lu, 2, entries, {0.0, 0.0, 1.0, 2.0}) == -1.0);
  CHECK(error(lu, 2, entries, {1.0, 2.0, 3.0, std::numeric_limits<double>::quiet_NaN()}) == -1.0);
  CHECK(error(lu, 2, entries, {1.0, 2.0, 3.0, 4.0}) <= 1e-15);
}

TEST_CASE("the halves of a solution multiply to it") {
  std::mt19937 random(11);
  const int n = 60;
  const std::vector<MatrixPosition> entries = random_pattern(n, random);
  SparseLu lu;
  for (int repeat = 0; repeat < 3; ++repeat) { // the second time with the pivots of the first
    const std::vector<double> values = random_values(entries.size(), random);
    REQUIRE(error(lu, n, entries, values) >= 0.0);
    MatX a = MatX::Zero(n, n);
    for (std::size_t k = 0; k < entries.size(); ++k) a(entries[k].row, entries[k].column) += values[k];
    const Eigen::PartialPivLU<MatX> dense(a);
    for (const int row : {0, 17, 59})
      for (const int column : {3, 17, 58}) {
        const int rows[2] = {row, (row + 5) % n}, columns[1] = {column};
        const double b[2] = {2.0, -3.0}, c[1] = {1.5};
        SparseVectors halves;
        lu.append_forward(rows, b, 2, halves);
        lu.append_backward(columns, c, 1, halves);
        VecX right = VecX::Zero(n), forward = VecX::Zero(n), backward = VecX::Zero(n), found(n);
        for (int i = 0; i < 2; ++i) right[rows[i]] += b[i];
        for (std::size_t e = 0; e < halves.begin[1]; ++e) forward[halves.place[e]] = halves.value[e];
        for (std::size_t e = halves.begin[1]; e < halves.begin[2]; ++e) backward[halves.place[e]] = halves.value[e];
        CHECK(std::is_sorted(halves.place.begin(), halves.place.begin() + static_cast<std::ptrdiff_t>(halves.begin[1])));
        const VecX expected = dense.solve(right);
        lu.finish(forward.data(), found.data());
        const double tolerance = 1e-12 * expected.cwiseAbs().maxCoeff() / dense.rcond(); // as above
        CHECK((found - expected).cwiseAbs().maxCoeff() <= tolerance);
        CHECK(std::abs(backward.dot(forward) - c[0] * expected[column]) <= tolerance);
      }
  }
}
