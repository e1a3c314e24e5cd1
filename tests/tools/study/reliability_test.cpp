// Limit states without dynamics whose probability is known exactly: closed forms, or quadrature in double precision.
#include "tests/tools/study/known_cases.h"
#include "tests/tools/study/study_bench.h"
#include "tools/study/law.h"
#include "tools/study/surrogate.h"

#include <Eigen/LU>

#include <cstdlib>
#include <map>

using namespace steplap;
using namespace steplap::testing;

namespace {

double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::acos(-1.0)); }

} // namespace

// Intervals of 99.9 %: of the thirty of them one misses in one of thirty seeds; the seed is fixed.
TEST_CASE("sampling: the interval covers the exact probability") {
  for (const KnownCase& c : known_cases()) {
    StudyBench bench;
    const Outcome outcome = bench.run(text_of_case(c, c.methods, "cov = 0.1\nsamples = 40000\nconfidence = 0.999\n"));
    CAPTURE(std::string(c.name));
    CAPTURE(outcome.err);
    REQUIRE((outcome.code == 0 || outcome.code == 5));
    for (const std::string& method : c.methods) {
      const study::Finding f = bench.find(method, "probability");
      CAPTURE(method);
      CHECK(f.low <= c.probability);
      CHECK(f.high >= c.probability);
      const double most = method == "subset" ? 20.0 : 5.0; // and says something: of four repetitions little is known at 99.9 %
      CHECK(f.low > c.probability / most);
      CHECK(f.high < most * c.probability);
    }
  }
}

TEST_CASE("FORM finds the nearest design point") {
  for (const KnownCase& c : known_cases()) {
    if (c.form_beta == 0.0) continue;
    StudyBench bench;
    (void)bench.run(text_of_case(c, {"form"}, ""));
    CAPTURE(std::string(c.name));
    // Asked for in studies.md: 1e-4.
    CHECK(bench.find("form", "beta", "g").value == doctest::Approx(c.form_beta).epsilon(1e-4));
  }
}

TEST_CASE("FORM and SORM of three correlated variables are those that pystra's tests give") {
  // 3.7347; Breitung 3.8537: to the digits published.
  StudyBench bench;
  const KnownCase c{"3RV",
                    {"distribution = \"lognormal\"\nmean = 500\nstandard_deviation = 100\n", normal(2000, 400),
                     "distribution = \"uniform\"\nmean = 5\nstandard_deviation = 0.5\n"},
                    "1.7 - x2/(1000*x3) - (x1/(200*x3))^2",
                    0.0,
                    0.0,
                    {}};
  std::string text = text_of_case(c, {"form", "sorm"}, "");
  for (const auto& [pair, rho] : std::map<std::string, double>{{"\"x1\", \"x2\"", 0.3}, {"\"x1\", \"x3\"", 0.2}, {"\"x2\", \"x3\"", 0.2}})
    text += "[[correlation]]\nbetween = [" + pair + "]\nrho = " + std::to_string(rho) + "\n";
  const Outcome outcome = bench.run(text);
  CAPTURE(outcome.err);
  CHECK(std::abs(bench.find("form", "beta", "g").value - 3.7347) < 1e-4);
  CHECK(std::abs(bench.find("sorm", "beta (Breitung)").value - 3.8537) < 4e-4);
}

TEST_CASE("slopes of the index are those of the closed form") {
  // g = R − S with normal variables: β = (m_R − m_S)/s with s² = s_R² + s_S².
  const double mr = 10.0, sr = 2.0, ms = 5.0, ss = 1.0, s = std::hypot(sr, ss), beta = (mr - ms) / s;
  StudyBench bench;
  (void)bench.run(text_of_case({"", {normal(mr, sr), normal(ms, ss)}, "x1 - x2", 0.0, 0.0, {}}, {"form"}, ""));
  const auto value = [&](const std::string& quantity) { return bench.find("form", quantity, "design point 1").value; };
  const auto close = [](double x) { return doctest::Approx(x).epsilon(1e-5); }; // the design point is known to 1e-6
  CHECK(value("beta by mean of x1") == close(1.0 / s));
  CHECK(value("beta by mean of x2") == close(-1.0 / s));
  CHECK(value("beta by standard deviation of x1") == close(-sr * beta / (s * s)));
  CHECK(value("beta by standard deviation of x2") == close(-ss * beta / (s * s)));
  CHECK(value("probability with half the scatter of x1") == close(study::normal_cdf(-(mr - ms) / std::hypot(0.5 * sr, ss))));
  CHECK(value("omission factor of x2") == close(s / sr));
  CHECK(value("signed importance of x1") == close(sr * sr / (s * s))); // more resistance is safer
  CHECK(value("signed importance of x2") == close(-ss * ss / (s * s)));
  const double density = normal_density(beta), p = study::normal_cdf(-beta);
  CHECK(value("elasticity of the probability by mean of x1") == close(-density / p * mr / s)); // (m/P) dP/dm with dP = −φ(β) dβ
  CHECK(value("elasticity of the probability by mean of x2") == close(density / p * ms / s));
}

namespace {

/// How many intervals hold the exact value, of those that were given.
struct Covered {
  long held = 0, given = 0;
  void add(const study::Finding& f, double exact) {
    if (std::isnan(f.value)) return;
    ++given;
    held += f.low <= exact && exact <= f.high;
  }
};

} // namespace

