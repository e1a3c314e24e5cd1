// Studies that ask for what cannot be, or of what never has an answer: each gets one that is clear, and none that is
// wrong.
#include "tests/tools/study/block_scene.h"
#include "tests/tools/study/study_bench.h"

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string normal(const std::string& name) {
  return "[[variable]]\nname = \"" + name + "\"\ndistribution = \"normal\"\nmean = 0\nstandard_deviation = 1\n";
}

std::string limit(const std::string& expression) { return "[[limit_state]]\nname = \"g\"\nexpression = \"" + expression + "\"\n"; }

std::string reliability(const std::string& method, const std::string& expression) {
  return "kind = \"reliability\"\n[reliability]\nmethods = [\"" + method + "\"]\nsamples = 2000\nstarts = 3\nsubset_samples = 500\n" +
         normal("x") + limit(expression);
}

const std::string k_mu = "[[variable]]\nname = \"mu\"\npath = \"element.deck friction.static_friction\"\n";
const char* const k_methods[] = {"monte_carlo", "form", "importance_sampling", "subset"};

// Whatever is said of the probability, its interval must hold the true one, if it has any.
void check_intervals(const StudyBench& bench, double truth) {
  for (const study::Finding& f : bench.findings()) {
    if (f.quantity.find("probability") == std::string::npos || std::isnan(f.low) || std::isnan(f.high)) continue;
    CAPTURE(f.method);
    CAPTURE(f.quantity);
    const bool is_low = has(f.quantity, "as safe"), is_high = has(f.quantity, "as unsafe");
    if (!is_high) CHECK(f.low <= truth);
    if (!is_low) CHECK(f.high >= truth);
  }
}

} // namespace

TEST_CASE("a limit state that never fails: no method claims a probability") {
  for (const char* method : k_methods) {
    CAPTURE(method);
    StudyBench bench;
    const Outcome outcome = bench.run(reliability(method, "1 + x^2"));
    CHECK((outcome.code == 4 || outcome.code == 5));
    check_intervals(bench, 0.0);
    for (const study::Finding& f : bench.findings())
      if (f.quantity == "probability") CHECK((f.value == 0.0 || !f.status.empty()));
  }
}

TEST_CASE("a limit state that always fails") {
  for (const char* method : k_methods) {
    CAPTURE(method);
    StudyBench bench;
    (void)bench.run(reliability(method, "-1 - x^2"));
    for (const study::Finding& f : bench.findings())
      if (f.quantity == "probability" && f.method != "form") {
        CHECK(f.value == doctest::Approx(1.0).epsilon(1e-6));
        CHECK(f.low > 0.9);
      }
  }
}

// sqrt(x) has no value for half of all x, and is below 0.1 for x < 0.01: Φ(0.01) − 1/2 = 0.0039894.
TEST_CASE("a limit state that has no value where x is negative") {
  for (const char* method : k_methods) {
    CAPTURE(method);
    StudyBench bench;
    const Outcome outcome = bench.run(reliability(method, "sqrt(x) - 0.1"));
    CAPTURE(outcome.err);
    CHECK((outcome.code == 4 || outcome.code == 5));
    check_intervals(bench, 0.0039894);
    CHECK(has(outcome.out, "limit state 'g' has no value"));
  }
}

TEST_CASE("a limit state that never has a value") {
  for (const char* method : k_methods) {
    CAPTURE(method);
    StudyBench bench;
    const Outcome outcome = bench.run(reliability(method, "sqrt(-1 - x^2)"));
    CAPTURE(outcome.err);
    CHECK((outcome.code == 4 || outcome.code == 5));
    check_intervals(bench, 0.5); // nothing is known: both ends are open
  }
}

