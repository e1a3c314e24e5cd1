// Critical values and borders against closed forms.
#include "tests/tools/study/block_scene.h"
#include "tests/tools/study/study_bench.h"

#include <array>
#include <map>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string critical(const std::string& expression, double low, double high) {
  return "kind = \"critical\"\n[critical]\nvariable = \"x\"\nexpression = \"" + expression + "\"\n[[variable]]\nname = \"x\"\nrange = [" +
         std::to_string(low) + ", " + std::to_string(high) + "]\n";
}

// Points of a border, both variables.
std::map<std::string, std::vector<std::pair<double, double>>> borders_of(const StudyBench& bench) {
  std::map<std::string, std::vector<std::pair<double, double>>> borders;
  const auto& f = bench.findings();
  for (std::size_t i = 0; i + 1 < f.size(); i += 2)
    borders[f[i].subject.substr(0, f[i].subject.find(" point"))].emplace_back(f[i].value, f[i + 1].value);
  return borders;
}

} // namespace

TEST_CASE("the friction at which the block slides 5 mm: mu* = A/(g (1 + 2 D/(A t^2)))") {
  StudyBench bench;
  bench.write("block.toml", k_block);
  const Outcome outcome = bench.run("model = \"block.toml\"\nkind = \"critical\"\n[critical]\nvariable = "
                                    "\"mu\"\nexpression = \"slid - 0.005\"\npoints = 5\n[[variable]]\nname = \"mu\"\n"
                                    "path = \"element.deck friction.static_friction\"\nrange = [0.3, 0.59]\n" +
                                    k_slid);
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(bench.find("critical", "critical value").value == doctest::Approx(0.512866686).epsilon(1e-8)); // studies.md, to its digits
  CHECK(has(outcome.out, "falls all over the range"));
}

TEST_CASE("all crossings of a response that is not monotonic") {
  StudyBench bench;
  REQUIRE(bench.run(critical("sin(x) - 0.5", 0, 10)).code == 0);
  const double pi = std::acos(-1.0);
  REQUIRE(bench.findings().size() == 4); // 13 pi/6 = 6.81 and 17 pi/6 = 8.90 too
  for (int i = 0; i < 4; ++i)
    CHECK(bench.findings()[i].value == doctest::Approx((i % 2 ? 5.0 / 6.0 : 1.0 / 6.0) * pi + i / 2 * 2.0 * pi).epsilon(1e-8));
  CHECK(has(text_of(bench.at("study.toml")), "sin"));
}

TEST_CASE("a pair of crossings between two looks is seen where the response turns") {
  StudyBench bench;
  // Zeros at 0.52 ± 0.01; the looks are 0.05 apart.
  REQUIRE(bench.run(critical("(x - 0.52)^2 - 0.0001", 0, 1)).code == 0);
  REQUIRE(bench.findings().size() == 2);
  CHECK(bench.findings()[0].value == doctest::Approx(0.51).epsilon(1e-7));
  CHECK(bench.findings()[1].value == doctest::Approx(0.53).epsilon(1e-7));
}

TEST_CASE("a jump past zero is no zero") {
  StudyBench bench;
  (void)bench.run(critical("x < 0.3 ? -1 : 2", 0, 1));
  CHECK(bench.find("critical", "critical value").value == doctest::Approx(0.3).epsilon(1e-7));
  CHECK(has(bench.find("critical", "critical value").status, "jumps past zero"));
}

TEST_CASE("no crossing is an answer of its own, and an exit code") {
  StudyBench bench;
  CHECK(bench.run(critical("1 + x^2", 0, 1)).code == 5);
  CHECK(has(bench.find("critical", "critical value").status, "positive wherever it was looked at"));
}