// g = R − S with R ~ N(10, 2), S ~ N(5, 1) and the correlation rho: the margin is normal with s² = s_R² + s_S² − 2 rho s_R s_S, and
// E[R given failure] = m_R − cov(R, R − S)/s φ(β)/Φ(−β).
TEST_CASE("intervals of what another distribution would change hold the values of the closed form") {
  const std::pair<std::string, double> all[] = {{"importance_sampling", 0.0}, {"importance_sampling", 0.5}, {"monte_carlo", 0.0}};
  for (const auto& [method, rho] : all) {
    const double cross = 2.0 * rho;
    const auto index = [rho = rho](double mr, double ms, double sr, double ss) {
      return (mr - ms) / std::sqrt(sr * sr + ss * ss - 2.0 * rho * sr * ss);
    };
    const auto p = [&](double mr, double ms, double sr, double ss) { return study::normal_cdf(-index(mr, ms, sr, ss)); };
    const double beta = index(10.0, 5.0, 2.0, 1.0), tail = normal_density(beta) / study::normal_cdf(-beta), s = 5.0 / beta;
    Covered covered;
    for (int seed = 1; seed <= 10; ++seed) {
      StudyBench bench;
      std::string text = "seed = " + std::to_string(seed) + "\n" +
                         text_of_case({"", {normal(10, 2), normal(5, 1)}, "x1 - x2", 0.0, 0.0, {}}, {method}, "cov = 0.05\n");
      if (rho != 0.0) text += "[[correlation]]\nbetween = [\"x1\", \"x2\"]\nrho = 0.5\n";
      const Outcome outcome = bench.run(text);
      CAPTURE(outcome.err);
      REQUIRE(outcome.code == 0);
      const auto found = [&](const std::string& quantity) { return bench.find(method, "probability with " + quantity); };
      covered.add(found("half the scatter of x1"), p(10.0, 5.0, 1.0, 1.0));
      covered.add(found("half the scatter of x2"), p(10.0, 5.0, 2.0, 0.5));
      covered.add(found("a mean 10 % larger of x1"), p(11.0, 5.0, 2.0, 1.0));
      covered.add(found("a mean 10 % smaller of x1"), p(9.0, 5.0, 2.0, 1.0));
      covered.add(found("a mean 10 % larger of x2"), p(10.0, 5.5, 2.0, 1.0));
      covered.add(bench.find(method, "mean given failure", "x1"), 10.0 - (4.0 - cross) / s * tail);
      covered.add(bench.find(method, "mean given failure", "x2"), 5.0 + (1.0 - cross) / s * tail);
    }
    CAPTURE(method);
    CAPTURE(rho);
    CAPTURE(covered.held);
    CAPTURE(covered.given);
    CHECK(covered.given >= 50); // of 70: where too few failures carry a value there is none
    // The seven values of a seed share their failures. If they all missed together, the share of ten seeds would scatter by 0.07 about
    // 0.95: 1.5 times that is allowed.
    CHECK(static_cast<double>(covered.held) >= 0.85 * static_cast<double>(covered.given));
  }
}

TEST_CASE("the parameter that matters most is named with what would change") {
  StudyBench bench;
  // R has four fifths of the variance. With half its scatter s² is 2: P = 0.000203; with a mean of 11 it is 0.00365.
  const Outcome outcome =
      bench.run(text_of_case({"", {normal(10, 2), normal(5, 1)}, "x1 - x2", 0.0, 0.0, {}}, {"importance_sampling"}, "cov = 0.02\n"));
  CHECK(has(outcome.out, "'x1' matters most: half its scatter would change the probability from 0.012"));
  CHECK(has(outcome.out, ", a mean 10 % larger to 0.003"));
}

// R has a share of 1/1.01 of the variance and P is 6e-7: with half its scatter failures are so far from the samples that they say nothing of
// R, but much of S. S must not be named for that.
TEST_CASE("a parameter that the samples do not tell of may matter most") {
  StudyBench bench;
  const Outcome outcome = bench.run(
      text_of_case({"", {normal(10, 1), normal(5.1, 0.1)}, "x1 - x2", 0.0, 0.0, {}}, {"form", "importance_sampling"}, "cov = 0.1\n"));
  CHECK(std::isnan(bench.find("importance_sampling", "probability with half the scatter of x1").value));
  CHECK(bench.find("importance_sampling", "probability with half the scatter of x2").value > 0.0);
  CHECK(has(outcome.out, "'x1' matters most, to first order"));
}

// Uniform over 0 to 1, failure above 0.9. Moved by 0.05 a twentieth of the values lies beyond 1, where no sample is. With half the scatter
// the values end at 0.75: no sample that fails has any weight.
TEST_CASE("what the samples cannot know of another distribution is not given") {
  StudyBench bench;
  const Outcome outcome = bench.run(
      text_of_case({"", {"distribution = \"uniform\"\nlow = 0\nhigh = 1\n"}, "0.9 - x1", 0.0, 0.0, {}}, {"monte_carlo"}, "cov = 0.02\n"));
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  const study::Finding larger = bench.find("monte_carlo", "probability with a mean 10 % larger of x1"),
                       halved = bench.find("monte_carlo", "probability with half the scatter of x1"),
                       smaller = bench.find("monte_carlo", "probability with a mean 10 % smaller of x1");
  CHECK(std::isnan(larger.value));
  CHECK(has(larger.status, "takes values that the present one does not take"));
  CHECK(std::isnan(halved.value));
  CHECK(has(halved.status, "0 effective failures carry it, too few"));
  CHECK(std::isnan(smaller.value)); // a twentieth lies below zero: those hold, but nobody has looked
}

// An exponential load with mean 1 that exceeds 5: the tail has no memory, so its mean is 6. With half the scatter the values are 0.5 plus an
// exponential variable with mean 0.5: P = exp(−(5 − 0.5)/0.5).
TEST_CASE("the mean of an exponential variable in failures is that of a tail without memory") {
  StudyBench bench;
  const Outcome outcome = bench.run(text_of_case({"", {"distribution = \"exponential\"\nmean = 1\n"}, "5 - x1", 0.0, 0.0, {}},
                                                 {"importance_sampling"}, "cov = 0.02\nconfidence = 0.999\n"));
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  const study::Finding mean = bench.find("importance_sampling", "mean given failure", "x1");
  CHECK(mean.low <= 6.0); // an interval of 99.9 %; the seed is fixed
  CHECK(mean.high >= 6.0);
  CHECK(mean.high - mean.low < 0.5);
  const study::Finding halved = bench.find("importance_sampling", "probability with half the scatter of x1");
  CHECK(halved.low <= std::exp(-9.0));
  CHECK(halved.high >= std::exp(-9.0));
}

