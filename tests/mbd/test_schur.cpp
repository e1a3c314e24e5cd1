// The solver of the constraint equations against dense algebra: random rows between random bodies, rows
// that depend on others, locked coordinates, loops.
#include "mbd/base/diagnostics.h"
#include "mbd/base/types.h"
#include "mbd/dynamics/schur.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <doctest/doctest.h>

#include <random>

using namespace steplap;

namespace {

struct Problem {
  std::vector<SchurRow> rows;
  MatX j, w; ///< rows × 3·bodies; diagonal inverse masses
  [[nodiscard]] MatX matrix() const { return j * w * j.transpose(); }
};

// `rows` rows, each between two of `bodies` bodies or one and the ground; some coordinates locked.
Problem random_problem(int rows, int bodies, double locked_share, std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::uniform_int_distribution<int> pick(-1, bodies - 1);
  Problem p;
  p.j = MatX::Zero(rows, 3 * bodies);
  p.w = MatX::Zero(3 * bodies, 3 * bodies);
  for (int i = 0; i < 3 * bodies; ++i) p.w(i, i) = 0.5 * (unit(generator) + 1.0) < locked_share ? 0.0 : std::exp(2.0 * unit(generator));
  for (int r = 0; r < rows; ++r) {
    SchurRow row;
    do {
      row.body[0] = pick(generator);
      row.body[1] = pick(generator);
    } while (row.body[0] == row.body[1]);
    for (int side = 0; side < 2; ++side) {
      if (row.body[side] < 0) continue;
      for (int c = 0; c < 3; ++c) {
        const int k = 3 * row.body[side] + c;
        row.j[side][c] = p.j(r, k) = unit(generator);
        row.wj[side][c] = p.w(k, k) * row.j[side][c];
      }
    }
    p.rows.push_back(row);
  }
  return p;
}

void copy_row(Problem& p, int from, int to, double factor) {
  p.rows[to] = p.rows[from];
  p.j.row(to) = factor * p.j.row(from);
  for (int side = 0; side < 2; ++side)
    for (int c = 0; c < 3; ++c) {
      p.rows[to].j[side][c] *= factor;
      p.rows[to].wj[side][c] *= factor;
    }
}

VecX solve(SchurSolver& solver, const Problem& p, VecX right) {
  solver.factor(p.rows);
  solver.solve(p.rows, right.data());
  return right;
}

} // namespace

// Some rows act on further bodies, or once more on the same: their parts stand behind all rows, in any order.
TEST_CASE("constraint equations: rows over more than two bodies against a dense factorisation") {
  std::mt19937 generator(11);
  std::uniform_int_distribution<int> pick_parts(0, 3);
  for (int rows = 1; rows <= 24; ++rows)
    for (int draw = 0; draw < 6; ++draw) {
      const int bodies = rows + 2, behind = draw % 2 == 0 ? 0 : 3; // rows of others may stand between
      Problem p = random_problem(rows, bodies, 0.0, generator);
      for (int i = 0; i < behind; ++i) p.rows.emplace_back();
      std::vector<SchurPart> parts;
      for (int r = rows - 1; r >= 0; --r)
        for (int count = pick_parts(generator); count > 0; --count) {
          Problem more = random_problem(1, bodies, 0.0, generator);
          SchurRow& part = more.rows[0];
          for (int side = 0; side < 2; ++side)
            for (int c = 0; c < 3 && part.body[side] >= 0; ++c) {
              const int k = 3 * part.body[side] + c;
              p.j(r, k) += part.j[side][c];
              part.wj[side][c] = p.w(k, k) * part.j[side][c];
            }
          parts.push_back({static_cast<int>(p.rows.size()), r});
          p.rows.push_back(part);
        }
      const MatX a = p.matrix();
      const Eigen::SelfAdjointEigenSolver<MatX> eigen(a, Eigen::EigenvaluesOnly);
      const double condition = eigen.eigenvalues()[rows - 1] / std::max(1e-300, eigen.eigenvalues()[0]);
      if (condition > 1e6) continue;
      CAPTURE(rows);
      CAPTURE(draw);
      SchurSolver solver;
      solver.analyze(p.rows, rows, parts);
      const VecX wanted = VecX::Random(rows);
      VecX right = a * wanted;
      solver.factor(p.rows);
      solver.solve(p.rows, right.data());
      CHECK(!solver.is_singular());
      CHECK((right - wanted).norm() < 2e-15 * rows * condition * wanted.norm()); // as below, and that of the right-hand side
    }
}

