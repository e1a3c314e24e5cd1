// Kriging: a Gaussian process through the values of a function, with the mean and the standard deviation of what it does not know between
// them. Fitted by OpenTURNS (constant trend, Matérn's covariance with exponent 5/2, scales by maximum likelihood).
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

namespace steplap::study {

/// Prediction of a surrogate at one point.
struct Prediction {
  double mean = 0.0, deviation = 0.0;
  /// Returns how many standard deviations lie between the mean and zero: the learning function U of B. Echard, N. Gayton, M. Lemaire, AK-MCS:
  /// an active learning reliability method combining kriging and Monte Carlo simulation, Structural Safety 33, 2011. Infinite at known points.
  [[nodiscard]] double certainty() const { return deviation > 0.0 ? std::abs(mean) / deviation : std::numeric_limits<double>::infinity(); }
};

/// A surrogate of a function of several variables. Points are given one after the other, each by its coordinates.
class Surrogate {
public:
  explicit Surrogate(std::size_t dimension);
  Surrogate(Surrogate&&) noexcept;
  ~Surrogate();

  /// Fits it to the values at these points, of which there are at least two. Throws std::runtime_error if there is no fit.
  void fit(const std::vector<double>& points, const std::vector<double>& values);
  [[nodiscard]] std::vector<Prediction> at(const std::vector<double>& points) const;
  /// Returns the correlation of what is not known at two points before any value is known, 0 to 1.
  [[nodiscard]] double correlation(const double* a, const double* b) const;

private:
  struct Fit;
  void factorise(const std::vector<double>& points, const std::vector<double>& values, double nugget);
  std::size_t dimension_;
  std::unique_ptr<Fit> fit_;
};

} // namespace steplap::study