// t = sqrt(2 D0/(A (A/(mu g) − 1)))
TEST_CASE("the border of damage in the plane of acceleration and duration") {
  StudyBench bench;
  bench.write("block.toml", k_block);
  const Outcome outcome = bench.run("model = \"block.toml\"\nkind = \"map\"\n[map]\nvariables = [\"A\", \"t\"]\nexpression = \"0.005 - "
                                    "slid\"\nstep = 0.1\npoints = 4\n"
                                    "[[variable]]\nname = \"A\"\npath = \"signal.push.peak\"\nrange = [3.924, 19.62]\n"
                                    "[[variable]]\nname = \"t\"\npath = \"signal.push.duration\"\nrange = [\"5 ms\", \"100 ms\"]\n" +
                                    k_slid);
  CAPTURE(outcome.err);
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  const auto borders = borders_of(bench);
  REQUIRE(borders.size() == 1);
  const auto& points = borders.begin()->second;
  CHECK(points.size() > 10);
  for (const auto& [A, t] : points) CHECK(t == doctest::Approx(std::sqrt(0.01 / (A * (A / (0.3 * k_g) - 1.0)))).epsilon(1e-6));
  // From end to end: A = 0.4 g at 87.437 ms, 2 g at 9.484 ms (studies.md).
  const auto [least, most] = std::minmax_element(points.begin(), points.end());
  CHECK(least->first == doctest::Approx(0.4 * k_g));
  CHECK(least->second == doctest::Approx(0.087437177).epsilon(1e-6));
  CHECK(most->first == doctest::Approx(2.0 * k_g));
  CHECK(most->second == doctest::Approx(0.009483893).epsilon(1e-6));
}

TEST_CASE("borders that close, and several of them") {
  StudyBench bench;
  // Two circles, of radius 0.2 and 0.1.
  REQUIRE(bench
              .run("kind = \"map\"\n[map]\nvariables = [\"x\", \"y\"]\nexpression = \"min((x - 0.3)^2 + (y - 0.4)^2 - "
                   "0.04, (x - 0.75)^2 + (y - 0.75)^2 - 0.01)\"\n"
                   "[[variable]]\nname = \"x\"\nrange = [0, 1]\n[[variable]]\nname = \"y\"\nrange = [0, 1]\n")
              .code == 0);
  const auto borders = borders_of(bench);
  REQUIRE(borders.size() == 2);
  for (const auto& [name, points] : borders) {
    CHECK(points.front() == points.back());
    double length = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double large = std::hypot(points[i].first - 0.3, points[i].second - 0.4) - 0.2,
                   small = std::hypot(points[i].first - 0.75, points[i].second - 0.75) - 0.1;
      CHECK(std::min(std::abs(large), std::abs(small)) < 1e-8);
      if (i) length += std::hypot(points[i].first - points[i - 1].first, points[i].second - points[i - 1].second);
    }
    const double radius = length > 1.0 ? 0.2 : 0.1;
    CHECK(length == doctest::Approx(2.0 * std::acos(-1.0) * radius).epsilon(0.01)); // of chords
  }
}

TEST_CASE("a look that hits a zero hides none beside it") {
  const auto found = [](const std::string& expression) {
    StudyBench bench;
    (void)bench.run(critical(expression, 0, 1));
    std::vector<double> zeros;
    for (const study::Finding& f : bench.findings()) zeros.push_back(f.value);
    return zeros;
  };
  SUBCASE("0.2 is looked at, 0.21 is not") {
    const std::vector<double> zeros = found("(x - 0.2)*(x - 0.21)*(x - 0.7)");
    REQUIRE(zeros.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) CHECK(zeros[i] == doctest::Approx(std::array{0.2, 0.21, 0.7}[i]).epsilon(1e-8));
  }
  SUBCASE("two neighbouring looks that both hit one are no stretch of zeros; the runs before 0.05 have no value") {
    const std::vector<double> zeros = found("sqrt(x - 0.05)*(x - 0.1)");
    REQUIRE(zeros.size() == 2);
    CHECK(zeros[0] == doctest::Approx(0.05));
    CHECK(zeros[1] == doctest::Approx(0.1));
  }
  SUBCASE("a stretch of zeros is one") {
    StudyBench bench;
    CHECK(bench.run(critical("x < 0.3 ? 0 : x", 0, 1)).code == 5);
    CHECK(has(bench.find("critical", "critical value").status, "zero all over this interval"));
  }
}

// Zeros at 0.33 ± 3.2e-5: a thousandth of the distance of the looks apart.
TEST_CASE("where the response turns just behind zero both crossings are found, and just before it is told where") {
  StudyBench bench;
  REQUIRE(bench.run(critical("(x - 0.33)^2 - 1e-9", 0, 1)).code == 0);
  REQUIRE(bench.findings().size() == 2);
  CHECK(bench.findings()[0].value == doctest::Approx(0.33 - std::sqrt(1e-9)).epsilon(1e-7));
  CHECK(bench.findings()[1].value == doctest::Approx(0.33 + std::sqrt(1e-9)).epsilon(1e-7));
  StudyBench before;
  CHECK(before.run(critical("(x - 0.33)^2 + 1e-3", 0, 1)).code == 5);
  CHECK(has(before.find("critical", "critical value").status, "nearest to zero at 0.33"));
  CHECK(has(before.find("critical", "critical value").status, ", where it is 0.001"));
}

