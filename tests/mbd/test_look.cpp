// [[look]]: where the parts of a row are, and what makes no sense.
#include "mbd/io/look.h"
#include "mbd/io/reader.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

using namespace steplap;

namespace {

const char* const k_body = "[[body]]\nname = \"axle\"\nmass = 1\ninertia = 1\n";

Model read(const std::string& fields) {
  return parse_model(k_body + std::string("[[look]]\nname = \"wheels\"\nbody = \"axle\"\n") + fields, "m.toml", transformer_catalog());
}

std::string refusal(const std::string& fields) {
  try {
    static_cast<void>(read(fields));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& fields, const std::string& wanted) { return refusal(fields).find(wanted) != std::string::npos; }

} // namespace

TEST_CASE("a row of parts is about its middle, one pitch apart") {
  const Model model = read("draw = \"wheel\"\nat = [1, 2]\nradius = \"0.4 m\"\ncount = 4\npitch = 0.5\n");
  const std::vector<Vec2> places = places_of(static_cast<const Look&>(*model.tables.front().table));
  REQUIRE(places.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) CHECK(places[k] == Vec2(0.25 + 0.5 * static_cast<double>(k), 2.0)); // halves: exact
}

TEST_CASE("an unknown look is refused with the list of those that are known") {
  CHECK(says("draw = \"propeller\"\n", "'wheel', 'winding', 'wood', 'foot', 'tank', 'road', 'rail'"));
}

TEST_CASE("a look needs the size of its kind, and takes no other") {
  CHECK(says("draw = \"wheel\"\n", "look 'wheels': draw = \"wheel\" needs 'radius'"));
  CHECK(says("draw = \"winding\"\n", "needs 'size'"));
  CHECK(says("draw = \"foot\"\nsize = [0.1, 0]\n", "width and height must be positive"));
  CHECK(says("draw = \"wheel\"\nradius = 1\nwall = 0.1\n", "'wall' does not go with draw = \"wheel\""));
  CHECK(says("draw = \"wheel\"\nradius = 1\noil = 0.1\n", "'oil' does not go with"));
  CHECK(says("draw = \"wheel\"\nradius = 1\ncount = 2\n", "'count' above 1 and 'pitch' go together"));
  CHECK(says("draw = \"wheel\"\nradius = 1\npitch = 2\n", "'count' above 1 and 'pitch' go together"));
  CHECK(says("draw = \"tank\"\nwall = 0.1\n", "give 'axle' an 'outline'"));
}
