#include "tools/study/least_squares.h"

#include "mbd/base/decompositions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace steplap::study {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

// Returns the Jacobian by central differences with `times` the problem's step. If one neighbouring point has no residuals or is outside the
// range, the quotient is one-sided; if both do, the column is NaN.
MatrixXd differences(const LeastSquaresProblem& problem, const VectorXd& at, const VectorXd& here, double times) {
  const Eigen::Index n = at.size();
  std::vector<VectorXd> points;
  for (Eigen::Index i = 0; i < n; ++i)
    for (const double side : {-1.0, 1.0}) {
      points.push_back(at);
      points.back()[i] = std::clamp(at[i] + side * times * problem.step[i], 0.0, 1.0);
    }
  const std::vector<VectorXd> rows = problem.residuals(points);
  MatrixXd jacobian(here.size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto below = static_cast<std::size_t>(2 * i), above = below + 1;
    const bool has_below = rows[below].size() > 0, has_above = rows[above].size() > 0;
    const double left = has_below ? points[below][i] : at[i], right = has_above ? points[above][i] : at[i];
    if (right > left) jacobian.col(i) = ((has_above ? rows[above] : here) - (has_below ? rows[below] : here)) / (right - left);
    else jacobian.col(i).setConstant(k_nan);
  }
  return jacobian;
}

// The problem linearised at a point. The factor R of the Jacobian and Qᵀr suffice to compute steps.
struct Linear {
  MatrixXd r;
  VectorXd rhs;

  Linear(const MatrixXd& jacobian, const VectorXd& residuals) { std::tie(r, rhs) = triangle_of(jacobian, residuals); }
  // Returns the step for Marquardt's damping, scaled by the effect of each parameter. Parameters that are `held` do not change.
  [[nodiscard]] VectorXd step(double damping, const std::vector<bool>& held) const {
    const Eigen::Index n = r.cols();
    const double least = 1e-8 * std::max(r.colwise().norm().maxCoeff(), 1e-300);
    MatrixXd whole = MatrixXd::Zero(2 * n, n);
    VectorXd target = VectorXd::Zero(2 * n);
    whole.topRows(n) = r;
    target.head(n) = -rhs;
    for (Eigen::Index i = 0; i < n; ++i) {
      whole(n + i, i) = std::sqrt(damping) * std::max(r.col(i).norm(), least);
      if (!held[static_cast<std::size_t>(i)]) continue;
      whole.col(i).setZero();
      whole(n + i, i) = 1.0;
    }
    return steplap::least_squares(whole, target);
  }
  [[nodiscard]] VectorXd gradient() const { return r.transpose() * rhs; }
  // Returns the decrease of the sum of squares along the step for the linearised problem.
  [[nodiscard]] double gain(const VectorXd& step) const { return rhs.squaredNorm() - (rhs + r * step).squaredNorm(); }
};

// Returns, for each parameter, true if it is at a bound that the step would cross.
std::vector<bool> held_by(const VectorXd& at, const VectorXd& gradient) {
  std::vector<bool> held;
  for (Eigen::Index i = 0; i < at.size(); ++i) held.push_back((at[i] <= 0.0 && gradient[i] > 0.0) || (at[i] >= 1.0 && gradient[i] < 0.0));
  return held;
}

// Tries several damping factors in one batch and continues with the best.
bool try_steps(const LeastSquaresProblem& problem, const Linear& linear, double& damping, LeastSquaresMinimum& m) {
  constexpr double k_parts[] = {1e-4, 1e-2, 0.1, 1.0, 10.0, 1e3};
  const std::vector<bool> held = held_by(m.at, linear.gradient());
  std::vector<VectorXd> points;
  for (const double part : k_parts) points.push_back((m.at + linear.step(damping * part, held)).cwiseMax(0.0).cwiseMin(1.0));
  const std::vector<VectorXd> rows = problem.residuals(points);
  std::size_t best = points.size();
  double sum = m.sum;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (rows[k].size() == 0 || !(rows[k].squaredNorm() < sum)) continue;
    sum = rows[k].squaredNorm();
    best = k;
  }
  if (best == points.size()) return false;
  damping = std::clamp(damping * k_parts[best], 1e-14, 1e14);
  m.at = points[best];
  m.residuals = rows[best];
  m.sum = sum;
  return true;
}

} // namespace

LeastSquaresMinimum minimise(const LeastSquaresProblem& problem, const VectorXd& start, const VectorXd& residuals) {
  // The search has converged if the predicted further decrease of the sum, relative to the variance, is at most k_close: the minimum is
  // then within 1e-4 standard deviations. If no step decreases the sum, a predicted decrease of k_stuck is accepted as well, because the
  // difference quotients from which it is predicted are not more accurate.
  constexpr double k_close = 1e-8, k_stuck = 1e-3;
  constexpr double k_widest = 1e12; // largest damping factor
  LeastSquaresMinimum m;
  m.at = start;
  m.residuals = residuals;
  m.sum = residuals.squaredNorm();
  const auto freedom = static_cast<double>(std::max<Eigen::Index>(1, residuals.size() - start.size()));
  double damping = 1e-2;
  const auto finish = [&] {
    const MatrixXd wide = differences(problem, m.at, m.residuals, 2.0);
    m.jacobian_error = (m.jacobian - wide).norm() / 3.0;
    m.is_at_end = held_by(m.at, 2.0 * m.jacobian.transpose() * m.residuals);
  };
  for (long i = 0; i < problem.iterations; ++i) {
    m.jacobian = differences(problem, m.at, m.residuals, 1.0);
    if (!m.jacobian.allFinite()) {
      m.problem = "runs on both sides of the point have no result: no derivatives there";
      m.is_at_end.assign(static_cast<std::size_t>(m.at.size()), false);
      return m;
    }
    const Linear linear(m.jacobian, m.residuals);
    const double left = linear.gain(linear.step(1e-12, held_by(m.at, linear.gradient())));
    const bool is_exact = m.sum <= problem.floor;
    if (is_exact || left <= k_close * m.sum / freedom) return finish(), m;
    const double before = m.sum;
    while (!try_steps(problem, linear, damping, m)) {
      damping *= 1e5;
      if (damping < k_widest) continue;
      if (left > k_stuck * m.sum / freedom) m.problem = "the search got stuck: the sum of squares has a kink or a jump there";
      return finish(), m;
    }
    if (before - m.sum <= 1e-12 * before && left <= k_stuck * m.sum / freedom) { // the remaining decrease is rounding
      m.jacobian = differences(problem, m.at, m.residuals, 1.0);
      return finish(), m;
    }
  }
  m.problem = "no minimum found within the given number of iterations";
  m.jacobian = differences(problem, m.at, m.residuals, 1.0);
  return finish(), m;
}

Identified identify(const LeastSquaresMinimum& minimum, double variance) {
  constexpr double k_widest = 0.5; // largest standard deviation of a determined direction, as a fraction of the range
  Identified told;
  RightSingular singular = right_singular(minimum.jacobian);
  told.singular = std::move(singular.values);
  told.directions = std::move(singular.v);
  const Eigen::Index n = told.singular.size();
  const double deviation = std::sqrt(variance);
  while (told.rank < n && told.singular[told.rank] > 3.0 * minimum.jacobian_error && deviation < k_widest * told.singular[told.rank])
    ++told.rank;
  told.covariance = MatrixXd::Zero(n, n);
  for (int k = 0; k < told.rank; ++k)
    told.covariance += variance / (told.singular[k] * told.singular[k]) * told.directions.col(k) * told.directions.col(k).transpose();
  return told;
}

} // namespace steplap::study
