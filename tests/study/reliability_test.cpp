// Limit states without dynamics whose probability is known exactly: closed forms, or quadrature in double precision.
#include "tests/study/study_bench.h"
#include "tools/study/law.h"

#include <map>

using namespace steplap;
using namespace steplap::testing;

namespace {

struct Case {
  const char* name;
  std::vector<std::string> variables; ///< what follows the name in a [[variable]]
  const char* g;
  double probability;
  double form_beta = 0.0; ///< of the nearest design point; 0: there is none to be found
  std::vector<std::string> methods;
};

std::string normal(double mean, double deviation) {
  return "distribution = \"normal\"\nmean = " + std::to_string(mean) +
         "\nstandard_deviation = " + std::to_string(deviation) + "\n";
}

std::string text_of_case(const Case& c, const std::vector<std::string>& methods, const std::string& settings) {
  std::string text = "kind = \"reliability\"\n[reliability]\nmethods = [";
  for (const std::string& m : methods) text += "\"" + m + "\", ";
  text += "]\n" + settings;
  for (std::size_t i = 0; i < c.variables.size(); ++i)
    text += "[[variable]]\nname = \"x" + std::to_string(i + 1) + "\"\n" + c.variables[i];
  return text + "[[limit_state]]\nname = \"g\"\nexpression = \"" + c.g + "\"\n";
}

std::vector<Case> cases() {
  const std::string standard = normal(0, 1);
  const std::vector<std::string> ten(10, standard), twenty(20, "distribution = \"exponential\"\nmean = 1\n");
  return {
      {"resistance and load",
       {normal(4, 1), normal(2, 1)},
       "x1 - x2",
       7.86496035e-2,
       std::sqrt(2.0),
       {"monte_carlo", "importance_sampling", "directional", "subset"}},
      {"axial beam",
       {"distribution = \"lognormal\"\nmean = 300\nstandard_deviation = 30\n", normal(75000, 5000)},
       "x1 - x2/(100*pi)",
       2.91982e-2,
       0.0,
       {"monte_carlo", "importance_sampling", "directional", "subset"}},
      {"RP22",
       {standard, standard},
       "2.5 - (x1 + x2)/sqrt(2) + 0.1*(x1 - x2)^2",
       4.207305e-3,
       2.5,
       {"monte_carlo", "importance_sampling", "directional", "subset"}},
      {"four branches",
       {standard, standard},
       "min(3 + 0.1*(x1-x2)^2 - (x1+x2)/sqrt(2), 3 + 0.1*(x1-x2)^2 + (x1+x2)/sqrt(2), x1 - x2 + 7/sqrt(2), x2 - x1 + "
       "7/sqrt(2))",
       2.222795e-3,
       3.0,
       {"importance_sampling", "directional", "subset"}},
      {"RP28",
       {normal(78064, 11710), normal(0.0104, 0.00156)},
       "x1*x2 - 146.14",
       1.4533e-7,
       0.0,
       {"importance_sampling", "subset"}},
      {"RP54",
       twenty,
       "sum(x1,x2,x3,x4,x5,x6,x7,x8,x9,x10,x11,x12,x13,x14,x15,x16,x17,x18,x19,x20) - 8.951",
       9.90603e-4,
       0.0,
       {"monte_carlo", "subset"}},
      {"RP77",
       {normal(10, 0.5), standard, normal(4, 1)},
       "x3 <= 5 ? x1 - x2 - x3 : x3 - x2",
       2.69128e-7,
       0.0,
       {"directional"}},
      {"RP89",
       {standard, standard},
       "min(8 - x1^2 - x2, 6 - x1/5 - x2)",
       5.4713e-3,
       0.0,
       {"monte_carlo", "importance_sampling", "directional"}},
      {"RP107",
       ten,
       "5*sqrt(10) - sum(x1,x2,x3,x4,x5,x6,x7,x8,x9,x10)",
       2.866516e-7,
       5.0,
       {"importance_sampling", "subset"}},
      {"RP111", {standard, standard}, "12.5 - abs(x1*x2)", 8.035e-7, 5.0, {"importance_sampling", "directional"}},
  };
}

} // namespace

// Intervals of 99.9 %: of the thirty of them one misses in one of thirty seeds; the seed is fixed.
TEST_CASE("sampling: the interval covers the exact probability") {
  for (const Case& c : cases()) {
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
      const double most =
          method == "subset" ? 20.0 : 5.0; // and says something: of four repetitions little is known at 99.9 %
      CHECK(f.low > c.probability / most);
      CHECK(f.high < most * c.probability);
    }
  }
}

