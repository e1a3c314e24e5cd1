// Elastic step-lap joints at a corner of the limit surface. Two overlaps 12 and 8 mm wide and 2.2 m apart that slide along x bear the
// same wrench wherever the centre of rotation is, as long as that lies beyond them; the square of their width over that distance
// rounds it, 5e-6. There the wrench does not tell the direction of slip, and the spring follows it at 1e7 to 1e10 1/s.
#include "elements/step_lap/patch/admissible_projection.h"
#include "elements/step_lap/step_lap_elastic.h"
#include "tests/elements/step_lap/step_lap_scene.h"

#include <doctest/doctest.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <numbers>

using namespace step_lap_scene;
using steplap::Mat3;
using steplap::Vec3;

namespace {

constexpr double k_capacity = 48e3; // N, of layouts/joint_apart.toml

Run pulled_apart(const std::string& stiffness, const std::string& integrator, const std::string& tolerance,
                 const std::string& step = "1e-3") {
  std::vector<std::string> overrides = {"simulation.integrator=" + integrator, "simulation.tolerance=" + tolerance, "output.step=" + step};
  if (!stiffness.empty()) overrides.push_back("element.joint.tangential_stiffness=" + stiffness);
  return run_file("layouts/joint_apart.toml", overrides);
}

using Row = std::array<double, 7>; // t, x, y, θ, and their rates

std::vector<Row> course(const Run& r) {
  std::vector<Row> rows(r.series("limb.x").size());
  const char* const names[] = {"limb.x", "limb.y", "limb.theta", "limb.vx", "limb.vy", "limb.omega"};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i][0] = r.result.trajectory->times()[i];
  for (int c = 0; c < 6; ++c) {
    const auto values = r.series(names[c]);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i][c + 1] = values[i];
  }
  return rows;
}

/// Where the limb has come as far along x: straight between rows.
Row at_place(const std::vector<Row>& rows, double x) {
  const auto after = std::find_if(rows.begin() + 1, rows.end(), [&](const Row& row) { return row[1] >= x; });
  REQUIRE(after != rows.end());
  const Row &a = *(after - 1), &b = *after;
  Row found;
  for (std::size_t i = 0; i < 7; ++i) found[i] = a[i] + (x - a[1]) / (b[1] - a[1]) * (b[i] - a[i]);
  return found;
}

std::string driven(const std::string& coordinate, double amplitude, double frequency) {
  return "[[signal]]\nname = \"path of " + coordinate + "\"\nkind = \"harmonics\"\namplitudes = [" + number(amplitude) +
         "]\nfrequencies = [" + number(frequency) + "]\nphases = [" + number(-0.5 * std::numbers::pi) +
         "]\n[[element]]\nkind = \"prescribed_motion\"\nname = \"drive " + coordinate + "\"\na = \"limb\"\ncoordinate = \"" + coordinate +
         "\"\nsignal = \"path of " + coordinate + "\"\nas = \"position\"\nzero = \"reference\"\n";
}

/// Does its direction of slip become a state, and cease to be one, while it slides?
bool changes_at_corners(const std::string& text) {
  const steplap::Model model = steplap::parse_model(text, "scene.toml", steplap::transformer_catalog());
  const auto system = steplap::compile(model);
  steplap::Simulation simulation(*system, system->initial_state(), steplap::options_of(model));
  bool becomes = false, ceases = false;
  std::uint32_t last = 0;
  while (simulation.advance()) {
    const steplap::State state = simulation.current_state();
    const std::uint32_t now = steplap::elastic_state(state.mode[0]);
    becomes = becomes || (last == steplap::k_elastic_yields && now == steplap::k_elastic_follows);
    ceases = ceases || (last == steplap::k_elastic_follows && now == steplap::k_elastic_yields);
    last = now;
  }
  return becomes && ceases;
}

} // namespace

TEST_CASE("a joint pulled apart at a corner takes no more steps the stiffer it is") {
  // Its direction of slip relaxes at K γ/(5e-6 F), a hundred times as fast at 1e9 as at 1e7 N/m: methods that follow that take
  // 1e5 steps and more. What is followed is the same slip, with some swings of the spring before it: √(K/m), ten times as many.
  long least = 0;
  for (const char* stiffness : {"1e7", "1e8", "1e9"})
    for (const char* integrator : {"auto", "rodas5p"}) {
      CAPTURE(stiffness);
      CAPTURE(integrator);
      const Run r = pulled_apart(stiffness, integrator, "1e-6");
      CHECK(r.times("joint", "slips").size() == 1);
      CHECK(r.times("joint", "sticks").empty()); // pulled by a quarter more than it can bear
      CHECK(r.times("joint", "loses an interface").size() == 1);
      CHECK(r.times("joint", "comes apart").size() == 1);
      CHECK(r.relative_energy_residual() < 1e-6); // the tolerance
      const long tries = r.result.statistics.steps + r.result.statistics.rejections;
      if (least == 0) least = tries;
      CHECK(tries < 3 * least);
      CHECK(tries < 600); // three phases, and their ends on the way down to 1e-8 s
    }
}