TEST_CASE("samples without a result widen what another distribution would change") {
  const auto halved = [](const std::string& failed) {
    StudyBench bench;
    (void)bench.run("failed = \"" + failed + "\"\n" +
                    text_of_case({"", {normal(10, 2), normal(5, 1)}, "x1 - x2 < -0.5 ? sqrt(-1) : x1 - x2", 0.0, 0.0, {}}, {"monte_carlo"},
                                 "cov = 0.02\n"));
    return bench.find("monte_carlo", "probability with a mean 10 % smaller of x1");
  };
  const study::Finding safe = halved("safe"), unsafe = halved("unsafe"), bounds = halved("bounds");
  CHECK(safe.high < unsafe.low);
  CHECK(bounds.low == safe.low);
  CHECK(bounds.high == unsafe.high);
}

namespace {

KnownCase four_branches() {
  const std::vector<KnownCase> all = known_cases();
  return *std::find_if(all.begin(), all.end(), [](const KnownCase& c) { return std::string(c.name) == "four branches"; });
}

} // namespace

// Intervals of 95 %: nine of ten seeds, and four of five, which the five fixed ones do.
// With the correlations R of the known points with each other and k of a place with them, the predictor has the mean m + kᵀR⁻¹(y − m) and the
// variance σ² (1 − kᵀR⁻¹k + (1 − 1ᵀR⁻¹k)²/(1ᵀR⁻¹1)), m = 1ᵀR⁻¹y/(1ᵀR⁻¹1); far away m and σ² (1 + 1/(1ᵀR⁻¹1)).
TEST_CASE("a surrogate is the best linear unbiased predictor, also at many places at once") {
  const std::vector<double> known{-2.0, -1.0, -1.0, 1.5, 0.0, 0.0, 1.0, -2.0, 2.0, 1.0, -0.5, 2.5}; // six points of two coordinates
  std::vector<double> values;
  for (std::size_t i = 0; i < known.size(); i += 2) values.push_back(std::sin(2.0 * known[i]) + known[i + 1] * known[i + 1]);
  study::Surrogate surrogate(2);
  surrogate.fit(known, values);
  const auto n = static_cast<Eigen::Index>(values.size());
  const auto correlations_of = [&](const double* place) {
    Eigen::VectorXd k(n);
    for (Eigen::Index i = 0; i < n; ++i) k[i] = surrogate.correlation(place, &known[static_cast<std::size_t>(2 * i)]);
    return k;
  };
  Eigen::MatrixXd r(n, n);
  for (Eigen::Index i = 0; i < n; ++i) r.col(i) = correlations_of(&known[static_cast<std::size_t>(2 * i)]);
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(r);
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(values.data(), n), ones = Eigen::VectorXd::Ones(n), by_ones = lu.solve(ones);
  const double sum = ones.dot(by_ones), m = by_ones.dot(y) / sum;
  const study::Prediction far = surrogate.at({1e6, -1e6}).front();
  const double sigma2 = far.deviation * far.deviation / (1.0 + 1.0 / sum);
  REQUIRE(far.deviation > 0.0);
  CHECK(far.mean == doctest::Approx(m).epsilon(1e-9));
  std::vector<double> places;
  for (int i = -300; i <= 300; ++i) places.insert(places.end(), {0.01 * i, 1.0 - 0.007 * i}); // more than are predicted together
  const std::vector<study::Prediction> predicted = surrogate.at(places);
  REQUIRE(predicted.size() == places.size() / 2);
  // The noise of 1e-12 that OpenTURNS adds to the diagonal of R counts by the norm of R⁻¹.
  const double noise = 1e-11 * lu.inverse().norm();
  REQUIRE(noise < 1e-6);
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const Eigen::VectorXd k = correlations_of(&places[2 * i]), by_k = lu.solve(k);
    CHECK(std::abs(predicted[i].mean - (m + by_k.dot(y - m * ones))) <= noise * y.norm());
    const double variance = sigma2 * (1.0 - k.dot(by_k) + std::pow(1.0 - ones.dot(by_k), 2) / sum);
    CHECK(std::abs(predicted[i].deviation * predicted[i].deviation - variance) <= noise * sigma2);
    CHECK(predicted[i].mean == doctest::Approx(surrogate.at({places[2 * i], places[2 * i + 1]}).front().mean).epsilon(1e-12));
  }
}

TEST_CASE("kriging knows wavy and branched limit states within 150 runs") {
  const char* const wanted = std::getenv("STEPLAP_KRIGING_SEEDS"); // more than a test has time for
  const long seeds = wanted ? std::atol(wanted) : 5;
  const KnownCase rp53{"RP53", {normal(1.5, 1), normal(2.5, 1)}, "sin(5*x1/2) + 2 - (x1^2 + 4)*(x2 - 1)/20", 3.13205e-2, 0.0, {}};
  for (const KnownCase& c : {four_branches(), rp53}) {
    CAPTURE(std::string(c.name));
    long held = 0;
    for (long seed = 1; seed <= seeds; ++seed) {
      CAPTURE(seed);
      StudyBench bench;
      const Outcome outcome = bench.run(
          "seed = " + std::to_string(seed) + "\n" + text_of_case(c, {"kriging"}, "cov = 0.1\nsamples = 150\n"), {"--threads", "1"});
      CAPTURE(outcome.err);
      REQUIRE(outcome.code == 0);
      const study::Finding p = bench.find("kriging", "probability");
      CHECK(p.samples <= 150);
      CHECK(p.high - p.low < 0.5 * c.probability); // cov 0.1: 95 % are 0.4 wide
      CHECK(bench.find("kriging", "with doubtful samples as safe").value <= p.value);
      CHECK(bench.find("kriging", "with doubtful samples as failures").value >= p.value);
      held += p.low <= c.probability && c.probability <= p.high;
    }
    CAPTURE(held);
    CHECK(10 * held >= 9 * seeds - 5);
  }
}