// The dense way knows where a number stands by 16 bits; the sparse one has room.
TEST_CASE("constraint equations: parts too far behind are told, not lost") {
  std::mt19937 generator(12);
  for (const int rows : {1, 9}) {
    CAPTURE(rows);
    Problem p = random_problem(rows, rows + 1, 0.0, generator);
    std::vector<SchurPart> parts;
    for (int i = 0; i < 4000; ++i) { // each on a body of its own
      parts.push_back({static_cast<int>(p.rows.size()), 0});
      p.rows.emplace_back().body[0] = i;
    }
    SchurSolver solver;
    if (rows == 1) CHECK_THROWS_AS(solver.analyze(p.rows, rows, parts), NumericalFailure);
    else CHECK_NOTHROW(solver.analyze(p.rows, rows, parts));
  }
}

TEST_CASE("constraint equations: independent rows of all sizes against a dense factorisation") {
  std::mt19937 generator(1);
  int compared = 0;
  for (int rows = 1; rows <= 40; ++rows)
    for (int draw = 0; draw < 10; ++draw) {
      Problem p = random_problem(rows, std::max(2, rows), 0.0, generator);
      const MatX a = p.matrix();
      const double condition = [&] {
        const Eigen::SelfAdjointEigenSolver<MatX> eigen(a, Eigen::EigenvaluesOnly);
        return eigen.eigenvalues()[rows - 1] / std::max(1e-300, eigen.eigenvalues()[0]);
      }();
      if (condition > 1e6) continue;
      ++compared;
      SchurSolver solver;
      solver.analyze(p.rows);
      const VecX right = VecX::Random(rows);
      const VecX expected = a.ldlt().solve(right), x = solve(solver, p, right);
      CHECK(!solver.is_singular());
      // Rounding of a factorisation: rows · 1e-16 · condition.
      CHECK((x - expected).norm() < 1e-15 * rows * condition * expected.norm());
      // New numbers in the same pattern.
      for (SchurRow& row : p.rows)
        for (int side = 0; side < 2; ++side)
          for (int c = 0; c < 3; ++c) {
            row.j[side][c] *= 1.5;
            row.wj[side][c] *= 1.5;
          }
      CHECK((2.25 * solve(solver, p, right) - x).norm() < 1e-14 * rows * condition * x.norm());
    }
  CHECK(compared > 200);
}

TEST_CASE("constraint equations: a dependent row is reported, its multiplier is zero, the rest solves what can be solved") {
  std::mt19937 generator(2);
  for (const int rows : {2, 3, 5, 7, 8, 9, 15, 30})
    for (int draw = 0; draw < 10; ++draw) {
      Problem p = random_problem(rows, rows + 1, 0.0, generator);
      copy_row(p, 0, rows - 1, draw % 2 ? -1.7 : 1.0);
      const MatX a = p.matrix();
      SchurSolver solver;
      solver.analyze(p.rows);
      const VecX right = a * VecX::Random(rows); // in the range of A
      const VecX x = solve(solver, p, right);
      CHECK(solver.is_singular());
      int dependent = 0;
      for (int r = 0; r < rows; ++r) {
        if (!solver.is_dependent(r)) continue;
        ++dependent;
        CHECK(x[r] == 0.0);
        CHECK((r == 0 || r == rows - 1));
      }
      CHECK(dependent == 1);
      CHECK((a * x - right).norm() < 1e-9 * (1.0 + right.norm())); // random rows: conditions up to 1e6
    }
}

TEST_CASE("constraint equations: locked coordinates carry no compliance; a row on nothing else drops out") {
  std::mt19937 generator(3);
  for (int draw = 0; draw < 50; ++draw) {
    const int rows = 4 + draw % 12;
    const Problem p = random_problem(rows, 2 * rows, 0.3, generator);
    const MatX a = p.matrix();
    const VecX right = a * VecX::Random(rows);
    SchurSolver solver;
    solver.analyze(p.rows);
    const VecX x = solve(solver, p, right);
    CHECK((a * x - right).norm() < 1e-8 * (1.0 + right.norm()));
  }
  Problem p = random_problem(1, 2, 0.0, generator);
  for (int side = 0; side < 2; ++side)
    for (double& value : p.rows[0].wj[side]) value = 0.0;
  SchurSolver solver;
  solver.analyze(p.rows);
  CHECK(solve(solver, p, VecX::Ones(1))[0] == 0.0);
  CHECK(solver.is_dependent(0));
}

namespace {

// Feet of one body of 2 kg and 0.3 kg m² that stands on a level at a tilt: their slides differ by tilt times distance.
std::vector<SchurRow> feet(const std::vector<double>& at, double tilt) {
  std::vector<SchurRow> rows;
  for (const double x : at) {
    SchurRow row;
    row.body[0] = 0;
    const double w[3] = {0.5, 0.5, 1.0 / 0.3}, j[3] = {1.0, 0.0, 0.4 + tilt * x};
    for (int c = 0; c < 3; ++c) {
      row.w[0][c] = w[c];
      row.j[0][c] = j[c];
      row.wj[0][c] = w[c] * j[c];
    }
    rows.push_back(row);
  }
  return rows;
}

int left_out(const SchurSolver& solver) {
  int count = 0;
  for (int r = 0; r < solver.size(); ++r) {
    CHECK(solver.is_left_out(r) == solver.is_dependent(r));
    count += solver.is_left_out(r) ? 1 : 0;
  }
  return count;
}

} // namespace

