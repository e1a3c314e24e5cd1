// Constraint equations of which many meet in a few bodies, against dense algebra and against the way that makes no difference
// between bodies.
#include "mbd/base/types.h"
#include "mbd/dynamics/schur.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <doctest/doctest.h>

#include <cstring>
#include <random>

using namespace steplap;

namespace {

// A deck or two, and small bodies that each hold on to one of them, or to a neighbour; a few rows hold the decks themselves.
struct HubProblem {
  std::vector<SchurRow> rows;
  MatX j, w; ///< rows × 3·bodies; inverse masses
  [[nodiscard]] MatX matrix() const { return j * w * j.transpose(); }
};

class Builder {
public:
  Builder(int bodies, std::mt19937& generator) : generator_(generator), w_(3 * bodies) {
    for (double& w : w_) w = std::exp(unit_(generator_));
  }
  void set_weight(int body, double times) {
    for (int c = 0; c < 3; ++c) w_[3 * body + c] /= times;
  }
  void lock(int body, int coordinate) { w_[3 * body + coordinate] = 0.0; }
  // −1: the ground.
  void hold(int a, int b) {
    SchurRow& row = rows_.emplace_back();
    row.body[0] = a;
    row.body[1] = b;
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3 && row.body[side] >= 0; ++c) {
        row.w[side][c] = w_[3 * row.body[side] + c];
        row.j[side][c] = unit_(generator_);
        row.wj[side][c] = row.w[side][c] * row.j[side][c];
      }
  }
  void repeat_last(double factor) {
    rows_.push_back(rows_.back());
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3; ++c) {
        rows_.back().j[side][c] *= factor;
        rows_.back().wj[side][c] *= factor;
      }
  }
  [[nodiscard]] HubProblem scene() const {
    HubProblem s;
    s.rows = rows_;
    s.w = Eigen::Map<const VecX>(w_.data(), static_cast<Eigen::Index>(w_.size())).asDiagonal();
    s.j = MatX::Zero(static_cast<Eigen::Index>(rows_.size()), s.w.rows());
    for (std::size_t r = 0; r < rows_.size(); ++r)
      for (int side = 0; side < 2; ++side)
        for (int c = 0; c < 3 && rows_[r].body[side] >= 0; ++c)
          s.j(static_cast<Eigen::Index>(r), 3 * rows_[r].body[side] + c) += rows_[r].j[side][c];
    return s;
  }

private:
  std::mt19937& generator_;
  std::uniform_real_distribution<double> unit_{-1.0, 1.0};
  std::vector<double> w_;
  std::vector<SchurRow> rows_;
};

struct Kind {
  int decks = 1, rows_each = 1, chained = 0, outer = 0;
  bool is_locked = false;
};

// The decks are the first bodies and a hundred times as heavy as the others.
Builder crowd(const Kind& kind, int blocks, std::mt19937& generator) {
  Builder builder(kind.decks + blocks, generator);
  for (int d = 0; d < kind.decks; ++d) builder.set_weight(d, 100.0);
  if (kind.is_locked) builder.lock(0, 1);
  for (int i = 0; i < kind.outer; ++i) builder.hold(i % kind.decks, i % 2 == 0 || kind.decks == 1 ? -1 : (i + 1) % kind.decks);
  for (int b = 0; b < blocks; ++b)
    for (int r = 0; r < kind.rows_each; ++r)
      if (b % 2 == 0) builder.hold(kind.decks + b, b % kind.decks);
      else builder.hold(b / 2 % kind.decks, kind.decks + b);
  for (int b = 0; b < kind.chained; ++b) builder.hold(kind.decks + b, kind.decks + b + 1);
  return builder;
}

SchurSolver factored(const HubProblem& scene, SchurSolver::HubElimination hubs, double shift = 0.0) {
  SchurSolver solver;
  solver.analyze(scene.rows, static_cast<int>(scene.rows.size()), {}, hubs);
  solver.factor(scene.rows, shift);
  return solver;
}

VecX solved(const SchurSolver& solver, const HubProblem& scene, VecX right) {
  solver.solve(scene.rows, right.data());
  return right;
}

bool are_same(const VecX& x, const VecX& y) {
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), sizeof(double) * static_cast<std::size_t>(x.size())) == 0;
}

} // namespace

