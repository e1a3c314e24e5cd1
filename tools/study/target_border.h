// Reliability index as a function of one design variable, and the value at which it reaches a target.
//
// The design variable is a non-random number, or the mean of a random variable with constant coefficient of variation or standard
// deviation. First order reliability (FORM) gives the index β(x). The search starts at the border x₀ of first order, β(x₀) = β_t (inverse
// FORM). With the slope β' at x₀, importance sampling at x corrects the border: x ← x + (β_t − β_IS(x))/β'. Each sampling uses new random
// numbers, so the last one, after x has converged, is independent of the choice of x. Its confidence interval divided by β' is the interval
// of the border.
#pragma once

#include "tools/study/samplers.h"

#include <map>
#include <string>
#include <vector>

namespace steplap::study {

/// Reliability index at one value of the design variable, with its confidence interval.
struct IndexEstimate {
  /// reliability index; NaN: unknown
  double beta = std::numeric_limits<double>::quiet_NaN();
  /// confidence interval of the index
  double low = std::numeric_limits<double>::quiet_NaN(), high = std::numeric_limits<double>::quiet_NaN();
  std::string doubt; ///< why the index is unknown or not trusted; "" otherwise
};

/// The border at which the index reaches the target.
struct TargetBorder {
  double value = 0.0, low = 0.0, high = 0.0; ///< estimate and confidence interval
  double checked_at = 0.0;                   ///< value of the design variable at the last sampling
  Estimate check;                            ///< probability of failure estimated by it
  std::string doubt;                         ///< why the border is unknown; "" otherwise
};

/// Returns the study with variable number `variable` set to x; for a random variable x is the mean.
[[nodiscard]] LoadedStudy with_design_value(const LoadedStudy& loaded, std::size_t variable, double x);

/// Evaluates the reliability index of a study for different values of one design variable.
class TargetSearch {
public:
  /// `target` is the index to be reached.
  TargetSearch(StudyRun& run, std::size_t variable, double target, const SamplingTarget& sampling)
      : run_(run), variable_(variable), target_(target), sampling_(sampling) {}

  /// Returns the index of first order.
  [[nodiscard]] IndexEstimate first_order(double x);
  /// Returns the index by importance sampling with new random numbers.
  [[nodiscard]] IndexEstimate sampled(double x);
  /// Corrects the first-order border `x` by importance sampling. The result is within [low, high].
  [[nodiscard]] TargetBorder border_near(double x, double low, double high);

private:
  struct Scene;
  [[nodiscard]] DesignPoints points_of(Scene& scene, double x);

  StudyRun& run_;
  std::size_t variable_;
  double target_;
  SamplingTarget sampling_;
  long samplings_ = 0;
  Estimate last_;                                      ///< result of the last call of sampled()
  std::map<double, std::vector<double>> known_points_; ///< nearest design point, by value of the design variable
};

} // namespace steplap::study
