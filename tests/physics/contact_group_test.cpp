// [[contacts]]: the run of a group is that of its pairs, and wrong groups are refused.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

// Three boxes that fall on each other and on the ground beside a wall, and a plate without outline.
const std::string k_boxes = [] {
  const std::string square = "mass = 100; inertia = 4; outline = [[-0.25, -0.2], [0.25, -0.2], [0.25, 0.2], [-0.25, 0.2]]; position = ";
  return body("box 1", square + "[0.0, 0.21]") + body("box 2", square + "[0.1, 0.63]") + body("box 3", square + "[0.3, 1.1]; angle = 0.3") +
         body("plate", "mass = 1; inertia = 1; position = [9.0, 9.0]") +
         table_text("marker", "name = \"wall\"\n", "body = 'ground'; at = [-0.3, 0.0]");
}();
const std::string k_law = "stiffness = 1e7; dissipation = 2.0; static_friction = 0.4; kinetic_friction = 0.3";

std::string group(const std::string& name, const std::string& fields) {
  return table_text("contacts", "name = \"" + name + "\"\n", fields + "; " + k_law);
}
std::string pair(const std::string& name, const std::string& a, const std::string& b, const std::string& more = "") {
  return element("polygon_contact", name + "." + a + " on " + b, "a = \"" + a + "\"; b = \"" + b + "\"; " + k_law + more);
}

std::string refusal(const std::string& text) {
  try {
    (void)scene(text + "\n[simulation]\nstep = 1e-3\n");
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("a group moves as its pairs listed one by one, to the last bit") {
  const std::string listed =
      pair("pile", "box 1", "ground") + pair("pile", "box 2", "ground") + pair("pile", "box 2", "box 1") + pair("pile", "box 3", "ground") +
      pair("pile", "box 3", "box 1") + pair("pile", "box 3", "box 2") + pair("side", "box 1", "wall", "; normal = [1.0, 0.0]") +
      pair("side", "box 2", "wall", "; normal = [1.0, 0.0]") + pair("side", "box 3", "wall", "; normal = [1.0, 0.0]");
  const std::string grouped = group("pile", "a = [\"box *\"]; b = [\"ground\", \"box *\"]") +
                              group("side", "a = [\"box ?\", \"box 1\"]; b = [\"wall\"]; normal = [1.0, 0.0]");
  const Settings settings{"dop853", 1e-9, 1.0, 0.05};
  const Run one = run(k_boxes + listed, settings), other = run(k_boxes + grouped, settings);
  REQUIRE(one.result.events.size() > 10); // they do fall and slide
  CHECK(one.result.events.size() == other.result.events.size());
  for (const char* channel :
       {"box 1.x", "box 2.y", "box 3.theta", "pile.box 2 on box 1.force", "pile.box 3 on ground.gap", "side.box 3 on wall.gap"})
    CHECK(one.series(channel) == other.series(channel));
}

TEST_CASE("wrong groups are refused, each with one error that says what to do") {
  struct Wrong {
    std::string fields, message;
  };
  const Wrong all[] = {
      {"a = [\"bix *\"]; b = [\"ground\"]", "'bix *' names no body"}, {"a = [\"box *\"]; b = [\"wail\"]", "'wail' names no body"},
      {"a = [\"box 1\"]; b = [\"box 1\"]", "the same single body"},   {"a = [\"*\"]; b = [\"ground\"]", "'plate' has no outline"},
      {"a = [\"box *\"]; b = [\"plate\"]", "'plate' has no outline"}, {"b = [\"ground\"]", "needs 'a'"},
  };
  for (const Wrong& wrong : all) {
    CAPTURE(wrong.fields);
    const std::string text = refusal(k_boxes + group("pile", wrong.fields));
    CHECK(text.find(wrong.message) != std::string::npos);
    CHECK(text.find('\n') == std::string::npos);
  }
  CHECK(refusal(k_boxes + table_text("contacts", "name = \"pile\"\n", "a = ['box *']; b = ['ground']; stiffness = 1; kinetic_friction = 1"))
            .find("'kinetic_friction' needs 'static_friction'") != std::string::npos);
}
