// Files of criteria: the presets are sound, and what is wrong in a user's file is told with its place.
#include "driven_scene.h"

#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::assess;

namespace {

Location place_of(const std::string& text) {
  try {
    static_cast<void>(parse_criteria(text, "mine.toml"));
  } catch (const ModelError& error) {
    return error.diagnostics().front().where;
  }
  return {};
}

const std::string k_head = "name = \"mine\"\n[[criterion]]\nname = \"a\"\n";

} // namespace

TEST_CASE("presets can be read, and each of their criteria has a source and a test that would show the damage") {
  REQUIRE(criteria_presets().size() >= 3);
  for (const CriteriaPreset& preset : criteria_presets()) {
    const DecisionCriteria criteria = read_criteria(preset.name);
    CHECK(!criteria.source.empty());
    CHECK(!criteria.criteria.empty());
    for (const DecisionCriterion& c : criteria.criteria) {
      CHECK_MESSAGE(!c.source.empty(), preset.name << ": " << c.name);
      CHECK_MESSAGE(!c.tests.empty(), preset.name << ": " << c.name);
    }
  }
  CHECK(*read_criteria("acceptance-3g").criteria.front().at_most == doctest::Approx(3.0 * 9.80665));
}

TEST_CASE("what is wrong in a file of criteria is told with line and column") {
  CHECK(place_of(k_head + "quantity = \"peek\"\nat_most = 3\n").line == 4);
  CHECK(place_of(k_head + "quantity = \"peak\"\n").line == 2);                     // no limit
  CHECK(place_of(k_head + "quantity = \"peak\"\nat_most = \"3 kg\"\n").line == 5); // not an acceleration
  CHECK(place_of(k_head + "quantity = \"peak\"\nat_most = -1\n").line == 5);
  CHECK(place_of(k_head + "quantity = \"slip\"\nat_most = 1\n").line == 5); // takes no limit
  CHECK(place_of(k_head + "quantity = \"margin\"\nat_least = 1.2\naxis = \"x\"\n").line == 6);
  CHECK(place_of(k_head + "quantity = \"slip\"\noutcome = \"energise\"\n").line == 5);
  CHECK(place_of(k_head + "quantity = \"slip\"\nseverity = 3\n").line == 5);
  CHECK(place_of("name = \"mine\"\n").file == "mine.toml");    // nothing is asked
  CHECK(place_of(k_head + "quantity = \"slip\"\n").line == 0); // all is well
  CHECK_THROWS_AS(static_cast<void>(read_criteria("acceptance-3G")), FileError);
}
