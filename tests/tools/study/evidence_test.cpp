// Survived loads as evidence, against quadrature: R ~ N(10, 2) stays, S ~ N(5, 1) is drawn anew in each load, failure is R < S.
#include "tests/tools/study/known_cases.h"
#include "tests/tools/study/study_bench.h"
#include "tools/study/law.h"
#include "tools/study/weighted_fraction.h"

#include <functional>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_mr = 10.0, k_sr = 2.0, k_ms = 5.0, k_ss = 1.0;

double holds(double r) { return study::normal_cdf((r - k_ms) / k_ss); } // probability that a load with random S is held

// P(failure | evidence), if `likelihood` is the probability of the evidence with the resistance r. Simpson's rule over 12 deviations with
// 4000 steps: its error, of fourth order in a step of 0.003 deviations, is below 1e-9; a jump of the likelihood lies on a node.
double by_quadrature(const std::function<double(double)>& likelihood) {
  constexpr int k_steps = 4000;
  double failing = 0.0, all = 0.0;
  for (int i = 0; i <= k_steps; ++i) {
    const double z = -6.0 + 12.0 * i / k_steps, r = k_mr + k_sr * z;
    const double weight = (i == 0 || i == k_steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * std::exp(-0.5 * z * z) * likelihood(r);
    all += weight;
    failing += weight * (1.0 - holds(r));
  }
  return failing / all;
}

std::string text(const std::string& evidence, const std::string& settings = "") {
  return text_of_case({"", {normal(k_mr, k_sr), normal(k_ms, k_ss)}, "x1 - x2", 0.0, 0.0, {}}, {"form", "importance_sampling"}, settings) +
         evidence;
}

const std::string k_survived = "[[evidence]]\nanew = \"x2\"\n", k_proof = "[[evidence]]\nset = \"x2 = 7\"\n";

bool covers(const study::Finding& f, double exact) { return f.low <= exact && exact <= f.high; }

} // namespace

TEST_CASE("the interval of the probability after a survived load covers that of quadrature") {
  const auto proof = [](double r) { return r > 7.0 + 1e-9 ? 1.0 : r < 7.0 - 1e-9 ? 0.0 : 0.5; };
  CHECK(by_quadrature(holds) == doctest::Approx(0.00780761).epsilon(1e-6)); // the digits of the wanted value
  CHECK(by_quadrature(proof) == doctest::Approx(0.00075463).epsilon(1e-4)); // and a jump within a step of the rule
  for (const auto& [evidence, exact] : {std::pair(k_survived, 0.00780761), std::pair(k_proof, 0.00075463)}) {
    CAPTURE(evidence);
    int covered = 0;
    constexpr int k_seeds = 20;
    for (int seed = 1; seed <= k_seeds; ++seed) {
      StudyBench bench;
      const Outcome outcome = bench.run("seed = " + std::to_string(seed) + "\n" + text(evidence, "cov = 0.1\n"));
      CAPTURE(outcome.err);
      CAPTURE(outcome.out);
      REQUIRE(outcome.code == 0);
      const study::Finding f = bench.find("evidence", "probability");
      covered += covers(f, exact);
      CHECK(f.high - f.low < 0.5 * f.value); // a coefficient of variation of 0.1 gives 0.39; skewness adds to it
    }
    CHECK(covered >= 16); // of 20 intervals of 95 %: fewer have a probability of 2.6e-3
  }
}

// Intervals of 99.9 %, the seed is fixed.
TEST_CASE("several loads, and one that was not held") {
  const std::vector<std::pair<std::string, double>> all = {
      {k_survived + "times = 10\n", by_quadrature([](double r) { return std::pow(holds(r), 10); })},
      {k_survived + "held = false\n", by_quadrature([](double r) { return 1.0 - holds(r); })},
      {k_survived + k_proof, by_quadrature([](double r) { return r > 7.0 + 1e-9   ? holds(r)
                                                                 : r < 7.0 - 1e-9 ? 0.0
                                                                                  : 0.5 * holds(r); })}};
  for (const auto& [evidence, exact] : all) {
    CAPTURE(evidence);
    StudyBench bench;
    const Outcome outcome = bench.run(text(evidence, "cov = 0.1\nsamples = 1000000\nconfidence = 0.999\n"));
    CAPTURE(outcome.out);
    REQUIRE(outcome.code == 0);
    const study::Finding f = bench.find("evidence", "probability");
    CHECK(covers(f, exact));
    CHECK(f.high - f.low < f.value); // 2 · 3.29 · 0.1 and its skewness
  }
}

