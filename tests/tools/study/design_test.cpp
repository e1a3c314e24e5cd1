// Designs of samples and sweeps.
#include "tests/tools/study/study_bench.h"

#include <set>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::vector<study::StoredSample> samples_of(const StudyBench& bench) {
  study::Store store(bench.at("study.sqlite"));
  std::vector<study::StoredSample> rows;
  store.read(1, store.size(), rows);
  return rows;
}

std::string uniform_study(const std::string& design, int samples) {
  return "kind = \"sample\"\n[sample]\ndesign = \"" + design + "\"\nsamples = " + std::to_string(samples) +
         "\n[[variable]]\nname = \"a\"\nrange = [0, 1]\n[[variable]]\nname = \"b\"\nrange = [0, 1]\n[[response]]\nname "
         "= \"y\"\nexpression = \"a*a + b\"\n";
}

} // namespace

TEST_CASE("a grid, a list and one at a time") {
  const std::string head = "kind = \"sweep\"\n[sweep]\n",
                    tail = "[[variable]]\nname = \"a\"\nvalues = [1, 2, 3]\n[[variable]]\nname = \"b\"\nrange = [\"0\", \"1\"]\n"
                           "[[response]]\nname = \"y\"\nexpression = \"10*a + b\"\n";
  const auto ys = [&](const std::string& design, int points) {
    StudyBench bench;
    const Outcome outcome = bench.run(head + "design = \"" + design + "\"\npoints = " + std::to_string(points) + "\n" + tail);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    std::vector<double> values;
    for (const auto& row : samples_of(bench)) values.push_back(row.outcome.numbers[0]);
    return values;
  };
  CHECK(ys("grid", 2) == std::vector<double>{10, 11, 20, 21, 30, 31});
  CHECK(ys("list", 3) == std::vector<double>{10, 20.5, 31});
  CHECK(ys("one_at_a_time", 2) == std::vector<double>{10.5, 10.5, 20.5, 30.5, 10, 11});
}

TEST_CASE("a Latin hypercube has one sample in every stratum of every variable") {
  StudyBench bench;
  REQUIRE(bench.run(uniform_study("latin_hypercube", 50)).code == 0);
  for (std::size_t d = 0; d < 2; ++d) {
    std::set<int> strata;
    for (const auto& row : samples_of(bench)) strata.insert(static_cast<int>(row.values[d] * 50.0));
    CHECK(strata.size() == 50);
  }
}

TEST_CASE("all designs find the mean; those that fill space find it better") {
  // E[a² + b] = 5/6, standard deviation of one sample √(4/45 + 1/12) = 0.415
  for (const char* design : {"monte_carlo", "latin_hypercube", "sobol", "halton"}) {
    StudyBench bench;
    REQUIRE(bench.run(uniform_study(design, 1024)).code == 0);
    const study::Finding mean = bench.find(design, "mean", "y");
    CAPTURE(design);
    const bool is_random = std::string(design) == "monte_carlo";
    // Four standard deviations of the mean for random samples; for the others ln(N)/N, of the order of their
    // discrepancy.
    CHECK(std::abs(mean.value - 5.0 / 6.0) < (is_random ? 4.0 * 0.415 / 32.0 : std::log(1024.0) / 1024.0));
    CHECK(std::isnan(mean.low) == !is_random);
  }
}
