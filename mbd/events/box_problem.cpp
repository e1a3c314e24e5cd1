#include "mbd/events/box_problem.h"

#include "mbd/base/decompositions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Rows of A, scaled to a diagonal of 1, count as dependent if the squared length of their component orthogonal to the other rows is
// smaller.
constexpr double k_dependent = 1e-12;        // same value as SchurSolver::k_dependent
constexpr double k_rounded_gradient = 1e-13; // rounding of g_i relative to the terms of which it is the sum
constexpr int k_most_steps = 2; // after two steps to the minimum for one set of free variables, the remaining gradient is rounding

class ActiveSet {
public:
  ActiveSet(const MatX& a, const VecX& b, const VecX& lower, const VecX& upper, const VecX& rounding)
      : a_(a), b_(b), lower_(lower), upper_(upper), rounding_(rounding), n_(b.size()), w_(VecX::Zero(n_)), at_bound_(n_, 0) {
    for (Eigen::Index i = 0; i < n_; ++i)
      if (!(upper_[i] > lower_[i])) at_bound_[i] = 1;
  }

  BoxSolution solve() {
    BoxSolution solution;
    const Eigen::Index most = 20 * (n_ + 2) * (n_ + 2);
    for (Eigen::Index i = 0; i < most && !solution.is_solved; ++i) solution.is_solved = !move_free() && !release_one();
    solution.w = w_;
    solution.g = gradient();
    for (Eigen::Index i = 0; i < n_; ++i) solution.is_free.push_back(at_bound_[i] == 0 || !pulls(i, solution.g[i]));
    return solution;
  }

private:
  [[nodiscard]] VecX gradient() const { return a_ * w_ + b_; }
  [[nodiscard]] double tolerance(Eigen::Index i) const {
    return rounding_[i] + k_rounded_gradient * (a_.row(i).cwiseAbs().dot(w_.cwiseAbs()) + std::abs(b_[i]));
  }
  // Returns true if the gradient g of variable i exceeds its rounding error.
  [[nodiscard]] bool pulls(Eigen::Index i, double g) const { return std::abs(g) > tolerance(i); }

  // Moves the free variables to their common minimum, or up to the first bound. Returns false if they are already there.
  bool move_free() {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n_; ++i)
      if (at_bound_[i] == 0) free.push_back(i);
    const VecX g = gradient();
    const bool is_pulled = std::any_of(free.begin(), free.end(), [&](Eigen::Index i) { return pulls(i, g[i]); });
    if (!is_pulled) return false;
    const auto m = static_cast<Eigen::Index>(free.size());
    MatX own(m, m);
    VecX scale(m), right(m);
    for (Eigen::Index i = 0; i < m; ++i) scale[i] = a_(free[i], free[i]) > 0.0 ? 1.0 / std::sqrt(a_(free[i], free[i])) : 1.0;
    for (Eigen::Index i = 0; i < m; ++i) {
      right[i] = -scale[i] * g[free[i]];
      for (Eigen::Index j = 0; j < m; ++j) own(i, j) = scale[i] * scale[j] * a_(free[i], free[j]);
    }
    VecX direction = shortest_solution(own, right, k_dependent);
    const VecX left = right - own * direction; // component of the gradient in the null space of A, or rounding
    // Steps to the minimum come first. While the minimum is far, the residual `left` may be its rounding error instead of a direction in
    // which the objective is unbounded.
    bool is_near = steps_to_minimum_ >= k_most_steps, is_endless = false, is_far = false;
    for (Eigen::Index i = 0; i < m; ++i) {
      is_far = is_far || pulls(free[i], (right[i] - left[i]) / scale[i]);
      is_endless = is_endless || pulls(free[i], left[i] / scale[i]);
    }
    is_near = is_near || !is_far;
    is_endless = is_endless && is_near;
    if (is_near && !is_endless) return false;
    if (is_endless) direction = left;
    direction = direction.cwiseProduct(scale);
    double step = is_endless ? std::numeric_limits<double>::infinity() : 1.0;
    Eigen::Index first = -1;
    for (Eigen::Index i = 0; i < m; ++i) {
      const double d = direction[i];
      if (d == 0.0) continue;
      const double reach = std::max(0.0, ((d > 0.0 ? upper_ : lower_)[free[i]] - w_[free[i]]) / d);
      if (reach >= step) continue;
      step = reach;
      first = i;
    }
    if (!std::isfinite(step)) return false;
    for (Eigen::Index i = 0; i < m; ++i) w_[free[i]] += step * direction[i];
    if (first < 0) {
      ++steps_to_minimum_;
      return true;
    }
    steps_to_minimum_ = 0;
    w_[free[first]] = (direction[first] > 0.0 ? upper_ : lower_)[free[first]];
    at_bound_[free[first]] = direction[first] > 0.0 ? 1 : -1;
    return true;
  }

  // Frees the variable at a bound whose decrease of the objective towards the inside is steepest. Returns false if there is none.
  bool release_one() {
    const VecX g = gradient();
    Eigen::Index worst = -1;
    double most = 0.0;
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (at_bound_[i] == 0 || !(upper_[i] > lower_[i]) || !pulls(i, g[i])) continue;
      const double back = at_bound_[i] * g[i] / (a_(i, i) > 0.0 ? std::sqrt(a_(i, i)) : 1.0);
      if (back <= most) continue;
      most = back;
      worst = i;
    }
    if (worst < 0) return false;
    at_bound_[worst] = 0;
    steps_to_minimum_ = 0;
    return true;
  }

  const MatX& a_;
  const VecX &b_, &lower_, &upper_, &rounding_;
  Eigen::Index n_;
  VecX w_;
  int steps_to_minimum_ = 0;          ///< steps to the minimum with the present set of free variables
  std::vector<signed char> at_bound_; ///< −1, 1: at the lower or upper bound; 0: free
};

} // namespace

BoxSolution solve_box_problem(const MatX& a, const VecX& b, const VecX& c, const VecX& rounding) {
  return solve_box_problem(a, b, -c, c, rounding);
}

BoxSolution solve_box_problem(const MatX& a, const VecX& b, const VecX& lower, const VecX& upper, const VecX& rounding) {
  return ActiveSet(a, b, lower, upper, rounding).solve();
}

} // namespace steplap
