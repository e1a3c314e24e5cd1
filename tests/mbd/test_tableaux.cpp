// The coefficients of the methods against their order conditions, one for each rooted tree (Hairer, Nørsett,
// Wanner, Solving ODEs I, II.2; for Rosenbrock methods Hairer, Wanner, Solving ODEs II, IV.7): a method is of
// order p if and only if Σ b_j Φ_j(τ) = 1/γ(τ) for all trees τ of at most p vertices.
#include "mbd/integrators/singular_crossing.h"
#include "mbd/integrators/tableau_dop853.h"
#include "mbd/integrators/tableau_rodas5p.h"
#include "mbd/integrators/tableau_tsit5.h"

#include <doctest/doctest.h>

#include <Eigen/LU>

#include <cmath>
#include <complex>
#include <functional>
#include <vector>

namespace {

using Vec = Eigen::VectorXd;
using Mat = Eigen::MatrixXd;

// A tree is its root's branches, by their indices in the list of all trees, ascending.
struct Tree {
  std::vector<int> branches;
  int order = 1;
  double density = 1.0; ///< γ(τ) = order · Π γ(branch)
};

// All rooted trees of at most `order` vertices: for each, multisets of smaller ones under a new root.
std::vector<Tree> rooted_trees(int order) {
  std::vector<Tree> trees{{}};
  for (int p = 2; p <= order; ++p) {
    std::vector<Tree> found;
    std::vector<int> branches;
    const std::function<void(int, int)> extend = [&](int first, int left) {
      if (left == 0) {
        Tree tree{branches, p, static_cast<double>(p)};
        for (const int b : branches) tree.density *= trees[b].density;
        found.push_back(tree);
      }
      for (int b = first; b < static_cast<int>(trees.size()); ++b) {
        if (trees[b].order > left) continue;
        branches.push_back(b);
        extend(b, left - trees[b].order);
        branches.pop_back();
      }
    };
    extend(0, p - 1);
    trees.insert(trees.end(), found.begin(), found.end());
  }
  return trees;
}

// Φ_j of every tree. A vertex with one branch passes through `single`, with several through `several`: both
// the same matrix for a Runge–Kutta method; α + γ and α for a Rosenbrock method.
std::vector<Vec> elementary_weights(const std::vector<Tree>& trees, const Mat& several, const Mat& single) {
  std::vector<Vec> phi;
  for (const Tree& tree : trees) {
    Vec product = Vec::Ones(several.rows());
    for (const int b : tree.branches) product = product.cwiseProduct((tree.branches.size() == 1 ? single : several) * phi[b]);
    phi.push_back(product);
  }
  return phi;
}

// Largest defect of the conditions up to `order`, each against the size of the terms in its sum; at
// the fraction s of the step, where the exact value is s^order/γ.
double defect(const std::vector<Tree>& trees, const std::vector<Vec>& phi, const Vec& b, int order, double s = 1.0,
              bool is_difference = false) {
  double worst = 0.0;
  for (std::size_t i = 0; i < trees.size() && trees[i].order <= order; ++i) {
    const double exact = is_difference ? 0.0 : std::pow(s, trees[i].order) / trees[i].density;
    const double size = std::max(1e-3, b.cwiseAbs().dot(phi[i].cwiseAbs()));
    worst = std::max(worst, std::abs(b.dot(phi[i]) - exact) / size);
  }
  return worst;
}

// A method is not of a higher order than it claims: some condition of the next order is missed clearly.
constexpr double k_missed = 1e-7;
// Published coefficients have 16 to 20 digits; rows of DOP853 hold entries up to 43 that cancel to below 1, and a
// tree of order 8 passes through several of them: 1e-16 grows by some 10³.
constexpr double k_rounding = 5e-13;

template <class A> Mat lower(const A& a, int stages) {
  Mat m = Mat::Zero(stages, stages);
  for (int i = 0; i < stages; ++i)
    for (int j = 0; j < i; ++j) m(i, j) = a[i][j];
  return m;
}
template <class B> Vec padded(const B& b, int stages) {
  Vec v = Vec::Zero(stages);
  for (std::size_t j = 0; j < b.size(); ++j) v[static_cast<int>(j)] = b[j];
  return v;
}

struct Rosenbrock {
  Mat alpha, gamma;
  Vec b, embedded;
  Vec dense(double s) const {
    using namespace steplap::rodas5p;
    Vec m = last();
    for (int j = 0; j < 8; ++j) m[j] = s * (m[j] + (1.0 - s) * (H[0][j] + s * (H[1][j] + s * H[2][j])));
    return gamma.transpose() * m;
  }
  static Vec last() {
    Vec m = padded(steplap::rodas5p::a[7], 8);
    m[7] = 1.0;
    return m;
  }
};

// From the form in u_i = Σ γ_ij k_j back to α, Γ and b: C = 1/γ − Γ⁻¹, a = α Γ⁻¹, m = Γ⁻ᵀ b.
Rosenbrock rodas5p_in_k() {
  using namespace steplap::rodas5p;
  Rosenbrock r;
  r.gamma = (Mat::Identity(8, 8) / steplap::rodas5p::gamma - lower(C, 8)).inverse();
  r.alpha = lower(a, 8) * r.gamma;
  r.b = r.gamma.transpose() * Rosenbrock::last();
  r.embedded = r.gamma.transpose() * padded(a[7], 8);
  return r;
}

} // namespace

