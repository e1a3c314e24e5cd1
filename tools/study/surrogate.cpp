#include "tools/study/surrogate.h"

#include <openturns/ConstantBasisFactory.hxx>
#include <openturns/KrigingAlgorithm.hxx>
#include <openturns/Log.hxx>
#include <openturns/MaternModel.hxx>

#include <stdexcept>

namespace steplap::study {

struct Surrogate::Fit {
  OT::Point scales;
  OT::KrigingResult result{};
  OT::CovarianceModel covariance{};
};

namespace {

OT::Sample sample_of(const std::vector<double>& numbers, std::size_t width) {
  OT::Sample sample(numbers.size() / width, width);
  for (std::size_t i = 0; i < sample.getSize(); ++i)
    for (std::size_t d = 0; d < width; ++d) sample(i, d) = numbers[i * width + d];
  return sample;
}

OT::Point point_of(const double* u, std::size_t dimension) {
  OT::Point point(dimension);
  std::copy(u, u + dimension, point.begin());
  return point;
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
    fit_->result = algorithm.getResult();
    fit_->covariance = fit_->result.getCovarianceModel();
    fit_->scales = fit_->covariance.getScale(); // from which the next search begins
  } catch (const OT::Exception&) {              // messages of the library are for programmers
    throw std::runtime_error("kriging found no surrogate for " + std::to_string(values.size()) + " values");
  }
}

std::vector<Prediction> Surrogate::at(const std::vector<double>& points) const {
  if (points.empty()) return {};
  const OT::Sample sample = sample_of(points, dimension_), means = fit_->result.getConditionalMean(sample),
                   variances = fit_->result.getConditionalMarginalVariance(sample);
  std::vector<Prediction> predictions;
  predictions.reserve(sample.getSize());
  for (std::size_t i = 0; i < sample.getSize(); ++i) predictions.push_back({means(i, 0), std::sqrt(std::max(0.0, variances(i, 0)))});
  return predictions;
}

double Surrogate::correlation(const double* a, const double* b) const {
  const OT::Point p = point_of(a, dimension_), q = point_of(b, dimension_);
  return fit_->covariance.computeAsScalar(p, q) / fit_->covariance.computeAsScalar(p, p);
}

} // namespace steplap::study