// What a foot is beyond another one d away, of its length: tilt d sqrt(m J)/(J + m r²) = 1.25 tilt d here.
TEST_CASE("constraint equations: which feet depend on others is told by what they are beyond them, in whatever order they come") {
  for (const std::vector<double>& at : {std::vector<double>{-0.5, 0.0, 0.5}, {0.0, 0.5, -0.5}, {0.5, -0.5, 0.0}, {-0.5, 0.49, 0.5}})
    for (const double tilt : {0.0, 1e-15, 1e-9, 4e-7, 1.5e-6, 1e-5, 1e-3}) {
      CAPTURE(tilt);
      SchurSolver solver;
      const std::vector<SchurRow> rows = feet(at, tilt);
      solver.analyze(rows);
      solver.decide_rank({1, 1, 1}, {0, 0, 0});
      solver.factor(rows);
      CHECK(left_out(solver) == (tilt < 5e-7 ? 2 : 1)); // two feet hold two coordinates, if they hold more than one
    }
}

TEST_CASE("constraint equations: asked again at nearly the same place, the same rows stay out") {
  SchurSolver solver;
  const std::vector<double> at = {-0.5, 0.5};
  solver.analyze(feet(at, 0.0));
  std::vector<char> was_out = {0, 0};
  const auto decided = [&](double tilt) {
    solver.decide_rank({1, 1}, was_out);
    solver.factor(feet(at, tilt));
    for (int row = 0; row < 2; ++row) was_out[row] = solver.is_left_out(row) ? 1 : 0;
    return left_out(solver);
  };
  CHECK(decided(5e-7) == 1);
  CHECK(decided(1e-6) == 1); // beyond the bound by a little
  CHECK(decided(3e-6) == 0);
  CHECK(decided(1e-6) == 0); // and from the other side
  CHECK(decided(3e-7) == 1);
}

// Each diagonal entry is raised by its own fraction, in all sizes: rows that depend on each other can be solved with it.
TEST_CASE("constraint equations: damped ones against a dense factorisation") {
  std::mt19937 generator(21);
  for (int rows = 1; rows <= 24; ++rows)
    for (const double shift : {1e-3, 0.1}) {
      CAPTURE(rows);
      CAPTURE(shift);
      Problem p = random_problem(rows, std::max(2, rows), 0.0, generator);
      if (rows > 1) copy_row(p, 0, rows - 1, -1.3);
      MatX a = p.matrix();
      a.diagonal() *= 1.0 + shift;
      const Eigen::SelfAdjointEigenSolver<MatX> eigen(a, Eigen::EigenvaluesOnly);
      const double condition = eigen.eigenvalues()[rows - 1] / eigen.eigenvalues()[0];
      SchurSolver solver;
      solver.analyze(p.rows);
      solver.factor(p.rows, shift);
      CHECK(!solver.is_singular());
      const VecX wanted = VecX::Random(rows);
      VecX x = a * wanted;
      solver.solve(p.rows, x.data());
      CHECK((x - wanted).norm() < 2e-15 * rows * condition * wanted.norm()); // as above
      solver.factor(p.rows);                                                 // and no more once it is not asked for
      CHECK(solver.is_singular() == (rows > 1));
    }
}