TEST_CASE("FORM finds the nearest design point") {
  for (const Case& c : cases()) {
    if (c.form_beta == 0.0) continue;
    StudyBench bench;
    (void)bench.run(text_of_case(c, {"form"}, ""));
    CAPTURE(std::string(c.name));
    // Asked for in studies.md: 1e-4.
    CHECK(bench.find("form", "beta", "g").value == doctest::Approx(c.form_beta).epsilon(1e-4));
  }
}

TEST_CASE("FORM and SORM of three correlated variables are those that pystra's tests give") {
  // 3.7347; Breitung 3.8537, Hohenbichler and Rackwitz 3.8582: to the digits published.
  StudyBench bench;
  const Case c{"3RV",
               {"distribution = \"lognormal\"\nmean = 500\nstandard_deviation = 100\n", normal(2000, 400),
                "distribution = \"uniform\"\nmean = 5\nstandard_deviation = 0.5\n"},
               "1.7 - x2/(1000*x3) - (x1/(200*x3))^2",
               0.0,
               0.0,
               {}};
  std::string text = text_of_case(c, {"form", "sorm"}, "");
  for (const auto& [pair, rho] :
       std::map<std::string, double>{{"\"x1\", \"x2\"", 0.3}, {"\"x1\", \"x3\"", 0.2}, {"\"x2\", \"x3\"", 0.2}})
    text += "[[correlation]]\nbetween = [" + pair + "]\nrho = " + std::to_string(rho) + "\n";
  const Outcome outcome = bench.run(text);
  CAPTURE(outcome.err);
  CHECK(std::abs(bench.find("form", "beta", "g").value - 3.7347) < 1e-4);
  CHECK(std::abs(bench.find("sorm", "beta (Breitung)").value - 3.8537) < 4e-4);
  CHECK(std::abs(bench.find("sorm", "beta (Hohenbichler)").value - 3.8582) < 4e-4);
}

TEST_CASE("traps of FORM are told") {
  const std::vector<Case> all = cases();
  const auto called = [&](const std::string& name) {
    return *std::find_if(all.begin(), all.end(), [&](const Case& c) { return c.name == name; });
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
    const Case c{"", {normal(0, 1), normal(0, 1)}, "x1 > 1 ? 2.2 - x1 + 0*x2 : 3 + x1", 0.0, 0.0, {}};
    (void)bench.run(text_of_case(c, {"form"}, "starts = 1\n"));
    CHECK(bench.find("form", "beta", "g").value == doctest::Approx(2.2).epsilon(1e-4));
    CHECK(bench.find("form", "beta", "design point 2").value == doctest::Approx(3.0).epsilon(1e-4));
    CHECK(has(bench.find("form", "beta", "design point 2").status, "another design point beats it"));
  }
  SUBCASE("nothing fails") {
    StudyBench bench;
    const Outcome outcome =
        bench.run(text_of_case({"", {normal(0, 1)}, "1 + x1^2", 0.0, 0.0, {}}, {"monte_carlo"}, "samples = 3000\n"));
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
    Case c{"RP111", {normal(0, 1), normal(0, 1)}, "12.5 - abs(x1*x2)", 8.035e-7, 5.0, {}};
    (void)bench.run("seed = " + std::to_string(seed) + "\n" +
                    text_of_case(c, {"form", "importance_sampling"}, "starts = 2\nconfidence = 0.99\n"));
    const study::Finding f = bench.find("importance_sampling", "probability");
    CAPTURE(seed);
    CHECK(f.low <= c.probability);
    CHECK(f.high >= c.probability);
    CHECK(f.high - f.low < 0.4 * c.probability);
    for (int k = 1; k <= 4; ++k)
      CHECK(bench.find("form", "beta", "design point " + std::to_string(k)).value ==
            doctest::Approx(5.0).epsilon(1e-4));
  }
}