TEST_CASE("what evidence says of a variable, and the answer as a sentence") {
  StudyBench bench;
  const Outcome outcome = bench.run(text(k_proof, "cov = 0.05\nsamples = 1000000\nconfidence = 0.999\n"));
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  CHECK(covers(bench.find("evidence", "without evidence"), 0.01267366));
  CHECK(covers(bench.find("evidence", "chance of the evidence"), study::normal_cdf(1.5))); // P(R > 7)
  // The normal distribution truncated at −1.5 deviations: mean + s λ with λ = φ(1.5)/Φ(1.5), variance s² (1 − 1.5 λ − λ²).
  const double lambda = std::exp(-0.5 * 1.5 * 1.5) / std::sqrt(2.0 * std::acos(-1.0)) / study::normal_cdf(1.5);
  const double n = bench.find("evidence", "effective samples").value, deviation = k_sr * std::sqrt(1.0 - 1.5 * lambda - lambda * lambda);
  CHECK(n > 1000.0);
  CHECK(std::abs(bench.find("evidence", "mean with evidence", "x1").value - (k_mr + k_sr * lambda)) < 4.0 * deviation / std::sqrt(n));
  // The deviation's own standard error is deviation/√(2n) for a normal distribution, and smaller for a truncated one.
  CHECK(std::abs(bench.find("evidence", "standard deviation with evidence", "x1").value - deviation) <
        4.0 * deviation / std::sqrt(2.0 * n));
  CHECK(has(outcome.out, "With the evidence of 1 past load the probability of failure is 0.0007"));
}

TEST_CASE("the next leg of a voyage begins with what the last one has shown") {
  StudyBench bench;
  REQUIRE(bench.run(text(k_proof, "cov = 0.1\n")).code == 0);
  const std::string posterior = study_does({"export", bench.at("study.sqlite"), "--posterior"}).out;
  CHECK(posterior.starts_with("x1\n"));
  CHECK(std::count(posterior.begin(), posterior.end(), '\n') == 1001);
  bench.write("leg.csv", posterior);
  // Fitted to 1000 values the parameters are known to 0.07 and 0.07 or so, with which the index, about 3.2, changes by 0.05. One deviation
  // of P is therefore a factor of exp(3.4 · 0.05) = 1.2; 1.6 is more than two of them, and the seed is fixed.
  const Outcome outcome = bench.run("kind = \"reliability\"\n[[variable]]\nname = \"x1\"\ndistribution = \"normal\"\nmeasured = "
                                    "\"leg.csv\"\ncolumn = \"x1\"\nlower = 7\n[[variable]]\nname = \"x2\"\n" +
                                        normal(k_ms, k_ss) + "[[limit_state]]\nname = \"g\"\nexpression = \"x1 - x2\"\n",
                                    {"--restart"});
  CAPTURE(outcome.err);
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  const double p = bench.find("importance_sampling", "probability").value;
  CHECK(p > 0.00075463 / 1.6);
  CHECK(p < 0.00075463 * 1.6);
  CHECK(study_does({"export", bench.at("study.sqlite"), "--posterior"}).code == 2); // that study has no evidence
}

TEST_CASE("evidence that leaves too few samples is refused") {
  StudyBench bench;
  const Outcome outcome = bench.run(text("[[evidence]]\nset = \"x2 = 17\"\n", "samples = 2000\n")); // P(R > 17) = 2.3e-4
  CHECK(outcome.code == 4);
  CHECK(has(bench.find("evidence", "probability").status, "too few to judge by"));
}