// A pivot of δ² costs elimination the digits of δ²; what is refined keeps all but those of δ, with parts of rows too. Wanted is what
// orthogonal factors of the rows in 64 bits give.
TEST_CASE("constraint equations: rows that are nearly the same keep the digits that their difference has") {
  using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  std::mt19937 generator(22);
  int compared = 0;
  for (int rows = 2; rows <= 14; ++rows)
    for (int draw = 0; draw < 8; ++draw) {
      const double delta = draw % 2 == 0 ? 1e-4 : 1e-5;
      Problem p = random_problem(rows, rows + 2, 0.0, generator);
      const Problem other = random_problem(1, rows + 2, 0.0, generator); // what the last row is beyond the first
      copy_row(p, 0, rows - 1, 1.0);
      const auto add_part = [&p](int of, const SchurRow& from, double factor, std::vector<SchurPart>& parts) {
        SchurRow part = from;
        for (int side = 0; side < 2; ++side)
          for (int c = 0; c < 3 && part.body[side] >= 0; ++c) {
            const int k = 3 * part.body[side] + c;
            part.j[side][c] *= factor;
            part.wj[side][c] = p.w(k, k) * part.j[side][c];
            p.j(of, k) += part.j[side][c];
          }
        parts.push_back({static_cast<int>(p.rows.size()), of});
        p.rows.push_back(part);
      };
      std::vector<SchurPart> parts;
      add_part(rows - 1, other.rows[0], delta, parts);
      if (draw % 4 > 1) add_part(0, random_problem(1, rows + 2, 0.0, generator).rows[0], delta, parts);
      const MatX a = p.matrix();
      const double condition = [&] {
        const Eigen::SelfAdjointEigenSolver<MatX> eigen(a, Eigen::EigenvaluesOnly);
        return std::sqrt(eigen.eigenvalues()[rows - 1] / std::max(1e-300, eigen.eigenvalues()[0]));
      }();
      if (condition > 1e6) continue; // beyond what counts as independent
      CAPTURE(rows);
      CAPTURE(draw);
      const LongMatrix white = p.w.cast<long double>().cwiseSqrt() * p.j.transpose().cast<long double>();
      const Eigen::HouseholderQR<LongMatrix> qr(white);
      const LongMatrix upper = qr.matrixQR().topRows(rows).template triangularView<Eigen::Upper>();
      const VecX right = VecX::Random(rows);
      const LongVector half = upper.transpose().template triangularView<Eigen::Lower>().solve(LongVector(right.cast<long double>()));
      const VecX wanted = LongVector(upper.template triangularView<Eigen::Upper>().solve(half)).cast<double>();
      SchurSolver solver;
      solver.analyze(p.rows, rows, parts);
      solver.factor(p.rows);
      CHECK(solver.is_near_singular());
      CHECK(!solver.is_singular());
      VecX x = right;
      solver.solve(p.rows, x.data());
      CHECK((x - wanted).norm() < 1e-14 * rows * condition * wanted.norm()); // rounding of as many terms in each row
      ++compared;
    }
  CHECK(compared > 60);
}

// Of a row of a joint and one of friction along the same, whichever comes first and whatever its sign, friction stays out; what moves nothing is
// dependent, but only friction counts as left out.
TEST_CASE("constraint equations: friction stays out for joints, not joints for friction") {
  std::mt19937 generator(23);
  for (const int rows : {2, 5, 9, 14}) // three ways to solve
    for (const bool comes_first : {false, true})
      for (const double factor : {1.0, -1.0}) {
        CAPTURE(rows);
        CAPTURE(comes_first);
        CAPTURE(factor);
        Problem p = random_problem(rows, rows + 1, 0.0, generator);
        for (int side = 0; side < 2; ++side) // all of one sign
          for (int c = 0; c < 3; ++c) {
            SchurRow& row = p.rows[0];
            row.j[side][c] = factor * std::abs(row.j[side][c]);
            row.wj[side][c] = factor * std::abs(row.wj[side][c]);
            for (SchurRow& other : p.rows)
              for (int at = 0; at < 2; ++at)
                if (row.body[side] >= 0 && other.body[at] == row.body[side])
                  other.w[at][c] = p.w(3 * row.body[side] + c, 3 * row.body[side] + c);
          }
        copy_row(p, 0, rows - 1, 1.0);
        const int friction = comes_first ? 0 : rows - 1;
        std::vector<char> is_friction(static_cast<std::size_t>(rows), 0);
        is_friction[static_cast<std::size_t>(friction)] = 1;
        SchurSolver solver;
        solver.analyze(p.rows);
        solver.decide_rank(is_friction, std::vector<char>(static_cast<std::size_t>(rows), 0));
        solver.factor(p.rows);
        for (int r = 0; r < rows; ++r) {
          CHECK(solver.is_left_out(r) == (r == friction));
          CHECK(solver.is_dependent(r) == (r == friction));
        }
      }
  for (const int rows : {3, 9}) {
    Problem p = random_problem(rows, rows + 1, 0.0, generator);
    std::vector<char> is_friction(static_cast<std::size_t>(rows), 1);
    is_friction.back() = 0;
    for (const int r : {0, rows - 1})
      for (int side = 0; side < 2; ++side)
        for (int c = 0; c < 3; ++c) p.rows[r].j[side][c] = p.rows[r].wj[side][c] = 0.0;
    SchurSolver solver;
    solver.analyze(p.rows);
    solver.decide_rank(is_friction, std::vector<char>(static_cast<std::size_t>(rows), 0));
    solver.factor(p.rows);
    for (int r = 0; r < rows; ++r) {
      CHECK(solver.is_dependent(r) == (r == 0 || r == rows - 1));
      CHECK(solver.is_left_out(r) == (r == 0));
    }
  }
}