// A formula takes microseconds, a surrogate a second.
TEST_CASE("where runs cost little, sampling without a surrogate is advised") {
  StudyBench bench;
  CHECK(has(bench.run(text_of_case(four_branches(), {"kriging"}, "cov = 0.1\n")).out,
            "Runs cost little here: \"importance_sampling\" is the better method."));
}

TEST_CASE("a surrogate that cannot know is not believed") {
  StudyBench bench;
  const auto found = [&](const char* g, const std::string& settings, int code, const std::string& quantity = "probability") {
    const Outcome outcome = bench.run(text_of_case({"", {normal(0, 1), normal(0, 1)}, g, 0.0, 0.0, {}}, {"kriging"}, settings));
    CAPTURE(outcome.err);
    CHECK(outcome.code == code);
    return bench.find("kriging", quantity);
  };
  SUBCASE("a run without a result says nothing of its neighbours") {
    const study::Finding p = found("x1 < -1 ? sqrt(-1) : 2 - x1", "", 4, "probability, runs without result as safe");
    CHECK(has(p.status, "a run gave no result"));
    CHECK(std::isnan(p.value));
  }
  SUBCASE("too few runs leave doubts, which widen the interval") {
    const study::Finding p = found("2.5 - x1 - sin(4*x2)", "samples = 14\n", 5);
    CHECK(has(p.status, "all runs used: the surrogate is in doubt about"));
    CHECK(bench.find("kriging", "with doubtful samples as safe").value < p.value);
    const double most = bench.find("kriging", "with doubtful samples as failures").value;
    CHECK(most > p.value);
    CHECK(p.high > most); // by the scatter of the population
  }
  SUBCASE("of failures that are rarer than the population is large only a bound is known") {
    const study::Finding p = found("8 - x1", "", 5); // P = 6e-16
    CHECK(p.value == 0.0);
    CHECK(p.high < 1e-5); // Clopper and Pearson of none among 1e6: 3.7e-6
    CHECK(has(p.status, "only a bound is known"));
  }
}

TEST_CASE("slopes of the index by correlated and by lognormal variables are those of a second study") {
  // By differences of studies whose distributions were moved; their own error is the square of the step, 1e-4.
  const auto text = [](double mean, double location, double rho) {
    std::string all = text_of_case({"",
                                    {"distribution = \"lognormal\"\nmean = " + std::to_string(mean) +
                                         "\nstandard_deviation = 0.3\nlocation = " + std::to_string(location) + "\n",
                                     normal(1.0, 0.25)},
                                    "x1 - x2",
                                    0.0,
                                    0.0,
                                    {}},
                                   {"form"}, "");
    return all + "[[correlation]]\nbetween = [\"x1\", \"x2\"]\nrho = " + std::to_string(rho) + "\n";
  };
  for (const double rho : {0.0001, 0.4, -0.5}) {
    CAPTURE(rho);
    const auto beta = [&](double by) {
      StudyBench bench;
      (void)bench.run(text(2.0 + by, by, rho)); // moved as a whole
      return bench.find("form", "beta", "g").value;
    };
    StudyBench bench;
    (void)bench.run(text(2.0, 0.0, rho));
    CHECK(bench.find("form", "beta by mean of x1", "design point 1").value ==
          doctest::Approx((beta(0.01) - beta(-0.01)) / 0.02).epsilon(1e-3));
  }
}

TEST_CASE("traps of FORM are told") {
  const std::vector<KnownCase> all = known_cases();
  const auto called = [&](const std::string& name) {
    return *std::find_if(all.begin(), all.end(), [&](const KnownCase& c) { return c.name == name; });
  };
  SUBCASE("two design points of one distance: each is reported, and first order is off") {
    StudyBench bench;
    (void)bench.run(text_of_case(called("four branches"), {"form"}, "confidence = 0.99\n"));
    CHECK(bench.find("form", "beta", "design point 1").value == doctest::Approx(3.0).epsilon(1e-4));
    CHECK(bench.find("form", "beta", "design point 2").value == doctest::Approx(3.0).epsilon(1e-4));
    CHECK(has(bench.find("form", "probability").status, "off: importance_sampling"));
  }
  SUBCASE("a curved surface in twenty dimensions: first order is off by a factor of fifty") {
    StudyBench bench;
    (void)bench.run(text_of_case(called("RP54"), {"form"}, ""));
    CHECK(bench.find("form", "probability").value > 30.0 * 9.9e-4);
    CHECK(has(bench.find("form", "probability").status, "off"));
  }
  SUBCASE("a limit state that jumps has no point where it is zero") {
    StudyBench bench;
    (void)bench.run(text_of_case(called("RP77"), {"form"}, ""));
    CHECK(has(bench.find("form", "beta", "g").status, "not on the limit state"));
  }
  SUBCASE("started at the wrong branch only, a sample that fails elsewhere leads to the nearer one") {
    StudyBench bench;
    const KnownCase c{"", {normal(0, 1), normal(0, 1)}, "x1 > 1 ? 2.2 - x1 + 0*x2 : 3 + x1", 0.0, 0.0, {}};
    (void)bench.run(text_of_case(c, {"form"}, "starts = 1\n"));
    CHECK(bench.find("form", "beta", "g").value == doctest::Approx(2.2).epsilon(1e-4));
    CHECK(bench.find("form", "beta", "design point 2").value == doctest::Approx(3.0).epsilon(1e-4));
    CHECK(has(bench.find("form", "beta", "design point 2").status, "another design point beats it"));
  }
  SUBCASE("nothing fails") {
    StudyBench bench;
    const Outcome outcome = bench.run(text_of_case({"", {normal(0, 1)}, "1 + x1^2", 0.0, 0.0, {}}, {"monte_carlo"}, "samples = 3000\n"));
    CHECK(outcome.code == 5);
    const study::Finding f = bench.find("monte_carlo", "probability");
    CHECK(has(f.status, "only a bound is known"));
    CHECK(f.high == doctest::Approx(1.0 - std::pow(0.025, 1.0 / 3000.0)).epsilon(1e-9));
  }
}