TEST_CASE("a system of limit states: any of them, and all of them") {
  // Independent normal variables: 1 − Φ(1.5)Φ(2), and Φ(−1.5)Φ(−2)
  const double either = 1.0 - study::normal_cdf(1.5) * study::normal_cdf(2.0),
               both = study::normal_cdf(-1.5) * study::normal_cdf(-2.0);
  for (const auto& [combination, exact] : std::map<std::string, double>{{"any", either}, {"all", both}}) {
    StudyBench bench;
    std::string text = "kind = \"reliability\"\n[reliability]\nmethods = [\"importance_sampling\", "
                       "\"directional\"]\nconfidence = 0.999\ncombination = \"" +
                       combination + "\"\n";
    text += "[[variable]]\nname = \"x1\"\n" + normal(0, 1) + "[[variable]]\nname = \"x2\"\n" + normal(0, 1);
    text += "[[limit_state]]\nname = \"first\"\nexpression = \"1.5 - x1\"\n[[limit_state]]\nname = "
            "\"second\"\nexpression = \"2 - x2\"\n";
    const Outcome outcome = bench.run(text);
    CAPTURE(outcome.err);
    CAPTURE(combination);
    for (const char* method : {"importance_sampling", "directional"}) {
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

// By rays and by levels as well: beyond x1 = 2 a ray is safe or fails, but nearer to the origin it says what it finds.
TEST_CASE("rays and levels know what lies before runs without a result") {
  const double least = study::normal_cdf(2.0) - study::normal_cdf(1.0), most = study::normal_cdf(-1.0);
  const auto text = [](const std::string& failed) {
    return "kind = \"reliability\"\nfailed = \"" + failed +
           "\"\n[reliability]\nmethods = [\"directional\", \"subset\"]\nsamples = 40000\ncov = 0.02\nconfidence = "
           "0.999\n"
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
  for (const char* method : {"directional", "subset"}) {
    StudyBench both, safe, unsafe;
    (void)both.run(text("bounds"));
    const study::Finding low = both.find(method, "probability, runs without result as safe"),
                         high = both.find(method, "probability, runs without result as unsafe");
    check(low, least);
    check(high, most);
    CHECK(low.value < high.value); // of the same samples
    (void)safe.run(text("safe"));
    check(safe.find(method, "probability"), least);
    (void)unsafe.run(text("unsafe"));
    check(unsafe.find(method, "probability"), most);
  }
}

// One in series with two in parallel: 1 − (1 − p1)(1 − p2 p3). The nearest failure is where both of the pair fail, a
// corner at which no search by gradients arrives: that it does not is said.
TEST_CASE("a system in series and in parallel") {
  const double p1 = study::normal_cdf(-2.8), p2 = study::normal_cdf(-1.8), p3 = study::normal_cdf(-1.5);
  const double exact = 1.0 - (1.0 - p1) * (1.0 - p2 * p3);
  std::string text =
      "kind = \"reliability\"\n[reliability]\nmethods = [\"form\", \"importance_sampling\", \"directional\"]\n"
      "confidence = 0.999\n";
  for (const char* name : {"x1", "x2", "x3"})
    text += "[[variable]]\nname = \"" + std::string(name) + "\"\n" + normal(0, 1);
  text += "[[response]]\nname = \"second\"\nexpression = \"1.8 - x2\"\n[[response]]\nname = \"third\"\nexpression = "
          "\"1.5 - x3\"\n"
          "[[limit_state]]\nname = \"first\"\nexpression = \"2.8 - x1\"\n"
          "[[limit_state]]\nname = \"pair\"\nexpression = \"max(second, third)\"\n";
  StudyBench bench;
  const Outcome outcome = bench.run(text);
  CAPTURE(outcome.err);
  for (const char* method : {"importance_sampling", "directional"}) {
    CAPTURE(method);
    CHECK(bench.find(method, "probability").low <= exact);
    CHECK(bench.find(method, "probability").high >= exact);
  }
  CHECK(has(bench.find("form", "probability").status, "another design point beats it"));
}

// Of ranks: the normal variables behind them have 2 sin(π ρ/6). ln a − ln b is normal.
TEST_CASE("a copula of ranks: the load beats the resistance") {
  const double za = std::sqrt(std::log1p(0.0625)), zb = std::sqrt(std::log1p(0.16)),
               rho = 2.0 * std::sin(std::acos(-1.0) * -0.4 / 6.0);
  const double beta =
      (std::log(3.0) - 0.5 * za * za + 0.5 * zb * zb) / std::sqrt(za * za + zb * zb - 2.0 * rho * za * zb);
  std::string text = "kind = \"reliability\"\n[reliability]\nmethods = [\"form\"]\n";
  text += "[[variable]]\nname = \"a\"\ndistribution = \"lognormal\"\nmean = 3\ncov = 0.25\n";
  text += "[[variable]]\nname = \"b\"\ndistribution = \"lognormal\"\nmean = 1\ncov = 0.4\n";
  text += "[[correlation]]\nbetween = [\"a\", \"b\"]\nrho = -0.4\nof = \"ranks\"\n";
  text += "[[limit_state]]\nname = \"g\"\nexpression = \"ln(a) - ln(b)\"\n";
  StudyBench bench;
  REQUIRE(bench.run(text).code == 0);
  CHECK(bench.find("form", "beta", "g").value == doctest::Approx(beta).epsilon(1e-9)); // a plane: FORM is exact
}
