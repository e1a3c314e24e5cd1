#include "tools/study/surrogate.h"

#include <Eigen/Cholesky>
#include <openturns/ConstantBasisFactory.hxx>
#include <openturns/KrigingAlgorithm.hxx>
#include <openturns/Log.hxx>
#include <openturns/MaternModel.hxx>

#include <algorithm>
#include <stdexcept>

namespace steplap::study {

// The factorised process: y = mean + Gaussian with the covariance variance R, R = L Lᵀ Matérn's correlations of the points.
struct Surrogate::Fit {
  OT::Point scales;
  Eigen::MatrixXd points; ///< one a column, each coordinate divided by its scale
  Eigen::LLT<Eigen::MatrixXd> factor;
  Eigen::VectorXd ones, weights; ///< L⁻¹ 1; R⁻¹ (y − mean)
  double mean = 0.0, variance = 0.0;

  // Returns the scaled coordinates of `count` points.
  [[nodiscard]] Eigen::MatrixXd scaled(const double* u, std::size_t count) const {
    const auto dimension = static_cast<Eigen::Index>(scales.getSize());
    const Eigen::Map<const Eigen::MatrixXd> given(u, dimension, static_cast<Eigen::Index>(count));
    const Eigen::Map<const Eigen::VectorXd> by(scales.data(), dimension);
    return by.cwiseInverse().asDiagonal() * given;
  }
};

namespace {

OT::Sample sample_of(const std::vector<double>& numbers, std::size_t width) {
  OT::Sample sample(numbers.size() / width, width);
  for (std::size_t i = 0; i < sample.getSize(); ++i)
    for (std::size_t d = 0; d < width; ++d) sample(i, d) = numbers[i * width + d];
  return sample;
}

// Returns Matérn's correlation with exponent 5/2 of each of `a` (rows of the result) with each of `b`, given in scales.
Eigen::MatrixXd correlations(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd squares(a.cols(), b.cols());
  for (Eigen::Index k = 0; k < b.cols(); ++k) squares.col(k) = (a.colwise() - b.col(k)).colwise().squaredNorm().transpose();
  const Eigen::ArrayXXd r = (5.0 * squares).array().sqrt();
  return (1.0 + r + r.square() / 3.0) * (-r).exp();
}

} // namespace

Surrogate::Surrogate(std::size_t dimension) : dimension_(dimension), fit_(std::make_unique<Fit>()) {
  fit_->scales = OT::Point(dimension, 1.0); // standard deviations
}
Surrogate::Surrogate(Surrogate&&) noexcept = default;
Surrogate::~Surrogate() = default;

void Surrogate::fit(const std::vector<double>& points, const std::vector<double>& values) {
  constexpr double k_shortest = 0.1, k_longest = 30.0; // scales, standard deviations: between the spacing of points and nearly straight
  OT::Log::Show(OT::Log::NONE);
  try {
    const OT::MaternModel start(fit_->scales, OT::Point(1, 1.0), 2.5);
    OT::KrigingAlgorithm algorithm(sample_of(points, dimension_), sample_of(values, 1), start,
                                   OT::ConstantBasisFactory(dimension_).build());
    algorithm.setOptimizationBounds(OT::Interval(OT::Point(dimension_, k_shortest), OT::Point(dimension_, k_longest)));
    algorithm.run();
    const OT::CovarianceModel covariance = algorithm.getResult().getCovarianceModel();
    fit_->scales = covariance.getScale(); // from which the next search begins
    fit_->variance = std::pow(covariance.getAmplitude()[0], 2);
    factorise(points, values, covariance.getNuggetFactor());
  } catch (const OT::Exception&) { // messages of the library are for programmers
    throw std::runtime_error("kriging found no surrogate for " + std::to_string(values.size()) + " values");
  }
}

// Factorises the correlations with the fitted scales. OpenTURNS solves for each predicted point alone, which takes six times as long as for
// many together.
void Surrogate::factorise(const std::vector<double>& points, const std::vector<double>& values, double nugget) {
  const auto count = static_cast<Eigen::Index>(values.size());
  fit_->points = fit_->scaled(points.data(), values.size());
  Eigen::MatrixXd r = correlations(fit_->points, fit_->points);
  r.diagonal().array() += nugget;
  fit_->factor.compute(r);
  if (fit_->factor.info() != Eigen::Success) throw std::runtime_error("kriging: two points of " + std::to_string(count) + " are the same");
  const auto lower = fit_->factor.matrixL();
  fit_->ones = lower.solve(Eigen::VectorXd::Ones(count));
  const Eigen::VectorXd y = lower.solve(Eigen::Map<const Eigen::VectorXd>(values.data(), count));
  fit_->mean = fit_->ones.dot(y) / fit_->ones.squaredNorm(); // generalised least squares
  fit_->weights = fit_->factor.matrixU().solve(y - fit_->mean * fit_->ones);
}

std::vector<Prediction> Surrogate::at(const std::vector<double>& points) const {
  constexpr std::size_t k_block = 256;
  std::vector<Prediction> predictions;
  const std::size_t count = points.size() / dimension_;
  predictions.reserve(count);
  for (std::size_t from = 0; from < count; from += k_block) {
    const std::size_t part = std::min(k_block, count - from);
    Eigen::MatrixXd r = correlations(fit_->points, fit_->scaled(&points[from * dimension_], part));
    const Eigen::VectorXd means = r.transpose() * fit_->weights;
    fit_->factor.matrixL().solveInPlace(r);
    const Eigen::ArrayXd known = r.colwise().squaredNorm().transpose(), of_mean = 1.0 - (r.transpose() * fit_->ones).array();
    const Eigen::ArrayXd variances = fit_->variance * (1.0 - known + of_mean.square() / fit_->ones.squaredNorm());
    for (Eigen::Index i = 0; i < means.size(); ++i) predictions.push_back({fit_->mean + means[i], std::sqrt(std::max(0.0, variances[i]))});
  }
  return predictions;
}

double Surrogate::correlation(const double* a, const double* b) const { return correlations(fit_->scaled(a, 1), fit_->scaled(b, 1))(0, 0); }

} // namespace steplap::study