TEST_CASE("rooted trees: as many of each order as are known") {
  const std::vector<Tree> trees = rooted_trees(8);
  int count[9] = {};
  for (const Tree& tree : trees) ++count[tree.order];
  const int known[9] = {0, 1, 1, 2, 4, 9, 20, 48, 115}; // OEIS A000081
  for (int p = 1; p <= 8; ++p) CHECK(count[p] == known[p]);
}

TEST_CASE("Tsit5: order 5, embedded order 4, dense output of order 4") {
  using namespace steplap::tsit5;
  const std::vector<Tree> trees = rooted_trees(6);
  const Mat a7 = lower(a, 7);
  const std::vector<Vec> phi = elementary_weights(trees, a7, a7);
  CHECK((a7.rowwise().sum() - padded(c, 7)).cwiseAbs().maxCoeff() < k_rounding);
  CHECK(defect(trees, phi, padded(b, 7), 5) < k_rounding);
  CHECK(defect(trees, phi, padded(b, 7), 6) > k_missed);
  CHECK(defect(trees, phi, padded(e, 7), 4, 1.0, true) < k_rounding);
  CHECK(defect(trees, phi, padded(e, 7), 5, 1.0, true) > k_missed);
  for (const double s : {0.1, 0.35, 0.5, 0.8, 1.0}) {
    Vec weights(7);
    for (int j = 0; j < 7; ++j) weights[j] = s * (d[j][0] + s * (d[j][1] + s * (d[j][2] + s * d[j][3])));
    CAPTURE(s);
    CHECK(defect(trees, phi, weights, 4, s) < k_rounding);
  }
}

TEST_CASE("DOP853: order 8, estimates of order 5 and 3, dense output of order 7") {
  using namespace steplap::dop853;
  const std::vector<Tree> trees = rooted_trees(9);
  const Mat a16 = lower(a, 16);
  const std::vector<Vec> phi = elementary_weights(trees, a16, a16);
  CHECK((a16.rowwise().sum() - padded(c, 16)).cwiseAbs().maxCoeff() < k_rounding);
  CHECK(defect(trees, phi, padded(b, 16), 8) < k_rounding);
  CHECK(defect(trees, phi, padded(b, 16), 9) > k_missed);
  CHECK(defect(trees, phi, padded(e5, 16), 5, 1.0, true) < k_rounding);
  CHECK(defect(trees, phi, padded(e5, 16), 6, 1.0, true) > k_missed);
  CHECK(defect(trees, phi, padded(e3, 16), 3, 1.0, true) < k_rounding);
  CHECK(defect(trees, phi, padded(e3, 16), 4, 1.0, true) > k_missed);
  for (const double s : {0.1, 0.35, 0.5, 0.8, 1.0}) {
    const double u = 1.0 - s;
    // r₀ = Σ b k, r₁ = k₀ − r₀, r₂ = 2 r₀ − (k₀ + k₁₂), in weights of the stages.
    const Vec r0 = padded(b, 16), first = Vec::Unit(16, 0), last = Vec::Unit(16, 12);
    const Vec r1 = first - r0, r2 = 2.0 * r0 - first - last;
    const auto r = [&](int i) { return padded(d[i], 16); };
    const Vec weights = s * (r0 + u * (r1 + s * (r2 + u * (r(0) + s * (r(1) + u * (r(2) + s * r(3)))))));
    CAPTURE(s);
    CHECK(defect(trees, phi, weights, 7, s) < k_rounding);
    if (s < 1.0) CHECK(defect(trees, phi, weights, 8, s) > k_missed);
  }
}

