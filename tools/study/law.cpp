#include "tools/study/law.h"

#include "mbd/base/number_text.h"
#include "tools/study/measured_law.h"

#include <openturns/Beta.hxx>
#include <openturns/BetaMuSigma.hxx>
#include <openturns/DistFunc.hxx>
#include <openturns/Distribution.hxx>
#include <openturns/Exponential.hxx>
#include <openturns/GaussLegendre.hxx>
#include <openturns/Gumbel.hxx>
#include <openturns/LogNormal.hxx>
#include <openturns/Normal.hxx>
#include <openturns/Triangular.hxx>
#include <openturns/Uniform.hxx>
#include <openturns/WeibullMin.hxx>
#include <openturns/WeibullMinMuSigma.hxx>

#include <cmath>
#include <numbers>

namespace steplap::study {

struct JointLaw::Marginal {
  OT::Distribution distribution;
  // Normal and lognormal distributions have a closed form in z; general ones are inverted numerically.
  enum class Form { general, normal, lognormal } form = Form::general;
  double a = 0.0, b = 1.0, location = 0.0;

  [[nodiscard]] double at(double z) const {
    if (form == Form::normal) return a + b * z;
    if (form == Form::lognormal) return location + std::exp(a + b * z);
    // Both tails with full precision.
    return z < 0.0 ? distribution.computeQuantile(normal_cdf(z), false)[0] : distribution.computeQuantile(normal_cdf(-z), true)[0];
  }
  /// Inverse of at(); infinite where the distribution takes no values.
  [[nodiscard]] double normal_at(double x) const {
    const double below = distribution.computeCDF(x);
    return below < 0.5 ? quantile_or_end(below) : -quantile_or_end(distribution.computeComplementaryCDF(x));
  }

private:
  static double quantile_or_end(double p) { return p > 0.0 ? normal_quantile(p) : -std::numeric_limits<double>::infinity(); }
};

namespace {

[[noreturn]] void complain(const Variable& v, const std::string& message) {
  throw ModelError(v.where, "variable '" + v.name + "': " + message);
}

double needed(const Variable& v, const std::optional<double>& field, const char* name) {
  if (!field) complain(v, "its " + v.distribution + " distribution needs '" + name + "'");
  return *field;
}

struct Moments {
  double mean, deviation;
};

Moments moments_of(const Variable& v) {
  const double mean = needed(v, v.mean, "mean");
  if (v.cov && v.standard_deviation) complain(v, "'cov' and 'standard_deviation' exclude each other");
  if (v.cov) {
    if (mean == 0.0) complain(v, "a mean of 0 has no coefficient of variation: give 'standard_deviation'");
    return {mean, *v.cov * std::abs(mean)};
  }
  return {mean, needed(v, v.standard_deviation, "standard_deviation' or 'cov")};
}

// Checks that every field given is used by the distribution.
void check_fields(const Variable& v) {
  struct FieldUse {
    const char* name;
    bool is_given;
    const char* of; ///< names of the distributions that use this field
  };
  const FieldUse all[] = {{"mean", v.mean.has_value(), "normal lognormal uniform weibull gumbel beta exponential"},
                          {"standard_deviation", v.standard_deviation.has_value(), "normal lognormal uniform weibull gumbel beta"},
                          {"cov", v.cov.has_value(), "normal lognormal uniform weibull gumbel beta"},
                          {"low", v.low.has_value(), "uniform triangular beta"},
                          {"high", v.high.has_value(), "uniform triangular beta"},
                          {"mode", v.mode.has_value(), "triangular"},
                          {"shape", v.shape.has_value(), "weibull beta"},
                          {"shape2", v.shape2.has_value(), "beta"},
                          {"scale", v.scale.has_value(), "weibull gumbel exponential"},
                          {"location", v.location.has_value(), "lognormal weibull gumbel exponential"}};
  for (const FieldUse& given : all)
    if (given.is_given && (" " + std::string(given.of) + " ").find(" " + v.distribution + " ") == std::string::npos)
      complain(v, "a " + v.distribution + " distribution has no '" + given.name + "'");
  const bool has_moments = v.mean || v.standard_deviation || v.cov;
  if (has_moments &&
      (v.shape || v.scale || (v.distribution == "gumbel" && v.location) || (v.distribution == "uniform" && (v.low || v.high))))
    complain(v, "give either its moments or its parameters, not both");
}

OT::Distribution by_parameters(const Variable& v) {
  check_fields(v);
  const std::string& kind = v.distribution;
  const double location = v.location.value_or(0.0);
  if (kind == "normal") {
    const Moments m = moments_of(v);
    return OT::Normal(m.mean, m.deviation);
  }
  if (kind == "lognormal") {
    const Moments m = moments_of(v);
    if (!(m.mean > location)) complain(v, "the mean of a lognormal distribution must be above its location");
    const double c = m.deviation / (m.mean - location), zeta2 = std::log1p(c * c);
    return OT::LogNormal(std::log(m.mean - location) - 0.5 * zeta2, std::sqrt(zeta2), location);
  }
  if (kind == "uniform") {
    if (v.mean) {
      const Moments m = moments_of(v);
      const double half = std::sqrt(3.0) * m.deviation;
      return OT::Uniform(m.mean - half, m.mean + half);
    }
    if (needed(v, v.low, "low") >= needed(v, v.high, "high")) complain(v, "'low' must be below 'high'");
    return OT::Uniform(*v.low, *v.high);
  }
  if (v.low && v.high && *v.low >= *v.high) complain(v, "'low' must be below 'high'");
  if (v.mode && v.low && v.high && (*v.mode < *v.low || *v.mode > *v.high)) complain(v, "'mode' must lie between 'low' and 'high'");
  if (kind == "triangular") return OT::Triangular(needed(v, v.low, "low"), needed(v, v.mode, "mode"), needed(v, v.high, "high"));
  if (kind == "weibull") {
    if (!v.mean) return OT::WeibullMin(needed(v, v.scale, "scale"), needed(v, v.shape, "shape"), location);
    const Moments m = moments_of(v);
    if (!(m.mean > location)) complain(v, "the mean of a Weibull distribution must be above its location");
    const OT::Point p = OT::WeibullMinMuSigma(m.mean, m.deviation, location).evaluate();
    return OT::WeibullMin(p[0], p[1], p[2]);
  }
  if (kind == "gumbel") {
    if (!v.mean) return OT::Gumbel(needed(v, v.scale, "scale"), needed(v, v.location, "location"));
    const Moments m = moments_of(v);
    const double scale = m.deviation * std::sqrt(6.0) / std::numbers::pi;
    return OT::Gumbel(scale, m.mean - std::numbers::egamma * scale);
  }
  if (kind == "beta") {
    const double low = needed(v, v.low, "low"), high = needed(v, v.high, "high");
    if (!v.mean) return OT::Beta(needed(v, v.shape, "shape"), needed(v, v.shape2, "shape2"), low, high);
    const Moments m = moments_of(v);
    const OT::Point p = OT::BetaMuSigma(m.mean, m.deviation, low, high).evaluate();
    return OT::Beta(p[0], p[1], p[2], p[3]);
  }
  if (v.mean && v.scale) complain(v, "give either 'mean' or 'scale'");
  const double scale = v.scale ? *v.scale : needed(v, v.mean, "mean") - location;
  if (!(scale > 0.0)) complain(v, "the mean of an exponential distribution must be above its location");
  return OT::Exponential(1.0 / scale, location);
}

struct Described {
  OT::Distribution distribution;
  std::string fit; ///< text about the fit; "" if the distribution was not fitted
  bool is_misfit = false;
};

// Returns the reason why individually valid parameters define no distribution.
std::string why_there_is_none(const Variable& v) {
  if (!v.measured.empty())
    return "no " + v.distribution + " distribution fits the values of '" + v.measured +
           "': " + "they are too few, all alike, or none that such a distribution can take";
  const std::pair<const char*, const std::optional<double>&> all[] = {{"mean", v.mean},   {"standard_deviation", v.standard_deviation},
                                                                      {"cov", v.cov},     {"low", v.low},
                                                                      {"mode", v.mode},   {"high", v.high},
                                                                      {"shape", v.shape}, {"shape2", v.shape2},
                                                                      {"scale", v.scale}, {"location", v.location}};
  std::string given;
  for (const auto& [name, value] : all)
    if (value) given += (given.empty() ? "" : ", ") + std::string(name) + " = " + number_text(*value);
  if (v.lower || v.upper) {
    try {
      (void)by_parameters(v); // throws if the parameters alone are invalid; otherwise the bounds are the reason
      return "'lower' and 'upper' leave nothing of a " + v.distribution + " distribution with " + given;
    } catch (const std::exception&) {}
  }
  return "there is no " + v.distribution + " distribution with " + given;
}

Described distribution_of(const Variable& v) {
  try {
    if (!v.has_distribution()) return {OT::Uniform(v.range[0], v.range[1]), ""};
    if (v.measured.empty()) return {truncated(v, by_parameters(v)), ""};
    const MeasuredLaw law = measured_law(v);
    return {law.distribution, law.text, law.is_misfit};
  } catch (const ModelError&) {
    throw;
  } catch (const std::exception&) { // the library's message is not meant for users
    complain(v, why_there_is_none(v));
  }
}

std::string words_of(const Variable& v, const OT::Distribution& d, const std::string& fit) {
  const auto digits = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", x);
    return std::string(text);
  };
  const std::string unit = v.unit.empty() || v.unit == "*" ? "" : " " + v.unit;
  return (v.has_distribution() ? v.distribution : "uniform") + ", mean " + digits(d.getMean()[0]) + unit + ", standard deviation " +
         digits(d.getStandardDeviation()[0]) + unit + fit;
}

} // namespace

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }
double normal_quantile(double p) { return p < 0.5 ? OT::DistFunc::qNormal(p) : OT::DistFunc::qNormal(1.0 - p, true); }
double student_quantile(double degrees, double p) { return OT::DistFunc::qStudent(degrees, p); }