TEST_CASE("values that the model does not take") {
  StudyBench bench;
  bench.write("block.toml", k_block);
  const std::string head = "kind = \"sample\"\nmodel = \"block.toml\"\n[sample]\nsamples = 20\n" + k_mu;
  SUBCASE("some: told, and the mean of the others is not what was asked for") {
    const Outcome outcome = bench.run(head + "distribution = \"uniform\"\nlow = -0.1\nhigh = 0.3\n" + k_slid);
    CHECK(outcome.code == 5);
    CHECK(has(outcome.out, "'static_friction' of element 'deck friction' must be at least 0"));
    CHECK(has(outcome.out, "(others alike, with other numbers)")); // one line for all
    CHECK(has(bench.find("monte_carlo", "50 % quantile").status, "are left out"));
  }
  SUBCASE("all: nothing is known") {
    const Outcome outcome = bench.run(head + "distribution = \"uniform\"\nlow = -2\nhigh = -1\nvalue = 0.3\n" + k_slid);
    CHECK(outcome.code == 4);
    CHECK(std::isnan(bench.find("monte_carlo", "mean").value));
  }
  SUBCASE("all, and the study is to stop") {
    const Outcome outcome =
        bench.run("failed = \"stop\"\n" + head + "distribution = \"uniform\"\nlow = -2\nhigh = -1\nvalue = 0.3\n" + k_slid);
    CHECK(outcome.code == 4);
    CHECK(has(outcome.err, "sample 1 impossible"));
  }
}

TEST_CASE("odd variables are told before anything runs") {
  StudyBench bench;
  bench.write("block.toml", k_block);
  const auto said = [&](const std::string& text) {
    const Outcome outcome = bench.run(text);
    CHECK(outcome.code == 3);
    return outcome.err;
  };
  const std::string sweep = "kind = \"sweep\"\nmodel = \"block.toml\"\n", path = "\"element.deck friction.static_friction\"";
  CHECK(has(said(sweep + "[[variable]]\nname = \"mu\"\npath = [" + path + ", " + path + "]\nvalues = [0.1]\n" + k_slid),
            "variable 'mu' names the path"));
  CHECK(has(said(sweep + k_mu + "values = [0.1]\n[[variable]]\nname = \"nu\"\npath = " + path + "\nvalues = [0.2]\n" + k_slid),
            "two variables, 'mu' and 'nu'"));
  const std::string sample = "kind = \"sample\"\n[[response]]\nname = \"r\"\nexpression = \"x\"\n[[variable]]\nname = \"x\"\n";
  CHECK(has(said(sample + "distribution = \"uniform\"\nlow = 2\nhigh = 1\n"), "'low' must be below 'high'"));
  CHECK(has(said(sample + "distribution = \"triangular\"\nlow = 0\nmode = 2\nhigh = 1\n"), "'mode' must lie between"));
  CHECK(has(said(sample + "distribution = \"normal\"\nmean = 0\nstandard_deviation = 1\nlower = 60\nupper = 61\n"),
            "'lower' and 'upper' leave nothing of a normal distribution with mean = 0, standard_deviation = 1"));
  CHECK(has(said(sample + "distribution = \"normal\"\nmean = nan\nstandard_deviation = 1\n"), "must be finite"));
  CHECK(has(said("kind = \"sample\"\n" + normal("x") + normal("y") + normal("z") +
                 "[[response]]\nname = \"r\"\nexpression = \"x + y + z\"\n" +
                 "[[correlation]]\nbetween = [\"x\", \"y\"]\nrho = 0.9\n[[correlation]]\nbetween = [\"y\", \"z\"]\nrho "
                 "= 0.9\n" +
                 "[[correlation]]\nbetween = [\"x\", \"z\"]\nrho = -0.9\n"),
            "not positive definite"));
  CHECK(has(said("kind = \"sample\"\n" + normal("x") + "[[response]]\nname = \"r\"\nexpression = \"x = 3\"\n"), "assigns with '='"));
  CHECK(bench
            .run("kind = \"sample\"\n[sample]\nsamples = 10\n" + normal("x") +
                 "[[response]]\nname = \"r\"\nexpression = \"x >= 0 && x != 3 && x == x\"\n")
            .code == 0);
}