TEST_CASE("Rodas5P: order 5, embedded order 4, dense output of order 4, row sums") {
  const Rosenbrock r = rodas5p_in_k();
  const std::vector<Tree> trees = rooted_trees(6);
  const std::vector<Vec> phi = elementary_weights(trees, r.alpha, r.alpha + r.gamma);
  // The inverse of 1/γ − C with entries of 160 loses two digits.
  constexpr double k_inverted = 1e-11;
  CHECK((r.alpha.rowwise().sum() - padded(steplap::rodas5p::c, 8)).cwiseAbs().maxCoeff() < k_inverted);
  CHECK((r.gamma.rowwise().sum() - padded(steplap::rodas5p::gamma_i, 8)).cwiseAbs().maxCoeff() < k_inverted);
  CHECK(defect(trees, phi, r.b, 5) < k_inverted);
  CHECK(defect(trees, phi, r.b, 6) > k_missed);
  CHECK(defect(trees, phi, r.embedded, 4) < k_inverted);
  CHECK(defect(trees, phi, r.embedded, 5) > k_missed);
  for (const double s : {0.1, 0.35, 0.5, 0.8, 1.0}) {
    CAPTURE(s);
    CHECK(defect(trees, phi, r.dense(s), 4, s) < k_inverted);
  }
}

TEST_CASE("Rodas5P is stiffly accurate and L-stable") {
  const Rosenbrock r = rodas5p_in_k();
  const Mat beta = r.alpha + r.gamma;
  CHECK((beta.row(7).transpose() - r.b).cwiseAbs().maxCoeff() < 1e-11);
  // R(z) = 1 + z bᵀ(1 − zβ)⁻¹ 1 has its poles at 1/γ > 0 alone: by the maximum principle it is bounded by 1
  // in the left half-plane if it is on the imaginary axis.
  const auto stability = [&](std::complex<double> z) {
    const Eigen::MatrixXcd m = Eigen::MatrixXcd::Identity(8, 8) - z * beta.cast<std::complex<double>>();
    const Eigen::VectorXcd x = m.partialPivLu().solve(Eigen::VectorXcd::Ones(8));
    return 1.0 + z * r.b.cast<std::complex<double>>().dot(x);
  };
  for (double y = 1e-2; y < 1e6; y *= 1.05) {
    CAPTURE(y);
    CHECK(std::abs(stability({0.0, y})) <= 1.0 + 1e-10);
  }
  CHECK(std::abs(stability({-1e8, 0.0})) < 1e-6);
}

TEST_CASE("Gauss' method of eight stages: B(16), C(8), nodes symmetric; so of order 16 (Butcher)") {
  const steplap::GaussTable& table = steplap::gauss_table();
  constexpr int n = steplap::GaussTable::n;
  constexpr double k_in_double = 1e-15; // coefficients are rounded from extended precision
  for (int k = 1; k <= 2 * n; ++k) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += table.b[i] * std::pow(table.c[i], k - 1);
    CHECK(std::abs(sum - 1.0 / k) < k_in_double);
  }
  for (int i = 0; i < n; ++i) {
    CHECK(std::abs(table.c[i] + table.c[n - 1 - i] - 1.0) < k_in_double);
    for (int k = 1; k <= n; ++k) {
      double sum = 0.0;
      for (int j = 0; j < n; ++j) sum += table.a[i][j] * std::pow(table.c[j], k - 1);
      CHECK(std::abs(sum - std::pow(table.c[i], k) / k) < k_in_double);
    }
  }
  // Dense output: weights to the nodes are the rows of a, to the end b; at a node only that node counts. The
  // powers of the Lagrange polynomials are up to 1e4: their sums lose as many digits.
  for (int i = 0; i < n; ++i) {
    const auto to = table.weights_to(table.c[i]), at = table.weights_at(table.c[i]);
    for (int j = 0; j < n; ++j) {
      CHECK(std::abs(to[j] - table.a[i][j]) < 1e-11);
      CHECK(std::abs(at[j] - (i == j ? 1.0 : 0.0)) < 1e-10);
    }
  }
}
