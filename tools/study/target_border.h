// Reliability index as a function of one design variable, and the value at which it reaches a target.
//
// The design variable is the mean of a random variable whose coefficient of variation or standard deviation stays, or a number that is not
// random. First order reliability (FORM) gives the index β(x) at any x; its border x₀ with β(x₀) = β_t starts the search (inverse FORM). With
// the slope β' there, importance sampling at x corrects it: x ← x + (β_t − β_IS(x))/β'. Each sampling uses separate random numbers, so that
// the last one, made when x has settled, is independent of the choice of x. Its confidence interval divided by the slope is that of the
// border.
#pragma once

#include "tools/study/samplers.h"

#include <map>
#include <string>
#include <vector>

namespace steplap::study {

/// Reliability index at one value of the design variable.
struct IndexEstimate {
  double beta = std::numeric_limits<double>::quiet_NaN();                                                 ///< NaN: unknown
  double low = std::numeric_limits<double>::quiet_NaN(), high = std::numeric_limits<double>::quiet_NaN(); ///< confidence interval
  std::string doubt; ///< why it is unknown or not to be trusted; "" otherwise
};

/// The border at which the index reaches the target.
struct TargetBorder {
  double value = 0.0, low = 0.0, high = 0.0; ///< estimate and confidence interval
  double checked_at = 0.0;                   ///< value of the last sampling
  Estimate check;                            ///< its probability
  std::string doubt;                         ///< why it is not known; "" otherwise
};

/// Returns the study with value `x` of variable `variable`: its mean if it is random.
[[nodiscard]] LoadedStudy with_design_value(const LoadedStudy& loaded, std::size_t variable, double x);

/// Evaluates the reliability index of a study with a varied design variable.
class TargetSearch {
public:
  /// `target` is the index to be reached.
  TargetSearch(StudyRun& run, std::size_t variable, double target, const SamplingTarget& sampling)
      : run_(run), variable_(variable), target_(target), sampling_(sampling) {}

  /// Returns the index of first order.
  [[nodiscard]] IndexEstimate first_order(double x);
  /// Returns the index by importance sampling with new random numbers.
  [[nodiscard]] IndexEstimate sampled(double x);
  /// Corrects the border `x` of first order within the range from `low` to `high`.
  [[nodiscard]] TargetBorder border_near(double x, double low, double high);

private:
  struct Scene;
  [[nodiscard]] DesignPoints points_of(Scene& scene, double x);

  StudyRun& run_;
  std::size_t variable_;
  double target_;
  SamplingTarget sampling_;
  long samplings_ = 0;
  Estimate last_;                                      ///< of the last call of sampled()
  std::map<double, std::vector<double>> known_points_; ///< design points by value of the variable
};

} // namespace steplap::study