// A run without a result under a load of the past says neither that it held nor that it failed.
TEST_CASE("evidence without a result gives bounds") {
  StudyBench bench;
  // The load of the past has no result where x1 > 12; elsewhere it always held, which says nothing.
  const Outcome outcome =
      bench.run(text("[[limit_state]]\nname = \"past\"\nexpression = \"x2 > 0 ? 1 : 1\"\n[[evidence]]\nset = \"x2 = 1\"\n"
                     "limit_states = \"past\"\n",
                     "confidence = 0.999\n"));
  CAPTURE(outcome.out);
  CHECK(covers(bench.find("evidence", "probability"), 0.01267366));
  const Outcome unknown =
      bench.run(text("[[limit_state]]\nname = \"past\"\nexpression = \"x2 > 0 ? 1 : sqrt(12 - x1)\"\n[[evidence]]\nset = \"x2 = -1\"\n"
                     "limit_states = \"past\"\n",
                     "confidence = 0.999\n"),
                {"--restart"});
  CAPTURE(unknown.out);
  const study::Finding low = bench.find("evidence", "probability, runs without result as safe"),
                       high = bench.find("evidence", "probability, runs without result as unsafe");
  // If unknown loads were held, nothing is learnt. If not, x1 is below 12, and failures are more likely by 1/P(x1 < 12).
  CHECK(covers(low, 0.01267366));
  CHECK(covers(high, 0.01267366 / study::normal_cdf(1.0)));
}

TEST_CASE("evidence that cannot be used is refused with its place") {
  const auto refused = [](const std::string& evidence, const std::string& settings = "") {
    StudyBench bench;
    const Outcome outcome = bench.run(text(evidence, settings));
    CHECK(outcome.code == 3);
    CHECK(has(outcome.err, "study.toml:"));
    return outcome.err;
  };
  CHECK(has(refused("[[evidence]]\n"), "Say what differed"));
  CHECK(has(refused("[[evidence]]\nanew = [\"x1\", \"x2\"]\n"), "says nothing about the next one"));
  CHECK(has(refused("[[evidence]]\nanew = \"x3\"\n"), "there is no variable 'x3'"));
  CHECK(has(refused("[[evidence]]\nset = \"x2\"\n"), "write \"variable = value\""));
  CHECK(has(refused("[[evidence]]\nset = \"x2 = 7 m\"\n"), "x2 = 7 m"));
  CHECK(has(refused("[[evidence]]\nset = \"x2 = inf\"\n"), "finite"));
  CHECK(has(refused(k_proof + "times = 3\n"), "'times' is for loads that differ"));
  CHECK(has(refused(k_survived + "limit_states = \"h\"\n"), "there is no limit state 'h'"));
  CHECK(has(refused(k_survived + "[[correlation]]\nbetween = [\"x1\", \"x2\"]\nrho = 0.3\n"), "are correlated"));
  StudyBench bench;
  CHECK(has(bench.run("kind = \"sample\"\n[[variable]]\nname = \"x1\"\n" + normal(0, 1) + "[[evidence]]\nanew = \"x1\"\n").err,
            "[[evidence]] is for studies of the kind 'reliability'"));
}

// Weights of one size make the fraction a proportion.
TEST_CASE("a weighted fraction of equal weights is a proportion") {
  study::WeightedFraction fraction;
  for (int i = 0; i < 1000; ++i) fraction.add(0.5, i % 10 == 0);
  CHECK(fraction.mean() == doctest::Approx(0.1).epsilon(1e-12));
  CHECK(fraction.deviation() == doctest::Approx(std::sqrt(0.1 * 0.9 / 1000.0)).epsilon(1e-12));
  CHECK(fraction.effective() == doctest::Approx(1000.0).epsilon(1e-12));
  CHECK(fraction.effective_hits() == doctest::Approx(100.0).epsilon(1e-12));
  CHECK(fraction.interval(0.95).low == doctest::Approx(0.1 - 1.96 * std::sqrt(0.09 / 1000.0)).epsilon(0.02)); // skewness moves it by 1 %
}
