// Distributions fitted to measured values. The values are the quantiles of a known distribution at even probabilities,
// so that what is found differs from it by what a thousand values are too coarse for, and not by chance.
#include "tests/tools/study/study_bench.h"
#include "tools/study/law.h"

#include <numbers>

using namespace steplap;
using namespace steplap::testing;
using study::normal_cdf;
using study::normal_quantile;

namespace {

struct Whole {
  const char* kind;
  double (*quantile)(double p);
  double (*cdf)(double x);
};

const Whole k_wholes[] = {
    {"normal", [](double p) { return 0.25 + 0.1 * normal_quantile(p); }, [](double x) { return normal_cdf((x - 0.25) / 0.1); }},
    {"lognormal", [](double p) { return 0.25 * std::exp(0.4 * normal_quantile(p)); },
     [](double x) { return normal_cdf(std::log(x / 0.25) / 0.4); }},
    {"gumbel", [](double p) { return 0.25 - 0.1 * std::log(-std::log(p)); },
     [](double x) { return std::exp(-std::exp((0.25 - x) / 0.1)); }},
    {"weibull", [](double p) { return 0.3 * std::pow(-std::log1p(-p), 1.0 / 2.0); },
     [](double x) { return -std::expm1(-std::pow(x / 0.3, 2.0)); }},
    {"exponential", [](double p) { return -0.2 * std::log1p(-p); }, [](double x) { return -std::expm1(-x / 0.2); }}};

std::string table_of(const std::vector<double>& values) {
  std::ostringstream text;
  text.precision(17);
  text << "mu\n";
  for (const double x : values) text << x << "\n";
  return text.str();
}

// Of what lies between the bounds.
std::vector<double> measured(const Whole& whole, double low, double high, int count) {
  const double from = std::isinf(low) ? 0.0 : whole.cdf(low), to = std::isinf(high) ? 1.0 : whole.cdf(high);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(whole.quantile(from + (to - from) * (i + 0.5) / count));
  return values;
}

study::Variable variable(const StudyBench& bench, const char* kind, const std::vector<double>& values) {
  study::Variable v;
  v.name = "mu";
  v.distribution = kind;
  v.measured = bench.write("mu.csv", table_of(values));
  v.column = "mu";
  return v;
}

study::JointLaw law_of(const study::Variable& v) {
  study::Study s;
  s.variables = {v};
  std::vector<Diagnostic> problems;
  study::JointLaw law(s, {0.0}, problems);
  for (const Diagnostic& d : problems) FAIL(d.message);
  return law;
}

std::string sample_study(const std::string& variable) {
  return "kind = \"sample\"\n[sample]\nsamples = 50\n[[variable]]\nname = \"mu\"\nmeasured = \"mu.csv\"\n" + variable +
         "[[response]]\nname = \"m\"\nexpression = \"mu\"\n";
}

constexpr double k_infinity = std::numeric_limits<double>::infinity();

} // namespace

// A part of a distribution that is fitted as if it were the whole, and then cut off once more, has a tenth of its
// values below 0.2 where the measured ones have 18 %. Quantiles are held to 1 %: a thousand values give them to 0.3 %.
TEST_CASE("what was measured between bounds is fitted as what is left of a whole") {
  for (const Whole& whole : k_wholes)
    for (const auto& [low, high] : {std::pair{0.15, k_infinity}, std::pair{-k_infinity, 0.4}, std::pair{0.15, 0.45}}) {
      CAPTURE(std::string(whole.kind));
      CAPTURE(low);
      CAPTURE(high);
      StudyBench bench;
      study::Variable v = variable(bench, whole.kind, measured(whole, low, high, 1000));
      if (std::isfinite(low)) v.lower = low;
      if (std::isfinite(high)) v.upper = high;
      const study::JointLaw law = law_of(v);
      const double from = std::isinf(low) ? 0.0 : whole.cdf(low), to = std::isinf(high) ? 1.0 : whole.cdf(high);
      for (const double p : {0.1, 0.3, 0.5, 0.7, 0.9})
        CHECK(law.quantile(0, p) == doctest::Approx(whole.quantile(from + p * (to - from))).epsilon(0.01));
      REQUIRE(law.fits().size() == 1);
      CHECK_FALSE(law.fits()[0].is_misfit);
    }
}

