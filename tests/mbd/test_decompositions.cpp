// Each decomposition by what it is made for: the product of its parts, or the residual of its solution. Entries are of order one
// and matrices small: 1e-12 is some thousand roundings.
#include "mbd/base/decompositions.h"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>

using namespace steplap;

namespace {

constexpr double k_close = 1e-12;

// Numbers between −1 and 1.
MatX scattered(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  MatX m(rows, columns);
  unsigned at = seed;
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) {
      at = at * 1664525u + 1013904223u;
      m(i, j) = static_cast<double>(at >> 8) / 8388608.0 - 1.0;
    }
  return m;
}

double largest(const MatX& m) { return m.size() > 0 ? m.cwiseAbs().maxCoeff() : 0.0; }
bool is_orthonormal(const MatX& q) { return largest(q.transpose() * q - MatX::Identity(q.cols(), q.cols())) < k_close; }

} // namespace

TEST_CASE("Q R without pivots") {
  const MatX a = scattered(6, 4, 1);
  const auto [q, r] = qr_of(a, 4);
  CHECK(is_orthonormal(q));
  CHECK(largest(q * r - a) < k_close);
  CHECK(r(2, 1) == 0.0);
  CHECK(largest(orthonormal(a, 6).leftCols(4) - q) < k_close);
  CHECK(is_orthonormal(orthonormal(a, 6)));
  const VecX b = scattered(6, 1, 2);
  const auto [triangle, turned] = triangle_of(a, b);
  CHECK(largest(triangle - r) == 0.0);
  CHECK(largest(turned - q.transpose() * b) < k_close);
}

TEST_CASE("Q R with pivots: rank, what no column reaches, null vectors, solutions") {
  MatX a = scattered(5, 4, 3);
  a.col(2) = 0.5 * a.col(0) - 2.0 * a.col(3);
  const PivotedQr qr(a, 1e-9);
  REQUIRE(qr.rank() == 3);
  CHECK(qr.length(0) == doctest::Approx(a.col(qr.column(0)).norm()));
  CHECK(qr.length(0) >= qr.length(1));
  CHECK(is_orthonormal(qr.complement()));
  CHECK(qr.complement().cols() == 2);
  CHECK(largest(qr.complement().transpose() * a) < k_close);
  const auto null = qr.null_space(1e-11);
  REQUIRE(null.pivots.size() == 1);
  CHECK(null.vectors(null.pivots[0], 0) == 1.0);
  CHECK(largest(a * null.vectors) < k_close);
  CHECK(null.vectors(1, 0) == 0.0); // that column takes no part
  const MatX right = a * scattered(4, 2, 4);
  CHECK(largest(a * qr.solve_by_rank(right) - right) < k_close);
  CHECK(largest(a * PivotedQr(a).solve(right) - right) < 1e-10); // of columns that depend on each other but for rounding
}

TEST_CASE("matrices without rows or columns have rank 0") {
  const PivotedQr none(MatX(0, 3), 1e-9), nothing(MatX(3, 0), 1e-9);
  CHECK(none.rank() == 0);
  CHECK(largest(none.null_space(1e-11).vectors - MatX::Identity(3, 3)) == 0.0);
  CHECK(none.null_space(1e-11).pivots.size() == 3);
  CHECK(nothing.rank() == 0);
  CHECK(largest(nothing.complement() - MatX::Identity(3, 3)) == 0.0);
}

TEST_CASE("least squares leave what is orthogonal to all columns; the shortest solution is in the span of the rows") {
  const MatX a = scattered(6, 3, 5);
  const VecX b = scattered(6, 1, 6);
  CHECK(largest(a.transpose() * (a * least_squares(a, b) - b)) < k_close);
  const MatX wide = a.transpose();
  const VecX c = scattered(3, 1, 7), x = shortest_solution(wide, c, 1e-9);
  CHECK(largest(wide * x - c) < k_close);
  CHECK(largest(orthonormal(a, 6).rightCols(3).transpose() * x) < k_close);
}

TEST_CASE("solutions by triangles") {
  const MatX a = scattered(5, 5, 8), right = scattered(5, 2, 9);
  const VecX b = scattered(5, 1, 10);
  const MatX spd = a * a.transpose() + MatX::Identity(5, 5), symmetric = a + a.transpose();
  const MatX inverse_lower = solve_lower(spd, MatX::Identity(5, 5));
  CHECK(largest(inverse_lower * spd * inverse_lower.transpose() - MatX::Identity(5, 5)) < k_close);
  CHECK(largest(symmetric * solve_symmetric(symmetric, right) - right) < 1e-11);
  CHECK(largest(symmetric * solve_symmetric(symmetric, b) - b) < 1e-11);
  DenseLu lu;
  lu.factor(scattered(3, 3, 11)); // another size before
  lu.factor(a);
  CHECK(lu.least_pivot() > 0.0);
  VecX x(5);
  lu.solve(b, x);
  CHECK(largest(a * x - b) < k_close);
  CHECK(largest(lu.solve(b) - x) == 0.0);
  CHECK(largest(a.transpose() * lu.solve_transposed(b) - b) < k_close);
  MatX twice(5, 5);
  twice << a.topRows(4), a.row(0);
  const MatX possible = twice * right;
  CHECK(largest(twice * RankLu(twice).solve(possible) - possible) < k_close);
  const Eigen::MatrixXcd complex = a.cast<std::complex<double>>() + std::complex<double>(0.0, 1.0) * spd.cast<std::complex<double>>();
  const Eigen::VectorXcd z = solve_complex(complex, b.cast<std::complex<double>>());
  CHECK((complex * z - b.cast<std::complex<double>>()).norm() < k_close);
}

TEST_CASE("eigenvalues and singular values") {
  const MatX a = scattered(5, 5, 12), symmetric = a + a.transpose();
  const auto [values, vectors] = symmetric_eigen(symmetric);
  CHECK(is_orthonormal(vectors));
  CHECK(largest(symmetric * vectors - vectors * values.asDiagonal()) < k_close);
  CHECK(values[0] <= values[4]);
  const Eigenpairs pairs = eigenpairs(a);
  REQUIRE(pairs.is_converged);
  CHECK((a.cast<std::complex<double>>() * pairs.vectors - pairs.vectors * pairs.values.asDiagonal()).norm() < k_close);
  CHECK(std::abs(pairs.values.sum() - a.trace()) < k_close);
  CHECK((eigenvalues(a) - pairs.values).norm() < k_close);
  const MatX wide = scattered(3, 5, 13);
  const RightSingular singular = right_singular(wide);
  REQUIRE(singular.v.cols() == 3);
  CHECK(is_orthonormal(singular.v));
  CHECK(largest((wide * singular.v).colwise().norm().transpose() - singular.values) < k_close);
  CHECK(singular.values[0] >= singular.values[2]);
}
