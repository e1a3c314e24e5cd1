// Poses given by joint angles: forward kinematics, and the same motion as from the poses themselves.
#include "tests/physics/scene.h"

#include "mbd/rest/assembly.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <sstream>

using namespace steplap;
using namespace steplap::testing;

namespace {

// Sums of a few terms of metres and radians, and a mechanism's closure given with 16 digits.
constexpr double k_rounding = 1e-12;

std::string text_of_model(const std::string& name) {
  std::ifstream file(std::string(STEPLAP_MODELS) + "/benchmarks/" + name + ".toml");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Model with(const std::string& text, const std::vector<std::string>& settings) {
  return parse_model(text, "scene.toml", transformer_catalog(), settings);
}

void check_same_start(const Model& model, const Model& other) {
  REQUIRE(model.bodies.size() == other.bodies.size());
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const Body &b = model.bodies[i], &c = other.bodies[i];
    CAPTURE(b.name);
    CHECK((b.reference_pose() - c.reference_pose()).norm() < k_rounding);
    CHECK((b.velocity - c.velocity).norm() < k_rounding);
    CHECK(std::abs(b.angular_velocity - c.angular_velocity) < k_rounding);
  }
}

std::string number(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

// Without the lines that give a pose.
std::string without_poses(const std::string& text) {
  std::istringstream lines(text);
  std::string bare;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("position = ") && !line.starts_with("angle = ")) bare += line + "\n";
  return bare;
}

} // namespace

TEST_CASE("Andrews' squeezer by its seven angles is where its poses put it") {
  for (const char* name : {"andrews", "andrews_a03"}) {
    CAPTURE(name);
    const std::string text = text_of_model(name);
    const Model posed = with(text, {});
    const auto angle = [&posed](const char* body) { return posed.find_body(body)->angle; };
    const auto set = [](const std::string& pin, double value) { return "element." + pin + ".angle=" + number(value); };
    const std::string bare = without_poses(text);
    const Model turned =
        with(bare, {set("O", angle("K1")), set("F", angle("K2") - angle("K1")), set("B", angle("K3")), set("A of K5", angle("K5")),
                    set("A of K7", angle("K7")), set("G", angle("K4") - angle("K5")), set("H", angle("K6") - angle("K7"))});
    check_same_start(turned, posed);
    // The three pins left over close the loops: nothing to do but rounding.
    const auto system = compile(turned);
    CHECK(assembly_moves(system->initial_state(), assemble(turned, *system), k_rounding).empty());
  }
}

TEST_CASE("forward kinematics of an arm, poses and velocities") {
  const Model model = with(text_of_model("robot_arm"), {});
  const double first = 70.0 * M_PI / 180.0, second = first - 110.0 * M_PI / 180.0;
  const double w1 = -0.5, w2 = 0.7, length = 0.65, speed = 0.3;
  const Body &forearm = *model.find_body("forearm"), &telescope = *model.find_body("telescope");
  const Vec2 elbow(std::cos(first), 1.2 + std::sin(first));
  const Vec2 elbow_velocity = w1 * Vec2(-std::sin(first), std::cos(first));
  const Vec2 along(std::cos(second), std::sin(second)), across(-along.y(), along.x());
  CHECK((forearm.position - elbow).norm() < k_rounding);
  CHECK(std::abs(forearm.angle - second) < k_rounding);
  CHECK((forearm.velocity - (elbow_velocity + 0.4 * w2 * across)).norm() < k_rounding);
  CHECK((telescope.position - (elbow + length * along)).norm() < k_rounding);
  CHECK((telescope.velocity - (elbow_velocity + (length + 0.25) * w2 * across + speed * along)).norm() < k_rounding);
  CHECK(std::abs(telescope.angular_velocity - w2) < k_rounding);
  const auto system = compile(model);
  CHECK(assembly_moves(system->initial_state(), assemble(model, *system), k_rounding).empty());
}