TEST_CASE("at a corner, too, stiffer and stiffer joints go the way of one that sticks exactly") {
  // Over the place x the motion differs by the spring's strain, which goes as 1/K; the time by the swing in which the force comes
  // up to the bound, which goes as 1/√K. Rows 1 µs apart: what is straight between them is off by a·(1 µs)²/8, 1e-10 of the motion.
  const std::vector<Row> rigid = course(pulled_apart("", "rodas5p", "1e-10", "1e-6"));
  const auto distance = [&](const char* stiffness) {
    const Row end = course(pulled_apart(stiffness, "rodas5p", "1e-8")).back();
    Row away = at_place(rigid, end[1]);
    for (std::size_t i = 0; i < 7; ++i) away[i] = std::abs(end[i] - away[i]);
    return away;
  };
  const Row soft = distance("1e11"), stiff = distance("1e12");
  CHECK(std::log10(soft[0] / stiff[0]) == doctest::Approx(0.5).epsilon(0.03));
  // y, θ, vx, ω; vy is 1e-6 m/s from the rigid one, where the tolerance leaves 1e-8.
  for (const std::size_t i : {2, 3, 4, 6}) CHECK(std::log10(soft[i] / stiff[i]) == doctest::Approx(1.0).epsilon(0.03));
  CHECK(stiff[3] < 1e-3 * rigid.back()[3]);
}

// Steps of return mapping look for the closest point of the limit surface and know no direction of slip. They are of the first
// order; extrapolated from two, what is left is of the second, as is what they lose where modes change within a step.
TEST_CASE("driven limbs at a corner, and in and out of one: implicit return mapping of small steps") {
  struct Path {
    double x, y, turn;    // amplitudes, m and rad
    double fx, fy, fturn; // Hz
    bool leaves;          // the corner while it slides, having come to it so
  };
  // Where the second one hardly moves along x its centre of rotation lies between the overlaps, and the surface is round.
  for (const Path& way : {Path{4e-3, 2e-6, 3e-4, 0.25, 0.8, 0.4, false}, Path{3e-3, 1e-5, 1.5e-3, 1.0, 0.5, 0.4, true}}) {
    CAPTURE(way.leaves);
    const std::string scene =
        header("end = 0.9\nintegrator = \"INTEGRATOR\"\ntolerance = 1e-8", 0.9) + body("limb", 1000.0, 700.0, {0.5, 0.0}) +
        joint("limb", "ground", "tangential_stiffness = 1e8") +
        interface(rectangle(0.0, 1.0, 0.3, 1.2), rectangle(0.288, 1.0, 0.6, 1.2), 1e5, 0.25, "count = 400", "top") +
        interface(rectangle(0.0, -1.2, 0.3, -1.0), rectangle(0.292, -1.2, 0.6, -1.0), 1e5, 0.25, "count = 600", "bottom") +
        driven("x", way.x, way.fx) + driven("y", way.y, way.fy) + driven("angle", way.turn, way.fturn);
    const auto path = [&](double t) {
      const double w = 2.0 * std::numbers::pi * t;
      return Vec3(way.x * std::sin(way.fx * w), way.y * std::sin(way.fy * w), way.turn * std::sin(way.fturn * w));
    };
    for (const char* integrator : {"auto", "rodas5p"}) {
      CAPTURE(integrator);
      std::string text = scene;
      text.replace(text.find("INTEGRATOR"), 10, integrator);
      const Run r = run_text(text);
      const auto* joint = dynamic_cast<const steplap::StepLapFriction*>(r.system->frictions[0].friction.get());
      REQUIRE(joint);
      const Mat3 compliance = joint->stiffness().inverse();
      const auto march = [&](int steps) {
        Vec3 p = Vec3::Zero();
        for (int i = 1; i <= steps; ++i) {
          const Vec3 s = path(0.9 * i / steps);
          const steplap::Patch patch = joint->patch_at({0.5 + p[0], p[1], p[2]}, steplap::GripLaw::holding);
          p = s + compliance * steplap::admissible_wrench(patch, compliance, Vec3(s - p)).wrench;
        }
        return p;
      };
      const Vec3 coarse = march(2000), fine = march(4000), expected = 2.0 * fine - coarse;
      const Vec3 found(r.last("joint.dx"), r.last("joint.dy"), -r.last("joint.theta_acc"));
      for (int c = 0; c < 3; ++c) CHECK(std::abs(found[c] - expected[c]) < 0.1 * (fine - coarse).norm());
      CHECK(r.last("joint.u") == doctest::Approx(1.0).epsilon(1e-8));
      CHECK(changes_at_corners(text) == way.leaves);
    }
  }
}
