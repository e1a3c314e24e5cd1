// Least squares of residuals that cost a run each: Levenberg's and Marquardt's method with differences as derivatives.
//
// Parameters are given as shares of their ranges, 0 to 1, which bound them. Steps of difference follow the error of the
// runs themselves: h = ∛ε of the parameter's size, where the error of the quotient by curvature, h², meets that by the
// run, ε/h. Jacobians at h and 2h tell what the derivatives are known to. All that can be asked at once is asked at
// once.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace steplap::study {

/// Residuals at several points; an empty vector where a point has none (its run failed).
using ResidualBatch = std::function<std::vector<Eigen::VectorXd>(const std::vector<Eigen::VectorXd>& points)>;

struct LeastSquaresProblem {
  ResidualBatch residuals;
  Eigen::VectorXd step; ///< of difference, as shares of the ranges
  double floor = 0.0;   ///< sum of squares that the error of the runs makes by itself
  long iterations = 100;
};

struct LeastSquaresMinimum {
  Eigen::VectorXd at;
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;    ///< by the shares; columns of differences that have no value are not-a-number
  double jacobian_error = 0.0; ///< Frobenius' norm: jacobian less that of twice the step, by Richardson's rule
  double sum = 0.0;            ///< of squares
  std::vector<bool> is_at_end; ///< of its range
  std::string problem;         ///< empty: the minimum was found
};

/// From `start`, where there are residuals.
[[nodiscard]] LeastSquaresMinimum minimise(const LeastSquaresProblem& problem, const Eigen::VectorXd& start,
                                           const Eigen::VectorXd& residuals);

/// What a minimum says about its parameters.
struct Identified {
  Eigen::MatrixXd covariance; ///< of the shares, over the directions that are told
  Eigen::MatrixXd directions; ///< orthonormal, one a column, by falling singular value
  Eigen::VectorXd singular;   ///< values of the Jacobian
  int rank = 0;               ///< directions that are told
};

/// `variance`: of a residual. A direction is told if the Jacobian's singular value is beyond what derivatives are known
/// to, and its standard deviation is less than half of the range.
[[nodiscard]] Identified identify(const LeastSquaresMinimum& minimum, double variance);

} // namespace steplap::study