Interval proportion_interval(double successes, double trials, double confidence) {
  const double alpha = 0.5 * (1.0 - confidence);
  Interval interval;
  if (trials <= 0.0) return interval;
  if (successes > 0.0) interval.low = OT::DistFunc::qBeta(successes, trials - successes + 1.0, alpha);
  if (successes < trials) interval.high = OT::DistFunc::qBeta(successes + 1.0, trials - successes, alpha, true);
  return interval;
}

double mean_of(const Variable& variable) {
  try {
    return distribution_of(variable).distribution.getMean()[0];
  } catch (const ModelError&) {
    throw;
  } catch (const std::exception&) {
    complain(variable, why_there_is_none(variable));
  }
}

JointLaw::JointLaw(const Study& study, std::vector<double> nominal, std::vector<Diagnostic>& problems) : nominal_(std::move(nominal)) {
  for (std::size_t i = 0; i < study.variables.size(); ++i) {
    const Variable& v = study.variables[i];
    if (!v.has_distribution() && v.range.size() != 2) continue;
    try {
      const Described described = distribution_of(v);
      Marginal m;
      m.distribution = described.distribution;
      const OT::Point p = m.distribution.getParameter();
      const bool is_plain = !v.lower && !v.upper;
      if (is_plain && v.distribution == "normal") m.form = Marginal::Form::normal;
      if (is_plain && v.distribution == "lognormal") m.form = Marginal::Form::lognormal;
      if (m.form != Marginal::Form::general) m.a = p[0], m.b = p[1];
      if (m.form == Marginal::Form::lognormal) m.location = p[2];
      for (const double z : {-3.0, 0.0, 3.0}) // fails now if the distribution cannot be evaluated numerically
        if (std::isnan(m.at(z))) throw std::domain_error("no quantile");
      texts_.push_back(words_of(v, m.distribution, described.fit));
      if (!described.fit.empty()) fits_.push_back({v.name, texts_.back(), described.is_misfit});
      marginals_.push_back(std::move(m));
      random_.push_back(i);
    } catch (const ModelError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
    } catch (const std::exception&) {
      problems.push_back({v.where, "variable '" + v.name + "': " + why_there_is_none(v)});
    }
  }
  if (problems.empty()) correlate(study, problems);
}