// |x1 x2| > 12.5 has four design points; searches from two starts find one of them. Sampling around that one alone gave
// three quarters of the probability or less, with an interval that did not reach the exact one.
TEST_CASE("sampling finds the design points that searches have missed") {
  for (const int seed : {1, 2, 3}) {
    StudyBench bench;
    KnownCase c{"RP111", {normal(0, 1), normal(0, 1)}, "12.5 - abs(x1*x2)", 8.035e-7, 5.0, {}};
    (void)bench.run("seed = " + std::to_string(seed) + "\n" +
                    text_of_case(c, {"form", "importance_sampling"}, "starts = 2\nconfidence = 0.99\n"));
    const study::Finding f = bench.find("importance_sampling", "probability");
    CAPTURE(seed);
    CHECK(f.low <= c.probability);
    CHECK(f.high >= c.probability);
    CHECK(f.high - f.low < 0.4 * c.probability);
    for (int k = 1; k <= 4; ++k)
      CHECK(bench.find("form", "beta", "design point " + std::to_string(k)).value == doctest::Approx(5.0).epsilon(1e-4));
  }
}

namespace {

// Standard normal variables; what follows [reliability] in `settings`.
std::string standard_study(int variables, const std::string& g, const std::string& settings) {
  const KnownCase c{"", std::vector<std::string>(static_cast<std::size_t>(variables), normal(0, 1)), g.c_str(), 0.0, 0.0, {}};
  std::string text = "kind = \"reliability\"\n[reliability]\n" + settings;
  return text + text_of_case(c, {}, "").substr(text_of_case(c, {}, "").find("[[variable]]"));
}

bool holds(const study::Finding& f, double exact) { return f.low <= exact && exact <= f.high; }

} // namespace

// Each of m independent variables fails alone: 1 − Φ(β)^m. The sampling density needs m design points, of which eight starts find about half.
// Without the others the estimate is as far off, with an interval as narrow as of the whole.
TEST_CASE("importance sampling knows all of many limit states, or says that it may not") {
  const auto series = [](int m, double beta) {
    std::string g = "min(" + std::to_string(beta) + " - x1";
    for (int i = 2; i <= m; ++i) g += ", " + std::to_string(beta) + " - x" + std::to_string(i);
    return g + ")";
  };
  for (const int m : {6, 15, 24})
    for (const double beta : {3.5, 4.5})
      for (int seed = 1; seed <= 3; ++seed) {
        CAPTURE(m);
        CAPTURE(beta);
        CAPTURE(seed);
        StudyBench bench;
        const std::string settings = "methods = [\"importance_sampling\"]\ncov = 0.1\nconfidence = 0.999\n";
        const Outcome outcome =
            bench.run("seed = " + std::to_string(seed) + "\n" + standard_study(m, series(m, beta), settings), {"--threads", "1"});
        CAPTURE(outcome.out);
        CHECK(outcome.code == 0);
        // Intervals of 99.9 %: of the eighteen one misses in one of fifty choices of seeds.
        CHECK(holds(bench.find("importance_sampling", "probability"), -std::expm1(m * std::log(study::normal_cdf(beta)))));
      }
  // Too few samples for the searches: what is not known is said, and crude Monte Carlo knows it.
  const auto limited = [&](const std::string& methods) {
    StudyBench bench;
    return bench.run(standard_study(15, series(15, 3.5), "methods = [" + methods + "]\nsearch_samples = 400\ncov = 0.1\n"),
                     {"--threads", "1"});
  };
  const Outcome open = limited("\"importance_sampling\""), crude = limited("\"importance_sampling\", \"monte_carlo\"");
  CHECK(open.code == 4);
  CHECK(has(open.out, "a region of failure may be missing. Give more 'search_samples', or add \"monte_carlo\" to the methods"));
  CHECK_FALSE(has(crude.out, "Give more 'search_samples'"));
}

// The surface of sqrt(x1² + x2²) = β is at one distance all around: P = exp(−β²/2), whatever else varies.
TEST_CASE("importance sampling covers a surface at one distance") {
  for (const int others : {0, 3, 8}) {
    StudyBench bench;
    std::string g = "4.4 - sqrt(x1^2 + x2^2)";
    for (int i = 0; i < others; ++i) g += " + 0*x" + std::to_string(3 + i);
    const Outcome outcome = bench.run(standard_study(2 + others, g, "methods = [\"importance_sampling\"]\ncov = 0.1\nconfidence = 0.999\n"),
                                      {"--threads", "1"});
    CAPTURE(others);
    CAPTURE(outcome.out);
    CHECK(outcome.code == 0);
    CHECK(holds(bench.find("importance_sampling", "probability"), std::exp(-0.5 * 4.4 * 4.4)));
  }
}