TEST_CASE("constraint equations with hubs: against a dense factorisation, and otherwise than without, but by rounding alone") {
  std::mt19937 generator(31);
  int apart = 0, compared = 0;
  for (const Kind& kind : {Kind{}, Kind{.rows_each = 2}, Kind{.decks = 2}, Kind{.decks = 4}, Kind{.chained = 60}, Kind{.outer = 2},
                           Kind{.decks = 2, .chained = 20, .outer = 4}, Kind{.outer = 1, .is_locked = true}})
    for (const int blocks : {64, 100, 160})
      for (int draw = 0; draw < 4; ++draw) {
        const HubProblem scene = crowd(kind, blocks, generator).scene();
        const MatX a = scene.matrix();
        const Eigen::SelfAdjointEigenSolver<MatX> eigen(a, Eigen::EigenvaluesOnly);
        const double condition = eigen.eigenvalues()[a.rows() - 1] / std::max(1e-300, eigen.eigenvalues()[0]);
        if (condition > 1e6) continue;
        ++compared;
        const SchurSolver with = factored(scene, SchurSolver::HubElimination::apart),
                          without = factored(scene, SchurSolver::HubElimination::as_others);
        const VecX right = VecX::Random(a.rows()), x = solved(with, scene, right), y = solved(without, scene, right);
        if (!are_same(x, y)) ++apart;
        // Rounding of a factorisation, and the two digits of which B may be smaller than A.
        const double allowed = 1e-15 * static_cast<double>(a.rows()) * condition * y.norm();
        CHECK((x - a.ldlt().solve(right)).norm() < 100.0 * allowed);
        CHECK((x - y).norm() < 100.0 * allowed);
        bool is_any_dependent = with.is_singular();
        for (int r = 0; r < with.size(); ++r) is_any_dependent = is_any_dependent || with.is_dependent(r);
        CHECK(!is_any_dependent);
        // What is told of pivots is no more than they are (of up to two rows that meet without hubs in whatever order they come), and no
        // pose is taken for one beside a singular one.
        const bool is_any_order = kind.chained == 0 && kind.outer <= 2;
        if (is_any_order && !are_same(x, y)) CHECK(with.smallest_pivot() <= without.smallest_pivot() * (1.0 + 1e-9));
        CHECK(with.is_near_singular() == without.is_near_singular());
      }
  CHECK(compared > 60);
  CHECK(apart > 20); // else nothing was tried
}

TEST_CASE("constraint equations with hubs: what is not for them is solved as if there were none, to the bit") {
  std::mt19937 generator(32);
  const auto check_same = [](const HubProblem& scene, double shift) {
    const SchurSolver with = factored(scene, SchurSolver::HubElimination::apart, shift),
                      without = factored(scene, SchurSolver::HubElimination::as_others, shift);
    const VecX right = scene.matrix() * VecX::Random(static_cast<Eigen::Index>(scene.rows.size()));
    CHECK(are_same(solved(with, scene, right), solved(without, scene, right)));
    CHECK(with.is_singular() == without.is_singular());
    CHECK(with.smallest_pivot() == without.smallest_pivot());
    for (int r = 0; r < with.size(); ++r) CHECK(with.is_dependent(r) == without.is_dependent(r));
  };
  check_same(crowd({}, 100, generator).scene(), 0.01); // damped
  check_same(crowd({}, 40, generator).scene(), 0.0);   // few rows
  check_same(crowd({.decks = 5}, 200, generator).scene(), 0.0);
  check_same(crowd({.outer = 9}, 100, generator).scene(), 0.0);
  Builder twice = crowd({}, 100, generator); // two rows that are one
  twice.repeat_last(-1.3);
  check_same(twice.scene(), 0.0);
  Builder heavy(101, generator); // what stands on the deck is heavier than it
  for (int b = 1; b <= 100; ++b) heavy.set_weight(b, 1e5);
  for (int b = 1; b <= 100; ++b) heavy.hold(b, 0);
  check_same(heavy.scene(), 0.0);
  Builder exhausted = crowd({}, 100, generator); // a body has no way left once the deck is held
  for (int r = 0; r < 3; ++r) exhausted.hold(50, 0);
  check_same(exhausted.scene(), 0.0);
}

// The same solver goes from one to the other and back: what it makes hangs on the numbers that it has now.
TEST_CASE("constraint equations with hubs: by turns with numbers that are not for them") {
  std::mt19937 generator(33);
  const HubProblem scene = crowd({}, 100, generator).scene();
  SchurSolver solver;
  solver.analyze(scene.rows, 100, {}, SchurSolver::HubElimination::apart);
  const VecX right = VecX::Random(100);
  solver.factor(scene.rows);
  const VecX first = solved(solver, scene, right);
  solver.factor(scene.rows, 0.1);
  const VecX damped = solved(solver, scene, right);
  solver.factor(scene.rows);
  CHECK(are_same(first, solved(solver, scene, right)));
  MatX raised = scene.matrix();
  raised.diagonal() *= 1.1;
  CHECK((damped - raised.ldlt().solve(right)).norm() < 1e-12 * damped.norm()); // a condition of some hundred
  // Friction that is asked whether it depends on others, and does not.
  solver.decide_rank(std::vector<char>(100, 1), std::vector<char>(100, 0));
  solver.factor(scene.rows);
  CHECK(!solver.is_rank_open());
  CHECK(are_same(first, solved(solver, scene, right)));
}