JointLaw::JointLaw(JointLaw&&) noexcept = default;
JointLaw::~JointLaw() = default;

double JointLaw::quantile(std::size_t place, double p) const { return marginals_[place].at(normal_quantile(p)); }

// z = L u.
std::vector<double> JointLaw::correlated(const double* u) const {
  std::vector<double> z(u, u + random_.size());
  if (root_.empty()) return z;
  for (std::size_t i = 0; i < random_.size(); ++i) {
    z[i] = 0.0;
    for (std::size_t j = 0; j <= i; ++j) z[i] += root_[i * (i + 1) / 2 + j] * u[j];
  }
  return z;
}

// u = L⁻¹ z.
std::vector<double> JointLaw::uncorrelated(const std::vector<double>& z) const {
  std::vector<double> u = z;
  for (std::size_t i = 0; i < z.size() && !root_.empty(); ++i) {
    for (std::size_t j = 0; j < i; ++j) u[i] -= root_[i * (i + 1) / 2 + j] * u[j];
    u[i] /= root_[i * (i + 1) / 2 + i];
  }
  return u;
}

// The value from which the change made x.
double JointLaw::unchanged(std::size_t place, double x, const Change& change) const {
  return mean(place) + (x - mean(place) - change.shift) / change.stretch;
}

// The changed value x has the density f(t)/c with the unchanged value t and the stretch c. The normal variables have the density φ(u) with
// u = L⁻¹ z, that of variable i alone φ(z_i); both change from z_i(x) to z_i(t).
double JointLaw::density_ratio(const double* u, std::size_t place, const Change& change) const {
  std::vector<double> z = correlated(u);
  const OT::Distribution& distribution = marginals_[place].distribution;
  const double x = marginals_[place].at(z[place]), t = unchanged(place, x, change);
  const double ratio = distribution.computePDF(t) / (change.stretch * distribution.computePDF(x));
  if (is_independent() || ratio == 0.0) return ratio;
  const auto dependence = [&] {
    const std::vector<double> v = uncorrelated(z);
    double exponent = 0.5 * z[place] * z[place];
    for (const double one : v) exponent -= 0.5 * one * one;
    return exponent;
  };
  const double before = dependence();
  z[place] = marginals_[place].normal_at(t);
  return std::isfinite(z[place]) ? ratio * std::exp(dependence() - before) : 0.0;
}

