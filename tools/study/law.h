// Joint probability distribution of a study's variables as a function of standard normal variables (Nataf transformation): x_i =
// F_i⁻¹(Φ(z_i)), z = L u, with u independent standard normal and L Lᵀ the correlation matrix of the normal copula.
//
// Marginal distributions are those of OpenTURNS. A variable with a range is uniform; one without range and distribution is constant. Not
// thread-safe.
#pragma once

#include "tools/study/study.h"

#include <memory>

namespace steplap::study {

/// The joint distribution of all variables of a study.
class JointLaw {
public:
  /// `nominal`: values of all variables, used for constant ones. Errors in distributions and correlations are appended to `problems`; if
  /// there are any, the object must not be used.
  JointLaw(const Study& study, std::vector<double> nominal, std::vector<Diagnostic>& problems);
  JointLaw(JointLaw&&) noexcept;
  ~JointLaw();

  /// Returns the number of random variables, which is the dimension of u.
  [[nodiscard]] std::size_t dimension() const { return random_.size(); }
  /// Returns their indices among the study's variables.
  [[nodiscard]] const std::vector<std::size_t>& random() const { return random_; }
  [[nodiscard]] const std::vector<double>& nominal() const { return nominal_; }

  /// Writes the values of all variables at the point u.
  void values_at(const double* u, double* values) const;
  /// Returns the p-quantile of a random variable. `place`: index in random().
  [[nodiscard]] double quantile(std::size_t place, double p) const;
  /// Derivatives of a reliability index β with respect to the distribution of one random variable, at fixed limit state.
  struct IndexSlope {
    double by_mean = 0.0;      ///< per unit shift of the distribution, in 1/unit of the variable
    double by_deviation = 0.0; ///< per unit increase in the standard deviation, by stretching about the mean
  };
  /// Returns one entry per random variable, at a design point `u` with index `beta` ≠ 0 (M. Hohenbichler, R. Rackwitz, Sensitivity and
  /// importance measures in structural reliability, Civil Engineering Systems 3, 1986). Shifting and stretching preserve the shape of the
  /// distribution; a normal distribution stays normal.
  [[nodiscard]] std::vector<IndexSlope> index_slopes(const std::vector<double>& u, double beta) const;
  /// Another distribution of one random variable, of the same shape, whatever its kind. The correlations of the normal variables stay.
  struct Change {
    double shift = 0.0;   ///< of the mean
    double stretch = 1.0; ///< factor of the standard deviation
  };
  /// Returns the ratio of the changed joint density to the present one at the point u, for the random variable at this position in random().
  [[nodiscard]] double density_ratio(const double* u, std::size_t place, const Change& change) const;
  /// Returns the probability of changed values that the present distribution does not take.
  [[nodiscard]] double unreachable_share(std::size_t place, const Change& change) const;
  /// Returns the mean of a random variable; standard_deviation() returns its standard deviation. `place`: index in random().
  [[nodiscard]] double mean(std::size_t place) const;
  [[nodiscard]] double standard_deviation(std::size_t place) const;
  /// Returns a description: "lognormal, mean 0.25, standard deviation 0.05", with the result of a fit if there is one.
  [[nodiscard]] const std::string& text(std::size_t place) const { return texts_[place]; }
  /// A distribution fitted to measurements.
  struct Fit {
    std::string variable, text;
    bool is_misfit = false; ///< true if the measurements contradict the distribution
  };
  [[nodiscard]] const std::vector<Fit>& fits() const { return fits_; }
  [[nodiscard]] bool is_independent() const { return root_.empty(); }

private:
  struct Marginal;
  [[nodiscard]] std::vector<double> correlated(const double* u) const;
  [[nodiscard]] std::vector<double> uncorrelated(const std::vector<double>& z) const;
  [[nodiscard]] double unchanged(std::size_t place, double x, const Change& change) const;
  void correlate(const Study& study, std::vector<Diagnostic>& problems);
  std::vector<Marginal> marginals_;
  std::vector<std::size_t> random_;
  std::vector<double> nominal_;
  std::vector<std::string> texts_;
  std::vector<Fit> fits_;
  std::vector<double> root_; ///< Cholesky factor L, lower triangle, row by row; empty: independent
};

/// Returns the mean of a variable's distribution, around which local studies are made. Throws ModelError.
[[nodiscard]] double mean_of(const Variable& variable);

/// Returns Φ(z), the standard normal distribution function; normal_quantile() is its inverse.
[[nodiscard]] double normal_cdf(double z);
[[nodiscard]] double normal_quantile(double p);
/// Confidence interval of a probability after `successes` in `trials` (Clopper and Pearson).
struct Interval {
  double low = 0.0, high = 1.0;
};
/// Returns the interval for the given confidence, 0 to 1.
[[nodiscard]] Interval proportion_interval(double successes, double trials, double confidence);
/// Returns the p-quantile of Student's distribution.
[[nodiscard]] double student_quantile(double degrees, double p);

} // namespace steplap::study
