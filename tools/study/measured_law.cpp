#include "tools/study/measured_law.h"

#include "mbd/base/number_text.h"
#include "mbd/io/column_unit.h"
#include "mbd/io/csv.h"

#include <openturns/BetaFactory.hxx>
#include <openturns/ExponentialFactory.hxx>
#include <openturns/FittingTest.hxx>
#include <openturns/GumbelFactory.hxx>
#include <openturns/LogNormal.hxx>
#include <openturns/NormalFactory.hxx>
#include <openturns/TriangularFactory.hxx>
#include <openturns/TruncatedDistribution.hxx>
#include <openturns/UniformFactory.hxx>
#include <openturns/WeibullMin.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace steplap::study {

namespace {

[[noreturn]] void complain(const Variable& v, const std::string& message) {
  throw ModelError(v.where, "variable '" + v.name + "': " + message);
}

std::vector<double> values_of(const Variable& v) {
  const CsvTable table = read_csv(v.measured, v.where);
  const std::size_t column = table.columns.size() == 1 && v.column.empty() ? 0 : table.column(v.column, v.where);
  std::vector<double> values = table.columns[column];
  const std::string unit = v.unit.empty() && !v.is_factor ? "*" : v.unit;
  const UnitConversion conversion = conversion_of(table, column, {"variable '" + v.name + "'", "", "", v.where, unit});
  for (double& value : values) value = conversion.factor * value + conversion.shift;
  constexpr std::size_t k_fewest = 5;
  if (values.size() < k_fewest)
    complain(v, "'" + v.measured + "' has " + std::to_string(values.size()) + " values: too few for a distribution");
  return values;
}

OT::Sample logarithms(OT::Sample sample, double factor) {
  for (OT::UnsignedInteger i = 0; i < sample.getSize(); ++i) sample(i, 0) = factor * std::log(sample(i, 0));
  return sample;
}

// Lognormal and Weibull laws that begin at 0. With a location fitted as well, few values give a law that begins at the smallest of them: the
// likelihood has no maximum there.
OT::Distribution fitted_lognormal(const OT::Sample& sample) {
  const OT::Distribution of_logarithms = OT::NormalFactory().build(logarithms(sample, 1.0));
  return OT::LogNormal(of_logarithms.getParameter()[0], of_logarithms.getParameter()[1], 0.0);
}
// −ln x of a Weibull variable x has a Gumbel law.
OT::Distribution fitted_weibull(const OT::Sample& sample) {
  const OT::Distribution of_logarithms = OT::GumbelFactory().build(logarithms(sample, -1.0));
  return OT::WeibullMin(std::exp(-of_logarithms.getParameter()[1]), 1.0 / of_logarithms.getParameter()[0], 0.0);
}

OT::Distribution fitted(const std::string& kind, const OT::Sample& sample) {
  if (kind == "normal") return OT::NormalFactory().build(sample);
  if (kind == "lognormal") return fitted_lognormal(sample);
  if (kind == "uniform") return OT::UniformFactory().build(sample);
  if (kind == "triangular") return OT::TriangularFactory().build(sample);
  if (kind == "weibull") return fitted_weibull(sample);
  if (kind == "gumbel") return OT::GumbelFactory().build(sample);
  if (kind == "beta") return OT::BetaFactory().build(sample);
  return OT::ExponentialFactory().build(sample);
}

using Pair = std::array<double, 2>;

// Minimises a function of two numbers by the Nelder-Mead simplex.
template <class Function> Pair minimise_nelder_mead(const Function& function, const Pair& start, double step) {
  struct Corner {
    Pair at;
    double value;
  };
  const auto look = [&](const Pair& p) { return Corner{p, function(p)}; };
  std::array<Corner, 3> s{look(start), look({start[0] + step, start[1]}), look({start[0], start[1] + step})};
  for (int round = 0; round < 1000; ++round) {
    std::stable_sort(s.begin(), s.end(), [](const Corner& a, const Corner& b) { return a.value < b.value; });
    const double width = std::max(std::hypot(s[1].at[0] - s[0].at[0], s[1].at[1] - s[0].at[1]),
                                  std::hypot(s[2].at[0] - s[0].at[0], s[2].at[1] - s[0].at[1]));
    if (width < 1e-9) break;
    const Pair middle{0.5 * (s[0].at[0] + s[1].at[0]), 0.5 * (s[0].at[1] + s[1].at[1])};
    const auto beyond = [&](double share) {
      return look({middle[0] + share * (middle[0] - s[2].at[0]), middle[1] + share * (middle[1] - s[2].at[1])});
    };
    const Corner reflected = beyond(1.0);
    if (reflected.value < s[0].value) {
      const Corner expanded = beyond(2.0);
      s[2] = expanded.value < reflected.value ? expanded : reflected;
      continue;
    }
    if (reflected.value < s[1].value) {
      s[2] = reflected;
      continue;
    }
    const Corner nearer = reflected.value < s[2].value ? beyond(0.5) : beyond(-0.5);
    if (nearer.value < std::min(reflected.value, s[2].value)) {
      s[2] = nearer;
      continue;
    }
    for (std::size_t k = 1; k < s.size(); ++k) s[k] = look({0.5 * (s[0].at[0] + s[k].at[0]), 0.5 * (s[0].at[1] + s[k].at[1])});
  }
  return s[0].at;
}

// Returns the distribution without bounds for two parameters that may have any value.
OT::Distribution unbounded(const std::string& kind, const Pair& p) {
  if (kind == "normal") return OT::Normal(p[0], std::exp(p[1]));
  if (kind == "lognormal") return OT::LogNormal(p[0], std::exp(p[1]));
  if (kind == "gumbel") return OT::Gumbel(std::exp(p[1]), p[0]);
  if (kind == "weibull") return OT::WeibullMin(std::exp(p[0]), std::exp(p[1]));
  return OT::Exponential(std::exp(-p[0]));
}

Pair beginning(const std::string& kind, const std::vector<double>& values) {
  const bool is_log = kind == "lognormal";
  double mean = 0.0, squares = 0.0;
  const double n = static_cast<double>(values.size());
  for (const double x : values) mean += (is_log ? std::log(x) : x) / n;
  for (const double x : values) squares += std::pow((is_log ? std::log(x) : x) - mean, 2) / n;
  if (kind == "weibull") return {std::log(mean), std::log(2.0)};
  if (kind == "exponential") return {std::log(mean), 0.0};
  return {mean, 0.5 * std::log(squares)};
}

// Returns the probability between the variable's bounds. Uses the complementary distribution function above the median, to avoid
// cancellation.
double share_within(const Variable& v, const OT::Distribution& whole) {
  if (!v.upper) return whole.computeComplementaryCDF(*v.lower);
  if (!v.lower) return whole.computeCDF(*v.upper);
  const double below = whole.computeCDF(*v.lower);
  return below > 0.5 ? whole.computeComplementaryCDF(*v.lower) - whole.computeComplementaryCDF(*v.upper)
                     : whole.computeCDF(*v.upper) - below;
}

// Fits a distribution by maximum likelihood to values that were truncated at the bounds.
OT::Distribution fitted_within(const Variable& v, const std::vector<double>& values, const OT::Sample& sample) {
  if (v.distribution == "uniform" || v.distribution == "triangular" || v.distribution == "beta")
    complain(v, "a " + v.distribution + " distribution fitted to 'measured' has its own ends: leave out 'lower' and 'upper'");
  const bool is_positive = v.distribution != "normal" && v.distribution != "gumbel";
  if (is_positive && *std::min_element(values.begin(), values.end()) <= 0.0)
    complain(v, "a truncated " + v.distribution + " distribution is fitted to values above zero only, and '" + v.measured + "' has others");
  if (std::all_of(values.begin(), values.end(), [&](double x) { return x == values.front(); }))
    complain(v, "all values of '" + v.measured + "' are the same: they have no distribution");
  // smallest probability between the bounds; smaller tails of different distributions are too similar to determine the parameters
  constexpr double k_least = 1e-6;
  constexpr double k_impossible = std::numeric_limits<double>::infinity();
  const auto surprise = [&](const Pair& p) { // negative log-likelihood
    try {
      const OT::Distribution whole = unbounded(v.distribution, p);
      const double part = share_within(v, whole);
      if (!(part > k_least)) return k_impossible;
      double sum = static_cast<double>(values.size()) * std::log(part);
      const OT::Sample logs = whole.computeLogPDF(sample);
      for (OT::UnsignedInteger i = 0; i < logs.getSize(); ++i) sum -= logs(i, 0);
      return std::isfinite(sum) ? sum : k_impossible;
    } catch (const OT::Exception&) { // the parameters are outside the domain of the distribution
      return k_impossible;
    }
  };
  Pair at = beginning(v.distribution, values);
  double step = v.distribution == "normal" || v.distribution == "gumbel" ? 0.5 * std::exp(at[1]) : 0.3;
  for (int i = 0; i < 3; ++i, step *= 0.3)
    at = minimise_nelder_mead(surprise, at, step); // repeated, because a simplex may collapse too early
  return unbounded(v.distribution, at);
}

} // namespace