double JointLaw::unreachable_share(std::size_t place, const Change& change) const {
  const OT::Distribution& distribution = marginals_[place].distribution;
  const OT::Interval range = distribution.getRange();
  double share = 0.0;
  if (range.getFiniteLowerBound()[0]) share += distribution.computeCDF(unchanged(place, range.getLowerBound()[0], change));
  if (range.getFiniteUpperBound()[0]) share += distribution.computeComplementaryCDF(unchanged(place, range.getUpperBound()[0], change));
  return share;
}

void JointLaw::values_at(const double* u, double* values) const {
  std::copy(nominal_.begin(), nominal_.end(), values);
  const std::vector<double> z = correlated(u);
  for (std::size_t i = 0; i < random_.size(); ++i) values[random_[i]] = marginals_[i].at(z[i]);
}

double JointLaw::mean(std::size_t place) const { return marginals_[place].distribution.getMean()[0]; }
double JointLaw::standard_deviation(std::size_t place) const { return marginals_[place].distribution.getStandardDeviation()[0]; }

// β = |u| with u = L⁻¹ z and z_i = Φ⁻¹(F_i(x_i)), so that ∂β/∂p = (u/β)ᵀ L⁻¹ ∂z/∂p at fixed x. If the distribution moves by δ,
// ∂z_i/∂δ = −1/(dx_i/dz_i); if it is stretched by 1 + ε about its mean m_i, ∂z_i/∂ε = −(x_i − m_i)/(dx_i/dz_i).
std::vector<JointLaw::IndexSlope> JointLaw::index_slopes(const std::vector<double>& u, double beta) const {
  const std::size_t n = random_.size();
  std::vector<double> w(n); // L⁻ᵀ u/β
  for (std::size_t i = n; i-- > 0;) {
    double sum = u[i] / beta;
    for (std::size_t k = i + 1; k < n && !root_.empty(); ++k) sum -= root_[k * (k + 1) / 2 + i] * w[k];
    w[i] = root_.empty() ? sum : sum / root_[i * (i + 1) / 2 + i];
  }
  const std::vector<double> z = correlated(u.data());
  std::vector<IndexSlope> slopes;
  for (std::size_t i = 0; i < n; ++i) {
    constexpr double h = 1e-4; // truncation error h² = 1e-8, rounding error 1e-12
    const double slope = (marginals_[i].at(z[i] + h) - marginals_[i].at(z[i] - h)) / (2.0 * h), x = marginals_[i].at(z[i]);
    slopes.push_back({-w[i] / slope, -w[i] * (x - mean(i)) / (slope * standard_deviation(i))});
  }
  return slopes;
}

