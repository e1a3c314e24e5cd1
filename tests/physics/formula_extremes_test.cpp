// Extremes of formulas with kinks and narrow peaks at random places, whose extremes are known in closed form: by every method, at
// several tolerances, none may be lost, and what cannot be known is said not to be.
#include "tests/physics/formula_peaks.h"

#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

TEST_CASE("peaks and kinks of formulas are found, whatever the method, its tolerance and their width") {
  const std::vector<Settings> methods = {{"dop853", 1e-5, 1.0}, {"dop853", 1e-11, 1.0}, {"tsit5", 1e-7, 1.0}, {"rodas5p", 1e-6, 1.0},
                                         {"auto", 1e-4, 1.0},   {"auto", 1e-9, 1.0},    {"rk4", 1e-2, 1.0},   {"moreau", 1e-3, 1.0}};
  PeakTally tally;
  for (std::size_t i = 0; i < methods.size(); ++i)
    for (int seed = 0; seed < 4; ++seed) tally.add(methods[i], 100 * i + static_cast<std::size_t>(seed));
  CHECK(tally.count >= 380);
  CHECK_MESSAGE(tally.wrong.empty(), tally.wrong.size() << " of " << tally.count << ", the first: " << tally.wrong.front());
  CHECK_MESSAGE(tally.unsure.empty(), tally.unsure.size() << " of " << tally.count << ", the first: " << tally.unsure.front());
}

TEST_CASE("an extreme that no bound can be closed to is said to be unknown") {
  // A pole passed inside a step, and one whose sign does not change; a value that holds at one instant only.
  for (const char* expression :
       {"1 / (b.x / '1 m' - 0.5123)", "1 / (b.x / '1 m' - 0.5123)^2", "b.x == '0.5123 m' ? 1 : 0", "tan(b.x / '1 m' * 5)"}) {
    CAPTURE(expression);
    for (const char* method : {"dop853", "rk4", "moreau"}) {
      CAPTURE(method);
      const PeakRun r(moving(1.0) + channel("it", expression), {method, std::string(method) == "dop853" ? 1e-8 : 1e-2, 1.0});
      CHECK(r.range("it").resolution >= 1.0);
    }
  }
  // Infinite only in what it is divided by: that is known.
  const PeakRun r(moving(1.0) + channel("it", "min(3, 1 / abs(b.x / '1 m' - 0.5123))"), {"dop853", 1e-8, 1.0});
  CHECK(r.range("it").high.value == 3.0);
  CHECK(r.range("it").resolution < 1e-5);
}

TEST_CASE("a formula that has no value for a short while inside a step is said to have none") {
  const PeakRun r(moving(1.0) + channel("it", "sqrt(abs(b.x / '1 m' - 0.5123) - 1e-5)") + channel("all", "sqrt(abs(b.x / '1 m' - 0.5123))"),
                  {"dop853", 1e-6, 1.0});
  CHECK(r.range("it").had_no_value);
  CHECK(!r.range("all").had_no_value);
}

TEST_CASE("a formula passes 1 the first time at its first peak") {
  const PeakRun r(moving(1.0) + channel("it", "2 * exp(-(1e4 * (b.x / '1 m' - 0.2))^2) + 3 * exp(-(1e4 * (b.x / '1 m' - 0.7))^2)"),
                  {"dop853", 1e-6, 1.0});
  REQUIRE(r.range("it").first_above_one);
  const double first = 0.2 - std::sqrt(std::log(2.0)) * 1e-4;
  CHECK(std::abs(*r.range("it").first_above_one - first) < 1e-9);
}

TEST_CASE("formulas of formulas are one formula") {
  std::string text = moving(1.0) + channel("f0", "max(0, 1 - 1e5 * abs(b.x / '1 m' - 0.5123))") + channel("f1", "f0 * f0");
  for (int i = 2; i < 40; ++i) { // each uses two before: written out they would be 2^20 times as long
    const std::string one = "f" + std::to_string(i - 1), two = "f" + std::to_string(i - 2);
    text += channel("f" + std::to_string(i), "sqrt(" + one + " * " + two + ")");
  }
  const PeakRun r(text, {"dop853", 1e-6, 1.0});
  for (const ChannelRange& range : r.result.ranges)
    if (range.channel->name.starts_with("f")) {
      CAPTURE(range.channel->name);
      CHECK(std::abs(range.high.value - 1.0) < 2e-6);
      CHECK(range.resolution < 1e-5);
    }
}