TEST_CASE("joints place bodies in either direction, in any order, with turned markers") {
  // From a body in the middle of a chain, outwards: b of "inner" and a of "outer" follow from "middle".
  const std::string chain = R"(
[[body]]
name = "last"
mass = 1.0
inertia = 0.1
cg = [0.2, 0.1]
[[body]]
name = "first"
mass = 1.0
inertia = 0.1
cg = [-0.3, 0.0]
[[body]]
name = "middle"
mass = 1.0
inertia = 0.1
position = [3.0, -1.0]
angle = 0.4
cg = [0.1, -0.1]
velocity = [2.0, 1.0]
angular_velocity = -3.0
[[element]]
kind = "prismatic"
name = "outer"
a = { body = "last", point = [0.0, 0.3], angle = 0.2 }
b = { body = "middle", point = [0.5, 0.0], angle = -0.7 }
axis = [3.0, 4.0]
displacement = 2.5
angle = 0.3
speed = -0.5
[[element]]
kind = "revolute"
name = "inner"
a = { body = "middle", point = [-0.5, 0.2], angle = 0.1 }
b = { body = "first", point = [0.7, 0.0], angle = 0.9 }
angle = 1.1
angular_velocity = 0.6
)";
  const Model model = with(chain, {});
  const auto system = compile(model);
  const State state = system->initial_state();
  // What a prismatic joint's multiplier directions see: the marker's place in b's marker, before any assembly.
  const auto frame = [&](int body, const Vec2& point, double angle) {
    const double* q = &state.q[3 * body];
    const double* v = &state.v[3 * body];
    const Body& b = model.bodies[body - 1];
    const Vec2 lever = rotated(point - b.cg, q[2]);
    struct {
      Vec2 p;
      double angle;
      Vec2 v;
      double w;
    } f{Vec2(q[0], q[1]) + lever, q[2] + angle, Vec2(v[0] - v[2] * lever.y(), v[1] + v[2] * lever.x()), v[2]};
    return f;
  };
  const auto slide_a = frame(1, {0.0, 0.3}, 0.2), slide_b = frame(3, {0.5, 0.0}, -0.7);
  const Vec2 reach = slide_a.p - slide_b.p;
  CHECK((rotated(reach, -slide_b.angle) - 2.5 * Vec2(0.6, 0.8)).norm() < k_rounding);
  CHECK(std::abs(slide_a.angle - slide_b.angle - 0.3) < k_rounding);
  const Vec2 carried = slide_b.v + slide_b.w * Vec2(-reach.y(), reach.x());
  CHECK((rotated(slide_a.v - carried, -slide_b.angle) + 0.5 * Vec2(0.6, 0.8)).norm() < k_rounding);
  CHECK(std::abs(slide_a.w - slide_b.w) < k_rounding);
  const auto pin_a = frame(3, {-0.5, 0.2}, 0.1), pin_b = frame(2, {0.7, 0.0}, 0.9);
  CHECK((pin_a.p - pin_b.p).norm() < k_rounding);
  CHECK((pin_a.v - pin_b.v).norm() < k_rounding);
  CHECK(std::abs(pin_a.angle - pin_b.angle - 1.1) < k_rounding);
  CHECK(std::abs(pin_a.w - pin_b.w - 0.6) < k_rounding);
  CHECK(assembly_moves(state, assemble(model, *system), k_rounding).empty());
}

TEST_CASE("a weld that gives its angle sets marker on marker") {
  const Model model = with(R"(
[[body]]
name = "tool"
mass = 1.0
inertia = 0.1
[[body]]
name = "flange"
mass = 1.0
inertia = 0.1
position = [1.0, 2.0]
angle = 0.3
[[element]]
kind = "weld"
name = "bolts"
a = { body = "tool", point = [0.0, -0.1] }
b = { body = "flange", point = [0.2, 0.0] }
angle = "90 deg"
)",
                           {});
  const Body& tool = *model.find_body("tool");
  CHECK(std::abs(tool.angle - 0.3 - 0.5 * M_PI) < k_rounding);
  CHECK((tool.position + rotated(Vec2(0.0, -0.1), tool.angle) - (Vec2(1.0, 2.0) + rotated(Vec2(0.2, 0.0), 0.3))).norm() < k_rounding);
}

TEST_CASE("markers given by 'at' on a body that others place, and bodies left alone") {
  const Model model = with(R"(
[[body]]
name = "base"
mass = 1.0
inertia = 0.1
position = [1.0, 0.0]
[[body]]
name = "arm"
mass = 1.0
inertia = 0.1
[[body]]
name = "by itself"
mass = 1.0
inertia = 0.1
[[element]]
kind = "revolute"
name = "pin"
a = { body = "arm", point = [-1.0, 0.0] }
b = { body = "base", at = [1.0, 0.5] }
angle = "-90 deg"
)",
                           {});
  CHECK((model.find_body("arm")->position - Vec2(1.0, -0.5)).norm() < k_rounding);
  CHECK(model.find_body("by itself")->position.norm() == 0.0);
}
