// Compares mbd/integrators/sparse_lu with KLU of SuiteSparse on matrices as factored by rodas5p: time for one step (new values in a known
// pattern, factorisation, six solutions) and accuracy of the solutions.
//
// The matrices are I/(h γ) − J for bodies with three coordinates each, in a row or in a square grid, each connected with its neighbours by
// springs and dampers that couple all coordinates: 3 × 3 blocks of random numbers that combine damping and stiffness as in StageSystem.
#include "mbd/integrators/sparse_lu.h"

#include <benchmark/benchmark.h>
#include <klu.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace steplap {
namespace {

constexpr int k_solutions = 6; // number of stages of rodas5p, each of which solves a linear system with the same factors

struct MatrixPosition {
  int row = 0, column = 0;
};

struct Matrix {
  int n = 0;
  std::vector<MatrixPosition> entries;     ///< positions of the entries; values at equal positions are added
  std::vector<std::vector<double>> values; ///< values of the entries for several steps
};

Matrix coupled(const std::vector<std::pair<int, int>>& pairs, int bodies) {
  Matrix m;
  m.n = 3 * bodies;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto add_block = [&m](int a, int b) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m.entries.push_back({3 * a + i, 3 * b + j});
  };
  for (int i = 0; i < bodies; ++i) add_block(i, i);
  for (const auto& [a, b] : pairs)
    for (const auto& [row, column] : {std::pair{a, a}, std::pair{a, b}, std::pair{b, a}, std::pair{b, b}}) add_block(row, column);
  for (int step = 0; step < 8; ++step) {
    std::vector<double>& values = m.values.emplace_back();
    for (const MatrixPosition& e : m.entries) values.push_back(e.row == e.column ? 4.0 + any(random) : 0.3 * any(random));
  }
  return m;
}

Matrix row_of(int bodies) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 1; i < bodies; ++i) pairs.emplace_back(i - 1, i);
  return coupled(pairs, bodies);
}
Matrix grid_of(int side) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      if (i > 0) pairs.emplace_back((i - 1) * side + j, i * side + j);
      if (j > 0) pairs.emplace_back(i * side + j - 1, i * side + j);
    }
  return coupled(pairs, side * side);
}

// Returns max |A x − b| for the matrix of one step, with b = 1 in all components.
double residual(const Matrix& m, std::size_t step, const std::vector<double>& x) {
  std::vector<double> left(static_cast<std::size_t>(m.n), -1.0);
  for (std::size_t k = 0; k < m.entries.size(); ++k) left[m.entries[k].row] += m.values[step][k] * x[m.entries[k].column];
  return std::accumulate(left.begin(), left.end(), 0.0, [](double most, double value) { return std::max(most, std::abs(value)); });
}

class SteplapLu {
public:
  explicit SteplapLu(const Matrix& m) : m_(m) {}
  void step(std::size_t k, std::vector<double>& x) {
    lu_.begin(m_.n);
    for (std::size_t i = 0; i < m_.entries.size(); ++i) lu_.add(m_.entries[i].row, m_.entries[i].column, m_.values[k][i]);
    if (!lu_.factor()) throw std::runtime_error("singular");
    for (int s = 0; s < k_solutions; ++s) {
      std::fill(x.begin(), x.end(), 1.0);
      lu_.solve(x.data());
    }
  }

private:
  const Matrix& m_;
  SparseLu lu_;
};

class Klu {
public:
  explicit Klu(const Matrix& m) : m_(m), begin_(static_cast<std::size_t>(m.n) + 1, 0) {
    klu_defaults(&common_);
    std::vector<std::vector<int>> rows(static_cast<std::size_t>(m.n));
    for (const MatrixPosition& e : m.entries) rows[e.column].push_back(e.row);
    for (int j = 0; j < m.n; ++j) {
      std::sort(rows[j].begin(), rows[j].end());
      rows[j].erase(std::unique(rows[j].begin(), rows[j].end()), rows[j].end());
      index_.insert(index_.end(), rows[j].begin(), rows[j].end());
      begin_[j + 1] = static_cast<int>(index_.size());
    }
    for (const MatrixPosition& e : m.entries) {
      const auto first = index_.begin() + begin_[e.column], last = index_.begin() + begin_[e.column + 1];
      place_.push_back(static_cast<int>(std::lower_bound(first, last, e.row) - index_.begin()));
    }
    values_.resize(index_.size());
    symbolic_ = klu_analyze(m.n, begin_.data(), index_.data(), &common_);
  }
  ~Klu() {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    klu_free_symbolic(&symbolic_, &common_);
  }
  Klu(const Klu&) = delete;
  Klu& operator=(const Klu&) = delete;

  void step(std::size_t k, std::vector<double>& x) {
    std::fill(values_.begin(), values_.end(), 0.0);
    for (std::size_t i = 0; i < place_.size(); ++i) values_[place_[i]] += m_.values[k][i];
    if (!numeric_) numeric_ = klu_factor(begin_.data(), index_.data(), values_.data(), symbolic_, &common_);
    else if (!klu_refactor(begin_.data(), index_.data(), values_.data(), symbolic_, numeric_, &common_))
      throw std::runtime_error("singular");
    for (int s = 0; s < k_solutions; ++s) {
      std::fill(x.begin(), x.end(), 1.0);
      klu_solve(symbolic_, numeric_, m_.n, 1, x.data(), &common_);
    }
  }

private:
  const Matrix& m_;
  klu_common common_;
  std::vector<int> begin_, index_, place_;
  std::vector<double> values_;
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

template <class Lu> void measure(benchmark::State& state, const Matrix& matrix) {
  Lu lu(matrix);
  std::vector<double> x(static_cast<std::size_t>(matrix.n));
  double worst = 0.0;
  for (std::size_t k = 0; k < matrix.values.size(); ++k) {
    lu.step(k, x);
    worst = std::max(worst, residual(matrix, k, x));
  }
  std::size_t k = 0;
  for (auto _ : state) lu.step(k++ % matrix.values.size(), x);
  state.counters["unknowns"] = matrix.n;
  state.counters["residual"] = worst;
}

void row_own(benchmark::State& state) { measure<SteplapLu>(state, row_of(static_cast<int>(state.range(0)))); }
void row_klu(benchmark::State& state) { measure<Klu>(state, row_of(static_cast<int>(state.range(0)))); }
void grid_own(benchmark::State& state) { measure<SteplapLu>(state, grid_of(static_cast<int>(state.range(0)))); }
void grid_klu(benchmark::State& state) { measure<Klu>(state, grid_of(static_cast<int>(state.range(0)))); }

BENCHMARK(row_own)->Arg(3)->Arg(10)->Arg(100)->Arg(1000);
BENCHMARK(row_klu)->Arg(3)->Arg(10)->Arg(100)->Arg(1000);
BENCHMARK(grid_own)->Arg(4)->Arg(10)->Arg(30);
BENCHMARK(grid_klu)->Arg(4)->Arg(10)->Arg(30);

} // namespace
} // namespace steplap

BENCHMARK_MAIN();
