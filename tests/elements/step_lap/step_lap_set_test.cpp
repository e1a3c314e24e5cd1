// What an action sets of an elastic joint while it slides, at a corner of its limit surface: a force that a spring bears does not jump, whoever is
// told of more or less friction, and what has come apart stays so.
#include "tests/elements/step_lap/step_lap_scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace step_lap_scene;

namespace {

// A limb of 1 t on two overlaps 2.2 m apart, 12 and 8 mm wide as in layouts/joint_apart.toml, or 10 mm each, pulled to and fro.
std::string scene(bool is_even, const std::string& integrator, double amplitude, double stiffness, double loss, const std::string& action,
                  const std::string& more = "", double end = 0.022) {
  const double upper = is_even ? 0.29 : 0.288, lower = is_even ? 0.29 : 0.292;
  return header("end = " + number(end) + "\nintegrator = \"" + integrator + "\"\ntolerance = 1e-8\n", 1e-5) +
         "[[body]]\nname = \"yokes\"\nfixed = true\n" + body("limb", 1000.0, 700.0, {0.5, 0.0}) +
         joint("limb", "yokes", "tangential_stiffness = " + number(stiffness) + "\npressure_loss = " + number(loss) + "\n" + more) +
         interface(rectangle(0.0, 1.0, 0.3, 1.2), rectangle(upper, 1.0, 0.6, 1.2), 1e5, 0.25, is_even ? "count = 500" : "count = 400",
                   "top") +
         interface(rectangle(0.0, -1.2, 0.3, -1.0), rectangle(lower, -1.2, 0.6, -1.0), 1e5, 0.25, is_even ? "count = 500" : "count = 600",
                   "bottom") +
         "[[signal]]\nname = \"pull\"\nkind = \"harmonics\"\namplitudes = [" + number(amplitude) +
         "]\nfrequencies = [50.0]\nphases = [-1.5707963267948966]\n[[element]]\nkind = \"load\"\nname = \"load\"\nat = \"limb\"\nforce_x = "
         "\"pull\"\n[[action]]\nname = \"act\"\n" +
         action;
}

// The limb is pulled back and forth at some centimetres a second: in 10 µs the spring of 1e9 N/m changes by some hundred newtons.
constexpr double k_continuous = 1500.0; // N between two rows

double largest_jump(const Run& r) {
  const auto force = r.series("joint.fx");
  double jump = 0.0;
  for (std::size_t i = 1; i < force.size(); ++i) jump = std::max(jump, std::abs(force[i] - force[i - 1]));
  return jump;
}

} // namespace

TEST_CASE("more friction told of a joint that slides holds it from there on; its interfaces may be told as well as the joint") {
  // A loss of 0.001 instead of 0.3 makes all bounds 0.999/0.7 times as large, and so does that much more friction.
  const std::string by_joint = "when = \"4 ms\"\ndo = [\"set joint.pressure_loss = 0.001\"]\n";
  const std::string more = number(0.25 * 0.999 / 0.7);
  const std::string by_parts =
      "when = \"4 ms\"\ndo = [\"set top.static_friction = " + more + "\", \"set bottom.static_friction = " + more + "\"]\n";
  for (const char* integrator : {"auto", "rodas5p"}) {
    CAPTURE(integrator);
    const Run joint_told = run_text(scene(false, integrator, 60e3, 1e9, 0.3, by_joint)),
              parts_told = run_text(scene(false, integrator, 60e3, 1e9, 0.3, by_parts));
    CHECK(largest_jump(joint_told) < k_continuous);
    CHECK(largest_jump(parts_told) < k_continuous); // 14 kN where the bound pulled the spring after it
    for (const char* channel : {"limb.x", "joint.dx"})
      CHECK(std::abs(joint_told.last(channel) - parts_told.last(channel)) < 1e-8); // both at 1e-8 of metres
    CHECK(parts_told.relative_energy_residual() < 1e-6);
  }
}

TEST_CASE("a direction of slip of before an action is not that of the slip after it") {
  // What is set at 12 ms holds the joint, which slides the other way at 13 ms.
  const std::string action = "when = \"12 ms\"\ndo = [\"set joint.pressure_loss = 0.001\"]\n";
  const Run implicit = run_text(scene(true, "rodas5p", 60e3, 1e9, 0.3, action)),
            automatic = run_text(scene(true, "auto", 60e3, 1e9, 0.3, action));
  CHECK(largest_jump(implicit) < k_continuous); // 84 kN, from one end of the limit surface to the other
  CHECK(std::abs(implicit.last("limb.x") - automatic.last("limb.x")) < 1e-8);
}

TEST_CASE("a joint that is told of less pressure while it slides slides on, and one that has come apart stays so") {
  const std::string apart = "on_apart = \"continue\"\n";
  for (const double t : {0.016, 0.1}) {
    CAPTURE(t);
    const Run r = run_text(
        scene(false, "auto", 200e3, 1e8, 1e-4, "when = \"" + number(t) + " s\"\ndo = [\"set joint.pressure_loss = 0.1\"]\n", apart, 0.15));
    CHECK(r.times("joint", "comes apart").size() == 1);
    CHECK(r.result.final_state.t == doctest::Approx(0.15));
    CHECK(r.last("joint.fx") == 0.0);
  }
}