namespace {

// Computes the correlation of two variables whose normal variables have correlation rho0, by Gauss-Legendre quadrature over ±8.5 standard
// deviations.
class NatafIntegral {
public:
  template <class A, class B> NatafIntegral(const A& a, const B& b) {
    const OT::GaussLegendre rule(OT::Indices(1, k_points));
    const OT::Sample nodes = rule.getNodes();
    const OT::Point weights = rule.getWeights();
    for (int i = 0; i < k_points; ++i) {
      z_.push_back(k_reach * (2.0 * nodes(i, 0) - 1.0));
      w_.push_back(2.0 * k_reach * weights[i] * std::exp(-0.5 * z_.back() * z_.back()) / std::sqrt(2.0 * std::numbers::pi));
    }
    standardise(a, a_);
    // Evaluated at each required z, because interpolation in a table is not accurate enough.
    b_ = [&b](double z) { return b.at(z); };
    std::vector<double> values;
    for (const double z : z_) values.push_back(b.at(z));
    double mean = 0.0, square = 0.0;
    for (int i = 0; i < k_points; ++i) mean += w_[i] * values[i];
    for (int i = 0; i < k_points; ++i) square += w_[i] * (values[i] - mean) * (values[i] - mean);
    mean_b_ = mean;
    deviation_b_ = std::sqrt(square);
  }

  [[nodiscard]] double operator()(double rho0) const {
    const double rest = std::sqrt(1.0 - rho0 * rho0);
    double sum = 0.0;
    for (int i = 0; i < k_points; ++i)
      for (int j = 0; j < k_points; ++j)
        if (w_[i] * w_[j] > 1e-18) sum += w_[i] * w_[j] * a_[i] * (b_(rho0 * z_[i] + rest * z_[j]) - mean_b_) / deviation_b_;
    return sum;
  }

private:
  static constexpr int k_points = 40;
  static constexpr double k_reach = 8.0;

  template <class A> void standardise(const A& a, std::vector<double>& out) {
    double mean = 0.0, square = 0.0;
    for (const double z : z_) out.push_back(a.at(z));
    for (int i = 0; i < k_points; ++i) mean += w_[i] * out[i];
    for (int i = 0; i < k_points; ++i) square += w_[i] * (out[i] - mean) * (out[i] - mean);
    for (double& x : out) x = (x - mean) / std::sqrt(square);
  }

  std::vector<double> z_, w_, a_;
  std::function<double(double)> b_;
  double mean_b_ = 0.0, deviation_b_ = 1.0;
};

// Returns the correlation of the normal variables that gives the correlation `rho` of the variables; NaN if there is none.
double normal_correlation(const NatafIntegral& nataf, double rho) {
  double low = -0.99999, high = 0.99999;
  double below = nataf(low) - rho, above = nataf(high) - rho;
  if (below > 0.0 || above < 0.0) return std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 60 && high - low > 1e-12; ++i) { // regula falsi with halving (Illinois)
    double middle = low - below * (high - low) / (above - below);
    if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
    const double value = nataf(middle) - rho;
    if (std::abs(value) < 1e-12) return middle;
    if (value < 0.0) low = middle, below = value, above *= 0.5;
    else high = middle, above = value, below *= 0.5;
  }
  return 0.5 * (low + high);
}

} // namespace

void JointLaw::correlate(const Study& study, std::vector<Diagnostic>& problems) {
  if (study.correlations.empty()) return;
  const std::size_t n = random_.size();
  std::vector<double> matrix(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) matrix[i * n + i] = 1.0;
  for (const Correlation& c : study.correlations) {
    std::size_t place[2]{};
    for (int k = 0; k < 2; ++k)
      place[k] =
          static_cast<std::size_t>(std::find(random_.begin(), random_.end(), study.index_of_variable(c.between[k])) - random_.begin());
    double rho = c.rho;
    if (c.of == "ranks") rho = 2.0 * std::sin(std::numbers::pi * c.rho / 6.0);
    if (c.of == "values") rho = normal_correlation(NatafIntegral(marginals_[place[0]], marginals_[place[1]]), c.rho);
    if (std::isnan(rho))
      problems.push_back({c.where, "'" + c.between[0] + "' and '" + c.between[1] + "' cannot have a correlation of " + number_text(c.rho) +
                                       ": their distributions differ too much"});
    matrix[place[0] * n + place[1]] = matrix[place[1] * n + place[0]] = rho;
  }
  root_.assign(n * (n + 1) / 2, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = matrix[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= root_[i * (i + 1) / 2 + k] * root_[j * (j + 1) / 2 + k];
      if (i != j) {
        root_[i * (i + 1) / 2 + j] = sum / root_[j * (j + 1) / 2 + j];
        continue;
      }
      if (!(sum > 1e-12)) {
        problems.push_back(
            {study.correlations.front().where, "the correlations contradict each other: their matrix is not positive definite"});
        return;
      }
      root_[i * (i + 1) / 2 + i] = std::sqrt(sum);
    }
}

} // namespace steplap::study