// The likeliest whole of an exponential tail is a normal one without end: mean and deviation run away together. It is
// stopped where a millionth is left, where the tail is an exponential one to some per cent.
TEST_CASE("a tail that says nothing of its whole is fitted as a tail") {
  StudyBench bench;
  std::vector<double> values = measured(k_wholes[4], -k_infinity, k_infinity, 300);
  for (double& x : values) x += 0.15;
  study::Variable v = variable(bench, "normal", values);
  v.lower = 0.15;
  const study::JointLaw law = law_of(v);
  for (const double p : {0.1, 0.5, 0.9}) CHECK(law.quantile(0, p) == doctest::Approx(0.15 - 0.2 * std::log1p(-p)).epsilon(0.03));
  CHECK_FALSE(law.fits()[0].is_misfit);
}

TEST_CASE("bounds beyond which values were measured cut off what all of them say") {
  StudyBench bench;
  study::Variable v = variable(bench, "normal", measured(k_wholes[0], -k_infinity, k_infinity, 1000));
  v.lower = 0.15;
  const study::JointLaw law = law_of(v);
  const double from = normal_cdf(-1.0);
  for (const double p : {0.1, 0.5, 0.9})
    CHECK(law.quantile(0, p) == doctest::Approx(0.25 + 0.1 * normal_quantile(from + p * (1.0 - from))).epsilon(0.01));
  CHECK(has(law.text(0), "159 of the values lie outside the bounds")); // Φ(−1) of a thousand
}

TEST_CASE("a fit is told with what it is worth, and one that its values contradict is not to be trusted") {
  StudyBench bench;
  bench.write("mu.csv", table_of(measured(k_wholes[0], -k_infinity, k_infinity, 300)));
  const Outcome good = bench.run(sample_study("distribution = \"normal\"\n"));
  CAPTURE(good.err);
  CHECK(good.code == 0);
  CHECK(has(good.out, "Variable 'mu': normal, mean 0.25"));
  CHECK(has(good.out, "fitted to 300 values (Kolmogorov's p 1)"));

  std::vector<double> two_heaps = measured(k_wholes[0], -k_infinity, k_infinity, 150);
  for (int i = 0; i < 150; ++i) two_heaps.push_back(two_heaps[static_cast<std::size_t>(i)] + 2.0);
  bench.write("mu.csv", table_of(two_heaps));
  const Outcome bad = bench.run(sample_study("distribution = \"normal\"\n"), {"--restart"});
  CHECK(bad.code == 4);
  CHECK(has(bad.out, "it does not fit"));
  CHECK(has(bad.out, "not to be trusted"));
}

TEST_CASE("what cannot be fitted between bounds is refused") {
  StudyBench bench;
  bench.write("mu.csv", table_of(measured(k_wholes[0], -k_infinity, k_infinity, 300))); // some are below zero
  const Outcome ends = bench.run(sample_study("distribution = \"uniform\"\nlower = -1\n"));
  CHECK(ends.code == 3);
  CHECK(has(ends.err, "has its own ends"));
  const Outcome positive = bench.run(sample_study("distribution = \"lognormal\"\nlower = -1\n"));
  CHECK(positive.code == 3);
  CHECK(has(positive.err, "values above zero only"));
  bench.write("mu.csv", table_of(std::vector<double>(20, 0.3)));
  const Outcome same = bench.run(sample_study("distribution = \"normal\"\nlower = 0\n"));
  CHECK(same.code == 3);
  CHECK(has(same.err, "are the same"));
}

// A law with a fitted location would begin at the smallest of ten values: no probability below it, and a tail that is far too heavy above.
TEST_CASE("few values are fitted by a law that begins at zero") {
  StudyBench bench;
  std::vector<double> values;
  for (int i = 0; i < 10; ++i) values.push_back(0.24 + 0.12 * i / 9.0);
  double mean = 0.0, squares = 0.0;
  for (const double x : values) mean += std::log(x) / 10.0;
  for (const double x : values) squares += std::pow(std::log(x) - mean, 2) / 9.0;
  const study::JointLaw lognormal = law_of(variable(bench, "lognormal", values));
  for (const double z : {-2.326348, 0.0, 2.326348}) // of 1 %, 50 % and 99 %
    CHECK(lognormal.quantile(0, z < 0.0   ? 0.01
                                : z > 0.0 ? 0.99
                                          : 0.5) == doctest::Approx(std::exp(mean + z * std::sqrt(squares))).epsilon(1e-6));
  const study::JointLaw weibull = law_of(variable(bench, "weibull", values));
  CHECK(weibull.quantile(0, 0.01) < 0.24); // 1 % lies below the smallest of ten, which is no end
  CHECK(weibull.quantile(0, 0.01) > 0.12);
  CHECK(weibull.quantile(0, 0.999) < 0.45);
}