TEST_CASE("a system of limit states: any of them, and all of them") {
  // Independent normal variables: 1 − Φ(1.5)Φ(2), and Φ(−1.5)Φ(−2)
  const double either = 1.0 - study::normal_cdf(1.5) * study::normal_cdf(2.0), both = study::normal_cdf(-1.5) * study::normal_cdf(-2.0);
  for (const auto& [combination, exact] : std::map<std::string, double>{{"any", either}, {"all", both}}) {
    StudyBench bench;
    std::string text = "kind = \"reliability\"\n[reliability]\nmethods = [\"importance_sampling\", "
                       "\"monte_carlo\"]\nconfidence = 0.999\ncombination = \"" +
                       combination + "\"\n";
    text += "[[variable]]\nname = \"x1\"\n" + normal(0, 1) + "[[variable]]\nname = \"x2\"\n" + normal(0, 1);
    text += "[[limit_state]]\nname = \"first\"\nexpression = \"1.5 - x1\"\n[[limit_state]]\nname = "
            "\"second\"\nexpression = \"2 - x2\"\n";
    const Outcome outcome = bench.run(text);
    CAPTURE(outcome.err);
    CAPTURE(combination);
    for (const char* method : {"importance_sampling", "monte_carlo"}) {
      CHECK(bench.find(method, "probability").low <= exact);
      CHECK(bench.find(method, "probability").high >= exact);
    }
  }
}

// g has no value where x1 > 2: one in 44 samples, which count as both by default.
TEST_CASE("samples without a result are bounded, counted, or end the study, and are never dropped") {
  const auto text = [](const std::string& failed) {
    return "kind = \"reliability\"\nfailed = \"" + failed +
           "\"\n[reliability]\nmethods = [\"monte_carlo\"]\nsamples = 20000\ncov = 0.001\nconfidence = "
           "0.999\n[[variable]]\nname = \"x1\"\n" +
           normal(0, 1) + "[[limit_state]]\nname = \"g\"\nexpression = \"sqrt(2 - x1) - 1\"\n"; // fails for 1 < x1 < 2
  };
  const double least = study::normal_cdf(2.0) - study::normal_cdf(1.0), most = study::normal_cdf(-1.0);
  const auto covers = [](const study::Finding& f, double exact) { return f.low <= exact && exact <= f.high; };
  {
    StudyBench bench;
    const Outcome outcome = bench.run(text("bounds"));
    CHECK(covers(bench.find("monte_carlo", "probability, runs without result as safe"), least));
    CHECK(covers(bench.find("monte_carlo", "probability, runs without result as unsafe"), most));
    CHECK(has(outcome.out, "not a number, first sample"));
    CHECK(has(outcome.out, "limit state 'g' has no value"));
  }
  {
    StudyBench bench;
    (void)bench.run(text("unsafe"));
    CHECK(covers(bench.find("monte_carlo", "probability"), most));
  }
  {
    StudyBench bench;
    (void)bench.run(text("safe"));
    CHECK(covers(bench.find("monte_carlo", "probability"), least));
  }
  {
    StudyBench bench;
    const Outcome outcome = bench.run(text("stop"));
    CHECK(outcome.code == 4);
    CHECK(has(outcome.err, "not a number"));
  }
}

// g has no value where x1 > 1, and nothing else fails: the probability is Φ(−1) = 0.159 if runs without a result count as failures, known to
// 10 % from 530 samples.
TEST_CASE("runs without a result that count as failures are the failures that end the sampling") {
  StudyBench bench;
  const Outcome outcome = bench.run("kind = \"reliability\"\nfailed = \"unsafe\"\n[reliability]\nmethods = [\"monte_carlo\"]\nsamples = "
                                    "5000\ncov = 0.1\nconfidence = 0.999\n[[variable]]\nname = \"x1\"\n" +
                                    normal(0, 1) + "[[limit_state]]\nname = \"g\"\nexpression = \"sqrt(1 - x1)\"\n");
  CHECK_MESSAGE(outcome.code == 0, outcome.err << outcome.out);
  const study::Finding p = bench.find("monte_carlo", "probability");
  CHECK(p.low < study::normal_cdf(-1.0));
  CHECK(p.high > study::normal_cdf(-1.0));
  CHECK(p.samples < 2000);
  CHECK(p.status == "");
}

TEST_CASE("an expression of unknown values has no value, whatever it would choose") {
  // min and comparisons would otherwise take the known one of two values: the least reserve of two cases would be that of the case that ran.
  StudyBench bench;
  (void)bench.run("kind = \"sweep\"\n[[variable]]\nname = \"x\"\nvalues = [4]\n[[response]]\nname = \"none\"\nexpression = \"sqrt(-x)\"\n"
                  "[[response]]\nname = \"least\"\nexpression = \"min(x, none)\"\n[[response]]\nname = \"chosen\"\nexpression = "
                  "\"none > 0 ? 1 : 2\"\n");
  CHECK(has(bench.samples(), ",4,nan,nan,nan"));
}

// Fails for x1 > 3.5, and in a slit of width 0.004 where x1 < 0, with 2.4e-1 · 4e-3 / 2 = 4.8e-4: twice the rest. No search arrives in the slit,
// but samples do.
TEST_CASE("a failure far nearer than the design point caps sampling around it") {
  StudyBench bench;
  const Outcome outcome =
      bench.run(text_of_case({"", {normal(0, 1), normal(0, 1)}, "min(3.5 - x1, max(abs(x2 - 1) - 0.002, x1))", 0.0, 0.0, {}},
                             {"form", "importance_sampling"}, ""));
  CHECK(outcome.code == 4);
  CHECK(has(outcome.out, "a region of failure may be missing"));
}

// Beyond x1 = 2 there is no result; the levels between the origin and that border are still found.
TEST_CASE("subset simulation finds the failures between the origin and runs without a result") {
  const double least = study::normal_cdf(2.0) - study::normal_cdf(1.0), most = study::normal_cdf(-1.0);
  const auto text = [](const std::string& failed) {
    return "kind = \"reliability\"\nfailed = \"" + failed +
           "\"\n[reliability]\nmethods = [\"subset\"]\nsamples = 40000\ncov = 0.02\nconfidence = 0.999\n"
           "[[variable]]\nname = \"x1\"\n" +
           normal(0, 1) + "[[variable]]\nname = \"x2\"\n" + normal(0, 1) +
           "[[limit_state]]\nname = \"g\"\nexpression = \"sqrt(2 - x1) - 1 + 0*x2\"\n"; // fails for 1 < x1 < 2
  };
  const auto check = [](const study::Finding& f, double exact) {
    CAPTURE(f.method);
    CAPTURE(f.quantity);
    CHECK(f.low <= exact);
    CHECK(f.high >= exact);
    CHECK(f.high - f.low < 0.4 * exact); // and says something
  };
  StudyBench both, safe, unsafe;
  (void)both.run(text("bounds"));
  const study::Finding low = both.find("subset", "probability, runs without result as safe"),
                       high = both.find("subset", "probability, runs without result as unsafe");
  check(low, least);
  check(high, most);
  CHECK(low.value < high.value); // of the same samples
  (void)safe.run(text("safe"));
  check(safe.find("subset", "probability"), least);
  (void)unsafe.run(text("unsafe"));
  check(unsafe.find("subset", "probability"), most);
}

