// What a run is said to have done to each step-lap joint, against its events and its channels.
#include "elements/step_lap/step_lap_assessment.h"
#include "elements/step_lap/step_lap_joint.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/extremes.h"
#include "mbd/simulation/simulation.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;

namespace {

struct Assessed {
  Model model;
  std::unique_ptr<System> system;
  RunResult result;
  std::vector<JointAssessment> joints;
};

Assessed assess(const std::string& file, const char* mode, const std::vector<std::string>& overrides) {
  Assessed a;
  a.model = read_model(std::string(STEPLAP_MODELS) + "/" + file, transformer_catalog(), overrides);
  for (const ElementEntry& entry : a.model.elements)
    if (auto* joint = dynamic_cast<StepLapJoint*>(entry.element.get())) joint->mode = mode;
  a.system = compile(a.model);
  a.result = simulate(*a.system, a.system->initial_state(), options_of(a.model));
  a.joints = assess_joints(a.model, a.result);
  return a;
}

const std::vector<std::string> k_fast = {"simulation.integrator=dop853", "simulation.tolerance=1e-8"};

} // namespace

TEST_CASE("joints that hold: margin is pressure over required pressure, nothing slid or lost") {
  const Assessed a = assess("paper/no_interference.toml", "slip", k_fast);
  REQUIRE(a.joints.size() == 2);
  for (const JointAssessment& joint : a.joints) {
    CAPTURE(joint.joint);
    CHECK(joint.verdict == JointVerdict::holds);
    CHECK_FALSE(joint.first_slip.has_value());
    // u = p_req / p and margin = 1/u, p = 0.1 MPa, each located by itself to 1e-6 of its range.
    CHECK(joint.smallest_margin == doctest::Approx(1e5 / joint.largest_required_pressure).epsilon(2.0 * ExtremeFinder::k_resolution));
    CHECK(std::hypot(joint.slid_x, joint.slid_y) < 1e-12); // rounding of metres
    CHECK(std::abs(joint.area_lost) < 1e-9);               // rounding of 2 × 1165 areas
  }
}

TEST_CASE("joints that slide: first slip is the event's, slid distance and lost area are the channels'") {
  const Assessed a = assess("paper/weak_clamping.toml", "slip", {});
  REQUIRE(a.joints.size() == 2);
  for (const JointAssessment& joint : a.joints) {
    CAPTURE(joint.joint);
    CHECK(joint.verdict == JointVerdict::slipped);
    const auto first = std::find_if(a.result.events.begin(), a.result.events.end(),
                                    [&](const Event& e) { return e.element == joint.joint && is_slip(e.kind); });
    REQUIRE(first != a.result.events.end());
    CHECK(joint.first_slip == first->t);
    CHECK(joint.slid_y == doctest::Approx(a.result.trajectory->series(joint.joint + ".dy").back()).epsilon(1e-12));
    CHECK(std::hypot(joint.slid_x, joint.slid_y) > 1e-7); // far above the rounding of one that holds
    CHECK(joint.smallest_margin < 1.0 + 1e-6);
  }
}

TEST_CASE("a monitored joint beyond its limit would slip; a joint without interfaces is not assessed") {
  const Assessed monitored = assess("paper/weak_clamping.toml", "monitor", {});
  for (const JointAssessment& joint : monitored.joints) {
    CHECK(joint.verdict == JointVerdict::would_slip);
    CHECK_FALSE(joint.has_slipped);
    CHECK(joint.smallest_margin < 1.0);
  }
  Assessed bare = assess("paper/no_interference.toml", "slip", k_fast);
  std::erase_if(bare.model.elements, [](const ElementEntry& entry) { return entry.kind->name == "step_lap_interface"; });
  for (const JointAssessment& joint : assess_joints(bare.model, bare.result)) CHECK(joint.verdict == JointVerdict::not_assessed);
}

namespace {

// A limb of one band at the top and one at the bottom, 10 mm wide, pushed along the overlap's width: what one loses
// the other one gains.
std::string sliding_limb(double force, const std::string& more) {
  return R"(
gravity = [0.0, 0.0]
[simulation]
end = 0.02
integrator = "dop853"
tolerance = 1e-9
[[body]]
name = "yokes"
fixed = true
[[body]]
name = "limb"
mass = 1000
inertia = 700.0
[[element]]
kind = "step_lap_joint"
name = "joint"
limb = "limb"
active_part = "yokes"
)" + more +
         R"(
[[element]]
kind = "step_lap_interface"
name = "top"
joint = "joint"
yoke = [[-0.5, 1.0], [0.5, 1.0], [0.5, 1.2], [-0.5, 1.2]]
limb = [[-0.4, 0.8], [0.4, 0.8], [0.4, 1.01], [-0.4, 1.01]]
count = 100
pressure = 1e5
static_friction = 0.25
clearance = "0.5 mm"
[[element]]
kind = "step_lap_interface"
name = "bottom"
joint = "joint"
yoke = [[-0.5, -1.2], [0.5, -1.2], [0.5, -1.0], [-0.5, -1.0]]
limb = [[-0.4, -1.01], [0.4, -1.01], [0.4, -0.8], [-0.4, -0.8]]
count = 300
pressure = 1e5
static_friction = 0.25
clearance = "0.5 mm"
[[element]]
kind = "load"
name = "pull"
at = "limb"
force = [0.0, )" +
         std::to_string(force) + "]\n";
}

JointAssessment assess_text(const std::string& text) {
  const Model model = parse_model(text, "a.toml", transformer_catalog());
  const auto system = compile(model);
  const RunResult result = simulate(*system, system->initial_state(), options_of(model));
  return assess_joints(model, result).at(0);
}

} // namespace

TEST_CASE("area lost counts losses with the number of sheets, and a limb that closes its clearance is told of") {
  // Capacity 0.25 · 1e5 Pa · 8e-3 m² · 400 = 80 kN; 90 kN slide it upwards by s = ½ 10 t² = 2 mm: the top gains, the
  // bottom loses 300 · 0.8 m · s. While it slides capacity falls as (100 − 300) 0.8 s …: s is read from the run.
  const JointAssessment joint = assess_text(sliding_limb(90e3, ""));
  CHECK(joint.verdict == JointVerdict::slid_too_far); // 0.1 of a width of 10 mm at most
  REQUIRE(joint.slid_y > 1.5e-3);
  CHECK(joint.area_lost == doctest::Approx(300 * 0.8 * joint.slid_y).epsilon(1e-9));
  const double width = 0.01 * 0.8 / 0.81;
  CHECK(joint.slid_share.value == doctest::Approx(joint.slid_y / width).epsilon(1e-9));
  CHECK(joint.overlap_left.value == doctest::Approx(1.0 - joint.slid_y / 0.01).epsilon(1e-9));
  CHECK(joint.clearance_left.value == doctest::Approx(0.5e-3 - joint.slid_y).epsilon(1e-9));
  CHECK(joint.has_left_range());
}

TEST_CASE("what a joint bears is the model's to say") {
  // 60 of 80 kN: a margin of 4/3.
  CHECK(assess_text(sliding_limb(60e3, "")).verdict == JointVerdict::holds);
  CHECK(assess_text(sliding_limb(60e3, "least_margin = 1.3\n")).verdict == JointVerdict::holds);
  CHECK(assess_text(sliding_limb(60e3, "least_margin = 1.4\n")).verdict == JointVerdict::little_reserve);
  CHECK(assess_text(sliding_limb(90e3, "most_slide = 0.5\n")).verdict == JointVerdict::closed_clearance);
}