OT::Distribution truncated(const Variable& v, const OT::Distribution& distribution) {
  if (!v.lower && !v.upper) return distribution;
  if (v.lower && v.upper && !(*v.lower < *v.upper)) complain(v, "'lower' must be below 'upper'");
  if (v.lower && v.upper) return OT::TruncatedDistribution(distribution, *v.lower, *v.upper);
  return v.lower ? OT::TruncatedDistribution(distribution, *v.lower, OT::TruncatedDistribution::LOWER)
                 : OT::TruncatedDistribution(distribution, *v.upper, OT::TruncatedDistribution::UPPER);
}

MeasuredLaw measured_law(const Variable& v) {
  const bool has_more =
      v.mean || v.standard_deviation || v.cov || v.low || v.high || v.mode || v.shape || v.shape2 || v.scale || v.location;
  if (has_more) complain(v, "a distribution fitted to 'measured' takes no parameters");
  const std::vector<double> values = values_of(v);
  OT::Sample sample(values.size(), 1);
  for (std::size_t i = 0; i < values.size(); ++i) sample(i, 0) = values[i];
  const auto outside = std::count_if(values.begin(), values.end(), [&](double x) {
    return x < v.lower.value_or(-std::numeric_limits<double>::infinity()) || x > v.upper.value_or(std::numeric_limits<double>::infinity());
  });
  const bool is_of_logarithms = v.distribution == "lognormal" || v.distribution == "weibull";
  if (is_of_logarithms && *std::min_element(values.begin(), values.end()) <= 0.0)
    complain(v, "a " + v.distribution + " distribution is fitted to values above zero only, and '" + v.measured + "' has others");
  if (is_of_logarithms && std::all_of(values.begin(), values.end(), [&](double x) { return x == values.front(); }))
    complain(v, "all values of '" + v.measured + "' are the same: they have no distribution");
  const bool is_within = (v.lower || v.upper) && outside == 0;
  const OT::Distribution whole = is_within ? fitted_within(v, values, sample) : fitted(v.distribution, sample);
  MeasuredLaw law;
  law.distribution = truncated(v, whole);
  const double p = OT::FittingTest::Kolmogorov(sample, is_within ? law.distribution : whole, 0.05).getPValue();
  law.is_misfit = p < 0.01;
  law.text = ", fitted to " + std::to_string(values.size()) + " values (Kolmogorov's p " + number_text(std::round(p * 1000.0) / 1000.0) +
             (p < 0.05 ? ": it does not fit" : "") + ")";
  if (outside > 0) law.text += ", then cut off: " + std::to_string(outside) + " of the values lie outside the bounds";
  return law;
}

} // namespace steplap::study
