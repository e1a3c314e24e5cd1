// The joint distribution of a study's variables, seen from standard normal space: x_i = F_i⁻¹(Φ(z_i)), z = L u, with
// u independent standard normal and L Lᵀ the correlations of the normal copula (Nataf's transformation).
//
// Distributions are OpenTURNS'. A variable with a range counts as uniform; one without either keeps its value.
// Not for several threads at a time: samples are drawn by one thread (and drawing is never what takes time).
#pragma once

#include "tools/study/study.h"

#include <memory>

namespace steplap::study {

class JointLaw {
public:
  /// `nominal`: the value of every variable, which those that do not vary keep. Appends what is wrong with
  /// distributions and correlations to `problems`; the law is of no use then.
  JointLaw(const Study& study, std::vector<double> nominal, std::vector<Diagnostic>& problems);
  JointLaw(JointLaw&&) noexcept;
  ~JointLaw();

  /// Of those that vary: of u.
  [[nodiscard]] std::size_t dimension() const { return random_.size(); }
  /// Their indices among the study's variables.
  [[nodiscard]] const std::vector<std::size_t>& random() const { return random_; }
  [[nodiscard]] const std::vector<double>& nominal() const { return nominal_; }

  /// All variables at the point u.
  void values_at(const double* u, double* values) const;
  /// The value of a varying variable (a place in random()) that is not exceeded with probability p.
  [[nodiscard]] double quantile(std::size_t place, double p) const;
  /// "lognormal, mean 0.25, standard deviation 0.05", with what a fit found.
  [[nodiscard]] const std::string& text(std::size_t place) const { return texts_[place]; }
  /// What was fitted to measurements.
  struct Fit {
    std::string variable, text;
    bool is_misfit = false; ///< the measurements contradict it
  };
  [[nodiscard]] const std::vector<Fit>& fits() const { return fits_; }
  [[nodiscard]] bool is_independent() const { return root_.empty(); }

private:
  struct Marginal;
  void correlate(const Study& study, std::vector<Diagnostic>& problems);
  std::vector<Marginal> marginals_;
  std::vector<std::size_t> random_;
  std::vector<double> nominal_;
  std::vector<std::string> texts_;
  std::vector<Fit> fits_;
  std::vector<double> root_; ///< lower triangle, row by row; empty: independent
};

/// Of the distribution of a variable that has one: where studies around a point stand. Throws ModelError.
[[nodiscard]] double mean_of(const Variable& variable);

/// Φ and its inverse.
[[nodiscard]] double normal_cdf(double z);
[[nodiscard]] double normal_quantile(double p);
/// Bounds of a probability of which `successes` of `trials` were seen (Clopper and Pearson).
struct Interval {
  double low = 0.0, high = 1.0;
};
[[nodiscard]] Interval proportion_interval(double successes, double trials, double confidence);
/// Of Student's distribution.
[[nodiscard]] double student_quantile(double degrees, double p);

} // namespace steplap::study