TEST_CASE("crossings as dense as the looks are not taken for all there are") {
  StudyBench bench;
  const Outcome outcome = bench.run(critical("sin(200*x)", 0, 1)); // has 64 zeros; 21 looks
  CHECK(outcome.code == 5);
  CHECK(has(outcome.out, "there may be more between them"));
  StudyBench fine;
  REQUIRE(fine.run("kind = \"critical\"\n[critical]\nvariable = \"x\"\nexpression = \"sin(200*x)\"\npoints = 401\n"
                   "[[variable]]\nname = \"x\"\nrange = [0, 1]\n")
              .code == 0);
  CHECK(fine.findings().size() == 64);
}

// An island between the lines of the grid, beside a border that they meet (at the very ends of the ranges, where it is
// begun): nothing but the way down to it tells of it.
TEST_CASE("an island that no line of the first look meets is found") {
  StudyBench bench;
  const Outcome outcome = bench.run("kind = \"map\"\n[map]\nvariables = [\"x\", \"y\"]\nexpression = "
                                    "\"min((x - 0.43)^2 + (y - 0.56)^2 - 0.0009, (x - 1)^2 + (y - 1)^2 - 0.04)\"\n"
                                    "[[variable]]\nname = \"x\"\nrange = [0, 1]\n[[variable]]\nname = \"y\"\nrange = [0, 1]\n");
  REQUIRE(outcome.code == 0);
  const auto borders = borders_of(bench);
  REQUIRE(borders.size() == 2);
  for (const auto& [x, y] : borders.at("border 1")) CHECK(std::hypot(x - 1.0, y - 1.0) == doctest::Approx(0.2).epsilon(1e-7));
  CHECK(borders.at("border 2").front() == borders.at("border 2").back());
  for (const auto& [x, y] : borders.at("border 2")) CHECK(std::hypot(x - 0.43, y - 0.56) == doctest::Approx(0.03).epsilon(1e-6));
}

TEST_CASE("a plain without a border is not searched hollow by hollow") {
  StudyBench bench;
  const Outcome outcome = bench.run("kind = \"map\"\n[map]\nvariables = [\"x\", \"y\"]\nexpression = \"1 + 0*x*y\"\n"
                                    "[[variable]]\nname = \"x\"\nrange = [0, 1]\n[[variable]]\nname = \"y\"\nrange = [0, 1]\n");
  CHECK(outcome.code == 5);
  CHECK(bench.find("map", "points").samples == 121);
}

// Islands in a plain, to which nothing points: those that are larger than what is said to be unseen are all found, at
// any place; of smaller ones some are not.
TEST_CASE("a map says which islands its looks cannot exclude") {
  int unseen = 0;
  for (int k = 0; k < 40; ++k) {
    const double spacing = 1.0 / 6.0, bound = spacing / std::sqrt(2.0), radius = k % 2 ? 1.01 * bound : 0.045;
    const double x = bound + (1.0 - 2.0 * bound) * std::fmod(0.618 * k, 1.0), y = bound + (1.0 - 2.0 * bound) * std::fmod(0.755 * k, 1.0);
    StudyBench bench;
    (void)bench.run("kind = \"map\"\n[map]\nvariables = [\"x\", \"y\"]\npoints = 7\nexpression = \"(x - " + std::to_string(x) +
                    ")^2 + (y - " + std::to_string(y) + ")^2 < " + std::to_string(radius) + "^2 ? -1 : 1\"\n" +
                    "[[variable]]\nname = \"x\"\nrange = [0, 1]\n[[variable]]\nname = \"y\"\nrange = [0, 1]\n");
    const study::Finding f = bench.find("map", "unseen radius, of the ranges");
    CHECK(f.value == doctest::Approx(bound));
    const bool is_seen = !borders_of(bench).empty() && borders_of(bench).begin()->first.starts_with("border 1");
    CAPTURE(x);
    CAPTURE(y);
    if (radius > f.value) CHECK(is_seen);
    unseen += !is_seen;
  }
  CHECK(unseen > 0);
}