// One in series with two in parallel: 1 − (1 − p1)(1 − p2 p3). The nearest failure is where both of the pair fail, a
// corner at which no search by gradients arrives: that it does not is said.
TEST_CASE("a system in series and in parallel") {
  const double p1 = study::normal_cdf(-2.8), p2 = study::normal_cdf(-1.8), p3 = study::normal_cdf(-1.5);
  const double exact = 1.0 - (1.0 - p1) * (1.0 - p2 * p3);
  std::string text = "kind = \"reliability\"\n[reliability]\nmethods = [\"form\", \"importance_sampling\", \"monte_carlo\"]\n"
                     "confidence = 0.999\n";
  for (const char* name : {"x1", "x2", "x3"}) text += "[[variable]]\nname = \"" + std::string(name) + "\"\n" + normal(0, 1);
  text += "[[response]]\nname = \"second\"\nexpression = \"1.8 - x2\"\n[[response]]\nname = \"third\"\nexpression = "
          "\"1.5 - x3\"\n"
          "[[limit_state]]\nname = \"first\"\nexpression = \"2.8 - x1\"\n"
          "[[limit_state]]\nname = \"pair\"\nexpression = \"max(second, third)\"\n";
  StudyBench bench;
  const Outcome outcome = bench.run(text);
  CAPTURE(outcome.err);
  for (const char* method : {"importance_sampling", "monte_carlo"}) {
    CAPTURE(method);
    CHECK(bench.find(method, "probability").low <= exact);
    CHECK(bench.find(method, "probability").high >= exact);
  }
  CHECK(has(bench.find("form", "probability").status, "another design point beats it"));
}

// Of ranks: the normal variables behind them have 2 sin(π ρ/6). ln a − ln b is normal.
TEST_CASE("a copula of ranks: the load beats the resistance") {
  const double za = std::sqrt(std::log1p(0.0625)), zb = std::sqrt(std::log1p(0.16)), rho = 2.0 * std::sin(std::acos(-1.0) * -0.4 / 6.0);
  const double beta = (std::log(3.0) - 0.5 * za * za + 0.5 * zb * zb) / std::sqrt(za * za + zb * zb - 2.0 * rho * za * zb);
  std::string text = "kind = \"reliability\"\n[reliability]\nmethods = [\"form\"]\n";
  text += "[[variable]]\nname = \"a\"\ndistribution = \"lognormal\"\nmean = 3\ncov = 0.25\n";
  text += "[[variable]]\nname = \"b\"\ndistribution = \"lognormal\"\nmean = 1\ncov = 0.4\n";
  text += "[[correlation]]\nbetween = [\"a\", \"b\"]\nrho = -0.4\nof = \"ranks\"\n";
  text += "[[limit_state]]\nname = \"g\"\nexpression = \"ln(a) - ln(b)\"\n";
  StudyBench bench;
  REQUIRE(bench.run(text).code == 0);
  CHECK(bench.find("form", "beta", "g").value == doctest::Approx(beta).epsilon(1e-9)); // a plane: FORM is exact
}

// A limit state that knows few values has no level between: what a tenth of the samples have is what nine tenths have.
TEST_CASE("subset simulation of limit states that know few values") {
  struct Few {
    const char* g;
    double exact;
  };
  const double b = 3.5 / std::sqrt(2.0);
  const Few cases[] = {{"x1 + x2 > 3.5 ? -1 : 1", study::normal_cdf(-b)},
                       {"x1 + x2 > 3.5 ? -1 : x1 + x2 > 1 ? 1 : 2", study::normal_cdf(-b)}, // a third value between
                       {"x1 + x2 > 3.5 ? -1 : max(1, 3 - x1 - x2)", study::normal_cdf(-b)}, // a slope that ends on a plain
                       {"x1 + x2 > 3.5 ? -1 : 0", study::normal_cdf(-b)},                   // zero is not negative
                       {"floor3", 0.0},                                                     // levels one by one, below
                       {"x1 + x2 > 8 ? -1 : 1", study::normal_cdf(-8.0 / std::sqrt(2.0))},  // nothing is met
                       {"x1 + x2 > -3.5 ? -1 : 1", study::normal_cdf(b)}};
  for (const Few& few : cases) {
    const bool is_stairs = std::string(few.g) == "floor3";
    const std::string g = is_stairs ? "4 - rint(x1 + x2) + 0*x1" : few.g;
    const double exact = is_stairs ? study::normal_cdf(-4.5 / std::sqrt(2.0)) : few.exact; // rint beyond 4.5 is 5
    CAPTURE(g);
    int held = 0, honest = 0;
    constexpr int k_seeds = 3;
    for (int seed = 1; seed <= k_seeds; ++seed) {
      StudyBench bench;
      const Outcome outcome = bench.run("seed = " + std::to_string(seed) + "\n" +
                                        standard_study(2, g, "methods = [\"subset\"]\ncov = 0.1\nconfidence = 0.999\n"));
      const study::Finding f = bench.find("subset", "probability");
      held += holds(f, exact);
      honest += outcome.code == 4 || outcome.code == 5 || (f.value > exact / 2.0 && f.value < exact * 2.0);
    }
    CHECK(held == k_seeds);
    CHECK(honest == k_seeds);
  }
}

