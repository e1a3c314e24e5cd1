// Probability of failure for another distribution of one variable, by reweighting the samples that were drawn for it.
//
// Samples with weights w for the present density f have the weights w f'/f for another density f'. The mean over all samples of those that
// fail is the probability for f' (R. Y. Rubinstein, D. P. Kroese, Simulation and the Monte Carlo Method, section on importance sampling).
// It is given only if enough failures carry it.
#pragma once

#include "tools/study/limit_function.h"
#include "tools/study/weighted_mean.h"

namespace steplap::study {

/// Below this effective number of failures the interval of a weighted probability is not reliable: it scatters by a fifth.
constexpr double k_fewest_failures = 25.0;

/// Accumulates the samples of one sampling method.
class Influence {
public:
  Influence() = default; ///< of a method whose samples have no weights: says nothing
  explicit Influence(const JointLaw& law);

  /// Adds the sample at u, whose weight is the ratio of the standard normal density to that from which it was drawn.
  void add(const double* u, double weight, const LimitValue& value);
  /// Returns true if there are samples.
  [[nodiscard]] bool is_known() const { return count_ > 0; }
  /// Adds findings for each random variable: the probability with half its standard deviation, with a mean 10 % smaller and larger, and the
  /// mean of the variable in failures, in SI. `estimate`: the finding of the method's probability. What too few failures carry has no value;
  /// nothing is added if there are too few at all. If all have one, a note names the variable whose scatter matters most.
  void add_findings(const LimitFunction& limit, const Finding& estimate, Answer& answer) const;

private:
  /// The probability with one change, runs without a result as safe and as failures.
  struct Changed {
    JointLaw::Change change;
    WeightedMean safe{}, unsafe{};
  };
  /// A variable, and its values in failures, in standard deviations from its mean.
  struct Variable {
    std::vector<Changed> changed;
    double sum = 0.0, square_sum = 0.0, squares = 0.0; ///< Σ w x, Σ w² x, Σ w² x²
  };
  [[nodiscard]] Finding changed_probability(const LimitFunction& limit, std::size_t place, const Changed& changed) const;
  [[nodiscard]] Finding failing_mean(const LimitFunction& limit, std::size_t place) const;
  [[nodiscard]] std::string sentence(const LimitFunction& limit, std::size_t place, double present,
                                     const std::vector<Finding>& changed) const;

  const JointLaw* law_ = nullptr;
  std::vector<Variable> variables_; ///< per random variable
  WeightedMean failures_;           ///< weights of the failures
  long count_ = 0, bad_ = 0;
};

} // namespace steplap::study
