// Actions that set lists: forces with two components, tables of a spring. Against closed forms and against actions that set numbers.
#include "mbd/model/action.h"
#include "tests/physics/rest_scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string action(const std::string& fields) { return table_text("action", "name = \"change\"\n", fields); }

const std::string k_block = k_no_gravity + body("block", "mass = 2.0; inertia = 1.0; velocity = [1.0, 0.0]");

} // namespace

TEST_CASE("a force whose two components an action sets moves a body by parabolas") {
  for (const std::string value : {"[-6, 1.5]", "['-6 N', 1.5 N]", "[-6000 mN, 0.0015 kN,]"}) {
    CAPTURE(value);
    const Run r = run(k_block + element("load", "push", "at = \"block\"; force = [3.0, 0.0]") +
                          action("when = \"1 s\"; do = [\"set push.force = " + value + "\"]"),
                      {"dop853", 1e-12, 2.0});
    // 1.5 m/s² from 1 m/s, then −3 and 0.75 m/s² for a second.
    CHECK(std::abs(r.last("block.x") - (1.75 + 2.5 - 1.5)) < 1e-12);
    CHECK(std::abs(r.last("block.y") - 0.375) < 1e-12);
    CHECK(std::abs(r.last("block.vx") - (2.5 - 3.0)) < 1e-12);
  }
}

TEST_CASE("a spring whose table an action makes twice as steep goes on as one whose stiffness it doubles") {
  const auto moved = [](const std::string& spring, const std::string& value) {
    return run(k_block + element("spring_damper", "spring", "a = \"block\"; axis = [1.0, 0.0]; " + spring) +
                   action("when = \"0.2 s\"; do = [\"set spring." + value + "\"]") + "[output]\nalso = ['whole.*']\n",
               {"dop853", 1e-12, 1.0});
  };
  const Run table =
      moved("force_table = [[-1.0, -50.0], [0.0, 0.0], [1.0, 50.0]]", "force_table = [[-1 m, -0.1 kN], [0, 0], [100 cm, 100]]");
  const Run number = moved("stiffness = 50.0", "stiffness = 100");
  // x = sin(5 t)/5 to 0.2 s, then with √50.
  const double x = std::sin(1.0) / 5.0, v = std::cos(1.0), omega = std::sqrt(50.0);
  const double end = x * std::cos(0.8 * omega) + v / omega * std::sin(0.8 * omega);
  for (const Run* r : {&table, &number}) {
    CHECK(std::abs(r->last("block.x") - end) < 1e-10);
    CHECK(std::abs(r->last("whole.work") - 0.5 * 50.0 * x * x) < 1e-10); // what it stores more
  }
}

TEST_CASE("lists that are none, of other units, or that the element refuses are told before the run") {
  const auto complaint = [](const std::string& step) {
    try {
      (void)compile(scene(k_block + element("load", "push", "at = \"block\"; force = [3.0, 0.0]") +
                          element("spring_damper", "spring", "a = \"block\"; axis = [1.0, 0.0]; force_table = [[-1, -50], [1, 50]]") +
                          action("when = \"1 s\"; do = [\"" + step + "\"]") + k_head));
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto says = [&](const std::string& step, const std::string& part) {
    const std::string found = complaint(step);
    CHECK_MESSAGE(found.find(part) != std::string::npos, found);
  };
  CHECK(complaint("set push.force = [1, 2]") == "nothing");
  says("set push.force = 3", "'push.force' cannot be '3': write a list, as [1, 2]");
  says("set push.force = [1, 2, 3]", "write a list, as [1, 2]");
  says("set push.force = [1, [2]", "write a list, as [1, 2]");
  says("set push.force = [1 m, 2]", "'push.force'");
  says("set push.force = [1, nan]", "'push.force'");
  says("set spring.force_table = [1, 2]", "write a list, as [[0, 0], [1, 2]]");
  says("set spring.force_table = [[1, 50], [-1, -50]]", "with that, ");
  says("set spring.force_table = [[0, 0]]", "with that, ");
  says("set spring.a = block", "cannot be set: only numbers, lists of them and signals can");
  CHECK(is_name_in_step("slow"));
  CHECK_FALSE(is_name_in_step("[1, 2]")); // a part puts its own name before names alone
}