TEST_CASE("no estimate lies beyond one, and where failing is the rule holding is what is found") {
  for (const double b : {-3.0, -1.88, -1.0, 0.0, 1.0}) {
    const double exact = study::normal_cdf(-b);
    StudyBench bench;
    (void)bench.run(standard_study(2, std::to_string(b) + " - (x1 - x2)/sqrt(2)",
                                   "methods = [\"monte_carlo\", \"importance_sampling\", \"subset\"]\nconfidence = 0.999\n"));
    for (const char* method : {"monte_carlo", "importance_sampling", "subset"}) {
      const study::Finding f = bench.find(method, "probability");
      CAPTURE(b);
      CAPTURE(std::string(method));
      CHECK(f.value <= 1.0);
      CHECK(f.high <= 1.0);
      CHECK(holds(f, exact));
      // The rarer one of both is known to what was asked for: 4 standard deviations of 5 %, and more with levels.
      const double rare = std::min(exact, 1.0 - exact);
      if (std::string(method) != "subset" && f.status.empty()) CHECK(f.high - f.low < 0.4 * rare);
    }
  }
}

// A plane, for which first order is exact: each "off" is a false alarm. Of 40 studies one in a hundred may say so.
TEST_CASE("first order is called off where it is, with the factor, and not where it is exact") {
  int alarms = 0;
  for (int seed = 1; seed <= 40; ++seed) {
    StudyBench bench;
    (void)bench.run("seed = " + std::to_string(seed) + "\n" +
                    standard_study(2, "2 - (x1 + x2)/sqrt(2)", "methods = [\"form\", \"sorm\", \"importance_sampling\"]\ncov = 0.2\n"));
    alarms += has(bench.find("form", "probability", "g").status, "off");
    const study::Finding factor = bench.find("form", "factor to importance_sampling");
    CHECK(factor.low < factor.value);
    CHECK(factor.high > factor.value);
  }
  CHECK(alarms <= 3); // four or more of 40: once in 1500 cases at one in a hundred
  StudyBench bench;   // curved towards the origin: P = 1 − E[Φ(2.5 − 0.2 t²)], twice of first order
  (void)bench.run(standard_study(2, "2.5 - (x1 + x2)/sqrt(2) - 0.1*(x1 - x2)^2", "methods = [\"form\"]\n"));
  const std::string status = bench.find("form", "probability", "g").status;
  CHECK(has(status, "first order is off: importance_sampling gives"));
  CHECK(has(status, "times"));
  const study::Finding factor = bench.find("form", "factor to importance_sampling");
  CHECK(factor.high < 0.9);
}

// A plane at a distance of four, 3.2e-5, and an island of radius 0.05 that has six times as much, 1.3e-4: importance sampling about the
// plane's design point sees hardly anything of the island, sampling sees it, and first order knows the nearest point alone.
TEST_CASE("methods that contradict each other: none of them is believed") {
  StudyBench bench;
  const Outcome outcome = bench.run(
      "seed = 1\n" + standard_study(2, "min(4 - x1, sqrt((x1 + 1.5)^2 + (x2 + 1.5)^2) - 0.05)",
                                    "methods = [\"form\", \"importance_sampling\", \"monte_carlo\"]\nsamples = 60000\ncov = 0.1\n"));
  CHECK(outcome.code == 4);
  CHECK(has(outcome.out, "monte_carlo and importance_sampling contradict each other: one of them has missed a part of the failures"));
  CHECK(has(outcome.out, "not to be trusted"));
  CHECK(has(bench.find("form", "probability", "g").status, "first order is off"));
  // Where they agree nothing of the kind is said.
  StudyBench plain;
  const Outcome agreed = plain.run(
      "seed = 1\n" + standard_study(2, "2 - x1 + 0*x2", "methods = [\"form\", \"importance_sampling\", \"monte_carlo\"]\ncov = 0.2\n"));
  CHECK(!has(agreed.out, "contradict"));
  CHECK(agreed.code != 4);
}

// A band of width 0.1 about x2 = -1, 0.0242, beside a plane at a distance of three: a surrogate of 37 samples may have learned the plane alone.
// First order finds the band's nearest point, at 0.95, and gives 0.171.
TEST_CASE("a surrogate that has missed the failures about a design point is not believed") {
  const double truth = 0.0242 + 0.00135;
  for (const int seed : {1, 2, 3}) {
    CAPTURE(seed);
    StudyBench bench;
    const Outcome outcome = bench.run("seed = " + std::to_string(seed) + "\n" +
                                      standard_study(2, "min(3 - x1, 10*(abs(x2 + 1) - 0.05))", "methods = [\"form\", \"kriging\"]\n"));
    const double p = bench.find("kriging", "probability").value;
    CAPTURE(p);
    if (p < 0.2 * truth) CHECK(has(outcome.out, "kriging may have missed the failures"));
    CHECK((p > 0.8 * truth || outcome.code == 4));
    if (p > 0.8 * truth) CHECK(!has(outcome.out, "may have missed"));
  }
}

TEST_CASE("searches for design points take fewer samples than sampling does, and no more than they are given") {
  for (const KnownCase& c : known_cases()) {
    if (c.form_beta == 0.0) continue;
    StudyBench bench;
    (void)bench.run(text_of_case(c, {"form"}, ""));
    const long dimension = static_cast<long>(c.variables.size());
    CAPTURE(std::string(c.name));
    // The budget, one step more, and what searches from stray failures take.
    CHECK(bench.find("form", "beta", "g").samples <= 450 + 75 * dimension);
  }
  StudyBench bench;
  (void)bench.run(standard_study(2, "12.5 - abs(x1*x2)", "methods = [\"form\"]\nsearch_samples = 60\n"));
  CHECK(bench.find("form", "beta", "g").samples < 600);
}