TEST_CASE("an expression that is zero all over has no critical value") {
  StudyBench bench;
  const std::string text = "kind = \"critical\"\n[critical]\nvariable = \"x\"\nexpression = \"max(0, x - "
                           "0.5)\"\n[[variable]]\nname = \"x\"\nrange = [0, 1]\n";
  CHECK(bench.run(text).code == 5);
  const study::Finding f = bench.find("critical", "critical value");
  CHECK(has(f.status, "zero all over"));
  CHECK(f.low == 0.0);
  CHECK(f.high == doctest::Approx(0.5));
}

// Parameters that are each in their ranges and make no distribution together, of every kind: what is said has no word
// of a library's in it.
TEST_CASE("words of libraries never reach the user") {
  const char* values[] = {"1", "5", "-1", "1e-300", "1e300", "1e308", "-1e308", "0"};
  const std::vector<std::pair<std::string, std::vector<std::string>>> kinds{
      {"normal", {"mean", "standard_deviation", "lower"}},     {"lognormal", {"mean", "standard_deviation", "location"}},
      {"uniform", {"mean", "standard_deviation", "upper"}},    {"triangular", {"low", "mode", "high"}},
      {"weibull", {"mean", "standard_deviation", "location"}}, {"gumbel", {"mean", "standard_deviation", "lower"}},
      {"beta", {"mean", "standard_deviation", "high"}},        {"exponential", {"mean", "location", "lower"}}};
  StudyBench bench;
  for (const auto& [kind, keys] : kinds)
    for (std::size_t k = 0; k < 16; ++k) {
      std::string text = "kind = \"sample\"\n[sample]\nsamples = 3\n[[variable]]\nname = \"x\"\ndistribution = \"" + kind + "\"\n";
      for (std::size_t i = 0; i < keys.size(); ++i)
        text += keys[i] + " = " + values[(k * (2 * i + 1) + i * (k / 8 + 1) + k / 8) % 8] + "\n";
      if (kind == "beta") text += "low = 0\n";
      const Outcome outcome = bench.run(text + "[[response]]\nname = \"r\"\nexpression = \"x\"\n", {"--restart"});
      CAPTURE(text);
      CAPTURE(outcome.err);
      CHECK((outcome.code == 0 || outcome.code == 3 || outcome.code == 5 || outcome.code == 4));
      for (const char* word : {"class=", "Unnamed", "MUST", "Exception", "OT::", "Error:", "internal", "null"})
        CHECK_FALSE(has(outcome.err + outcome.out, word));
    }
  for (const char* method : k_methods)
    for (const char* g : {"1 + x^2", "-1 - x^2", "sqrt(-1 - x^2)", "x > 7 ? -1 : 1", "exp(exp(x*20)) - 5", "1/(x - 0.5)", "0*x"}) {
      const Outcome outcome = bench.run(reliability(method, g), {"--restart"});
      for (const char* word : {"class=", "Unnamed", "MUST", "Exception", "OT::", "internal"})
        CHECK_FALSE(has(outcome.err + outcome.out, word));
    }
}

// 100 000 threads would take 5 GB before the first sample.
TEST_CASE("more threads than the limit are refused by an error that names it") {
  StudyBench bench;
  const std::string text = reliability("monte_carlo", "x - 3");
  const Outcome refused = bench.run(text, {"--threads", "100000"});
  CHECK(refused.code == 2);
  CHECK(has(refused.err, "--threads takes a whole number from 1 to 1024, not '100000'"));
  CHECK(bench.run(text, {"--threads", "2"}).code != 2);
}

TEST_CASE("help tells the exit codes of studies") {
  const Outcome outcome = study_does({"--help"});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "a store that cannot be used"));
  CHECK(has(outcome.out, "an answer that is not to be trusted"));
  CHECK_FALSE(has(outcome.out, "partial_"));
}
