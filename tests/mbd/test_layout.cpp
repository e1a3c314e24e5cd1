// What a layout makes of a scene: bodies merged, coordinates locked, rows that remain.
#include "mbd/dynamics/layout.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string bodies(int count) {
  std::string text = "[simulation]\nstep = 1e-3\n";
  for (int i = 0; i < count; ++i)
    text += "[[body]]\nname = \"" + std::string(1, static_cast<char>('a' + i)) + "\"\nmass = " + std::to_string(i + 1) +
            ".0\ninertia = 0.5\nposition = [" + std::to_string(i) + ".0, 0.0]\n";
  return text;
}

std::string joint(const std::string& kind, const std::string& a, const std::string& b) {
  return "[[element]]\nkind = \"" + kind + "\"\nname = \"" + kind + " " + a + b + "\"\na = \"" + a + "\"\nb = \"" + b + "\"\n";
}

std::string drive(const std::string& body, const std::string& coordinate) {
  return "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive " + body + coordinate + "\"\na = \"" + body + "\"\ncoordinate = \"" +
         coordinate + "\"\nsignal = \"still\"\n";
}
const char* k_still = "[[signal]]\nname = \"still\"\nkind = \"constant\"\nvalue = 0.0\n";

struct CompiledLayout {
  std::unique_ptr<System> system;
  Layout layout;
};

CompiledLayout make(const std::string& text) {
  CompiledLayout made;
  made.system = compile(scene(text));
  made.layout = make_layout(*made.system, made.system->initial_state());
  return made;
}

} // namespace

TEST_CASE("welded bodies become one cluster about their common centre") {
  const CompiledLayout m = make(bodies(3) + joint("weld", "a", "b") + joint("weld", "c", "b"));
  REQUIRE(m.layout.cluster_count() == 1);
  CHECK(m.layout.active.empty());
  const Cluster& k = m.layout.clusters[0];
  CHECK(k.mass == doctest::Approx(6.0).epsilon(1e-15));
  // Centre at (0·1 + 1·2 + 2·3)/6 = 4/3; Steiner's rule.
  CHECK(k.inertia == doctest::Approx(1.5 + 16.0 / 9 + 2.0 / 9 + 3.0 * 4.0 / 9).epsilon(1e-14));
  CHECK(m.layout.placements[1].offset.x() == doctest::Approx(-4.0 / 3).epsilon(1e-14));
  CHECK(m.layout.edges.size() == 2);
}

TEST_CASE("a loop of welds leaves one redundant block, a weld to the ground stays rows") {
  const CompiledLayout loop = make(bodies(3) + joint("weld", "a", "b") + joint("weld", "b", "c") + joint("weld", "c", "a"));
  CHECK(loop.layout.cluster_count() == 1);
  CHECK(loop.layout.redundant_blocks.size() == 1);
  CHECK(loop.layout.active.empty());
  const CompiledLayout grounded = make(bodies(2) + joint("weld", "a", "b") + joint("weld", "a", "ground"));
  CHECK(grounded.layout.cluster_count() == 1);
  CHECK(grounded.layout.active.size() == 3);
}

TEST_CASE("a driven coordinate of a body alone is locked; of a merged body, or driven twice, it is a row") {
  const CompiledLayout locked = make(bodies(2) + k_still + drive("a", "x") + drive("a", "angle"));
  CHECK(locked.layout.locks.size() == 2);
  CHECK(locked.layout.active.empty());
  CHECK(locked.layout.clusters[0].w[0] == 0.0);
  CHECK(locked.layout.clusters[0].w[1] > 0.0);
  CHECK(locked.layout.clusters[0].w[2] == 0.0);
  CHECK(locked.layout.driven_rows.empty());
  const CompiledLayout merged = make(bodies(2) + k_still + joint("weld", "a", "b") + drive("a", "x"));
  CHECK(merged.layout.locks.empty());
  CHECK(merged.layout.active.size() == 1);
  CHECK(merged.layout.driven_rows.size() == 1);
}

TEST_CASE("fixed bodies vanish, joints to them are joints to the ground") {
  const CompiledLayout m =
      make(bodies(1) + "[[body]]\nname = \"wall\"\nfixed = true\nposition = [5.0, 1.0]\n" + joint("distance", "a", "wall"));
  CHECK(m.system->body_count() == 2); // the ground and a
  CHECK(m.layout.cluster_count() == 1);
  CHECK(m.layout.active.size() == 1);
}

TEST_CASE("redundant joints still move right: a body on two coaxial rails") {
  // Prismatic twice between the same bodies: the second adds no equation; the fall along the rail is free.
  const std::string rail = "[[element]]\nkind = \"prismatic\"\nb = \"ground\"\naxis = [0.0, 1.0]\n";
  const Run r = run(scene(bodies(1) + rail + "name = \"one\"\na = { body = \"a\", at = [0.0, 1.0] }\n" + rail +
                          "name = \"two\"\na = { body = \"a\", at = [0.0, -1.0] }\n"),
                    {"rk4", 1e-2, 1.0});
  CHECK(r.last("a.y") == doctest::Approx(-4.905).epsilon(1e-13));
  CHECK(std::abs(r.last("a.x")) < 1e-12);
}
