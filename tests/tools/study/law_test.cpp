// Distributions against their closed forms, random numbers against published ones.
#include "tools/study/counter_random.h"
#include "tools/study/law.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::study;

namespace {

Variable variable(const std::string& name, const std::string& distribution) {
  Variable v;
  v.name = name;
  v.distribution = distribution;
  return v;
}

Variable with_moments(const std::string& name, const std::string& distribution, double mean, double deviation) {
  Variable v = variable(name, distribution);
  v.mean = mean;
  v.standard_deviation = deviation;
  return v;
}

JointLaw law_of(const std::vector<Variable>& variables, const std::vector<Correlation>& correlations = {}) {
  Study s;
  s.variables = variables;
  s.correlations = correlations;
  std::vector<Diagnostic> problems;
  JointLaw law(s, std::vector<double>(variables.size(), 0.0), problems);
  for (const Diagnostic& d : problems) FAIL(d.message);
  return law;
}

} // namespace

TEST_CASE("Philox gives the numbers that its authors publish") {
  // Random123, kat_vectors: philox4x32 of 10 rounds
  CHECK(philox({0, 0, 0, 0}, {0, 0}) == PhiloxBlock{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
        PhiloxBlock{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        PhiloxBlock{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("uniform numbers by counter are uniform, and independent of who asks first") {
  const CounterRandom random(7, 1);
  const double later = random.uniform(1000, 3);
  double sum = 0.0, squares = 0.0, product = 0.0;
  constexpr int k_count = 100000;
  for (int i = 0; i < k_count; ++i) {
    const double a = random.uniform(static_cast<std::uint64_t>(i), 0), b = random.uniform(static_cast<std::uint64_t>(i), 1);
    sum += a;
    squares += a * a;
    product += (a - 0.5) * (b - 0.5);
  }
  // Four standard deviations of each mean.
  CHECK(std::abs(sum / k_count - 0.5) < 4.0 * std::sqrt(1.0 / 12.0 / k_count));
  CHECK(std::abs(squares / k_count - 1.0 / 3.0) < 4.0 * std::sqrt(4.0 / 45.0 / k_count));
  CHECK(std::abs(product / k_count) < 4.0 / 12.0 / std::sqrt(double(k_count)));
  CHECK(random.uniform(1000, 3) == later);
  CHECK(CounterRandom(7, 2).uniform(1000, 3) != later);
}

TEST_CASE("quantiles are those of the closed forms, far into both tails") {
  const std::vector<double> probabilities{1e-12, 1e-4, 0.05, 0.5, 0.8, 1.0 - 1e-6};
  const double mean = 0.3, deviation = 0.06;
  const double zeta = std::sqrt(std::log1p(0.04)), lambda = std::log(mean) - 0.5 * zeta * zeta;
  const double gumbel = deviation * std::sqrt(6.0) / std::numbers::pi, mode = mean - std::numbers::egamma * gumbel;
  Variable weibull = variable("w", "weibull");
  weibull.shape = 2.5;
  weibull.scale = 3.0;
  Variable uniform = variable("u", "uniform");
  uniform.low = -1.0;
  uniform.high = 3.0;
  Variable exponential = variable("e", "exponential");
  exponential.mean = 2.0;
  const JointLaw law = law_of({with_moments("a", "normal", mean, deviation), with_moments("b", "lognormal", mean, deviation),
                               with_moments("c", "gumbel", mean, deviation), weibull, uniform, exponential});
  for (const double p : probabilities) {
    CAPTURE(p);
    const double z = normal_quantile(p);
    CHECK(normal_cdf(z) == doctest::Approx(p).epsilon(1e-10));
    CHECK(law.quantile(0, p) == doctest::Approx(mean + deviation * z).epsilon(1e-12));
    CHECK(law.quantile(1, p) == doctest::Approx(std::exp(lambda + zeta * z)).epsilon(1e-12));
    // By p = Φ(Φ⁻¹(p)), which costs digits next to 1.
    CHECK(law.quantile(2, p) == doctest::Approx(mode - gumbel * std::log(-std::log(p))).epsilon(1e-8));
    CHECK(law.quantile(3, p) == doctest::Approx(3.0 * std::pow(-std::log1p(-p), 1.0 / 2.5)).epsilon(1e-8));
    CHECK(law.quantile(4, p) == doctest::Approx(-1.0 + 4.0 * p).epsilon(1e-10));
    CHECK(law.quantile(5, p) == doctest::Approx(-2.0 * std::log1p(-p)).epsilon(1e-8));
  }
}

TEST_CASE("a truncated distribution has the quantiles of what is left") {
  Variable v = with_moments("t", "normal", 1.0, 2.0);
  v.lower = 0.0;
  v.upper = 4.0;
  const JointLaw law = law_of({v});
  const double low = normal_cdf(-0.5), high = normal_cdf(1.5);
  for (const double p : {0.001, 0.3, 0.9})
    CHECK(law.quantile(0, p) == doctest::Approx(1.0 + 2.0 * normal_quantile(low + p * (high - low))).epsilon(1e-9));
}

TEST_CASE("a correlation of lognormal values becomes that of their logarithms") {
  // ρ₀ = ln(1 + ρ c₁ c₂)/(ζ₁ ζ₂), exactly.
  Correlation c;
  c.between = {"a", "b"};
  c.rho = 0.5;
  const JointLaw law = law_of({with_moments("a", "lognormal", 1.0, 0.3), with_moments("b", "lognormal", 2.0, 1.2)}, {c});
  const double zeta1 = std::sqrt(std::log1p(0.09)), zeta2 = std::sqrt(std::log1p(0.36)),
               rho0 = std::log1p(0.5 * 0.3 * 0.6) / (zeta1 * zeta2);
  const double u[2] = {1.3, -0.4};
  double x[2];
  law.values_at(u, x);
  CHECK(std::log(x[1]) ==
        doctest::Approx(std::log(2.0) - 0.5 * zeta2 * zeta2 + zeta2 * (rho0 * u[0] + std::sqrt(1.0 - rho0 * rho0) * u[1])).epsilon(1e-9));
}

TEST_CASE("intervals of proportions are those of Clopper and Pearson") {
  // None of ten: the upper bound is 1 − 0.025^(1/10), exactly; all of ten by symmetry.
  CHECK(proportion_interval(0, 10, 0.95).low == 0.0);
  CHECK(proportion_interval(0, 10, 0.95).high == doctest::Approx(1.0 - std::pow(0.025, 0.1)).epsilon(1e-12));
  CHECK(proportion_interval(10, 10, 0.95).low == doctest::Approx(std::pow(0.025, 0.1)).epsilon(1e-12));
  // One of two: p² = 0.975 and (1 − p)² = 0.975
  CHECK(proportion_interval(1, 2, 0.95).low == doctest::Approx(1.0 - std::sqrt(0.975)).epsilon(1e-12));
  CHECK(proportion_interval(1, 2, 0.95).high == doctest::Approx(std::sqrt(0.975)).epsilon(1e-12));
}
