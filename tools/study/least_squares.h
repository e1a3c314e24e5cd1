// Nonlinear least squares for residuals that each require a simulation: Levenberg-Marquardt method with difference quotients.
//
// Parameters are scaled to 0 … 1 by their ranges, which are bounds. The difference step h, relative to the parameter's size, is ∛ε, where ε
// is the relative error of the runs: the truncation error h² then equals the error ε/h due to the runs. The error of the derivatives is
// estimated from Jacobians with steps h and 2h. Independent evaluations are requested in one batch.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace steplap::study {

/// Computes the residuals at several points; an empty vector for a point whose run failed.
using ResidualBatch = std::function<std::vector<Eigen::VectorXd>(const std::vector<Eigen::VectorXd>& points)>;

/// A least squares problem.
struct LeastSquaresProblem {
  ResidualBatch residuals;
  Eigen::VectorXd step; ///< difference step, as a fraction of the ranges
  double floor = 0.0;   ///< sum of squares caused by the numerical error of the runs
  long iterations = 100;
};

/// A minimum with its linearisation.
struct LeastSquaresMinimum {
  Eigen::VectorXd at;
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;    ///< derivatives with respect to the scaled parameters; columns without a value are NaN
  double jacobian_error = 0.0; ///< Frobenius norm of the Richardson error estimate from steps h and 2h
  double sum = 0.0;            ///< sum of the squared residuals
  std::vector<bool> is_at_end; ///< for each parameter: true if it is at a bound of its range
  std::string problem;         ///< empty if a minimum was found
};

/// Minimises from `start`, at which the residuals are given.
[[nodiscard]] LeastSquaresMinimum minimise(const LeastSquaresProblem& problem, const Eigen::VectorXd& start,
                                           const Eigen::VectorXd& residuals);

/// Parameters and directions that a minimum determines.
struct Identified {
  Eigen::MatrixXd covariance; ///< covariance of the scaled parameters, within the determined directions
  Eigen::MatrixXd directions; ///< orthonormal columns, in descending order of singular values
  Eigen::VectorXd singular;   ///< singular values of the Jacobian
  int rank = 0;               ///< number of determined directions
};

/// Analyses a minimum. `variance` is that of a residual. A direction is determined if the singular value of the Jacobian exceeds the error
/// of the derivatives and the standard deviation along it is less than half the range.
[[nodiscard]] Identified identify(const LeastSquaresMinimum& minimum, double variance);

} // namespace steplap::study
