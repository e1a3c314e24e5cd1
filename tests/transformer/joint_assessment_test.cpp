// What a run is said to have done to each step-lap joint, against its events and its channels.
#include "elements/step_lap_joint.h"
#include "mbd/io/reader.h"
#include "mbd/simulation.h"
#include "transformer/catalog.h"
#include "transformer/joint_assessment.h"

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
    CHECK(joint.verdict == "holds");
    CHECK_FALSE(joint.first_slip.has_value());
    // u = p_req / p and margin = 1/u are the same sample's, p = 0.1 MPa: equal up to rounding.
    CHECK(joint.smallest_margin == doctest::Approx(1e5 / joint.largest_required_pressure).epsilon(1e-12));
    CHECK(std::hypot(joint.slid_x, joint.slid_y) < 1e-12); // rounding of metres
    CHECK(std::abs(joint.area_lost) < 1e-9);               // rounding of 2 × 1165 areas
  }
}

TEST_CASE("joints that slide: first slip is the event's, slid distance and lost area are the channels'") {
  const Assessed a = assess("paper/weak_clamping.toml", "slip", {});
  REQUIRE(a.joints.size() == 2);
  for (const JointAssessment& joint : a.joints) {
    CAPTURE(joint.joint);
    CHECK(joint.verdict == "slipped");
    const auto first = std::find_if(a.result.events.begin(), a.result.events.end(), [&](const Event& e) {
      return e.element == joint.joint && e.what.starts_with("slips");
    });
    REQUIRE(first != a.result.events.end());
    CHECK(joint.first_slip == first->t);
    CHECK(joint.slid_y == a.result.trajectory->series(joint.joint + ".dy").back());
    CHECK(std::hypot(joint.slid_x, joint.slid_y) > 1e-7); // far above the rounding of one that holds
    CHECK(joint.smallest_margin < 1.0 + 1e-6);
  }
}

TEST_CASE("a monitored joint beyond its limit would slip; a joint without interfaces is not assessed") {
  const Assessed monitored = assess("paper/weak_clamping.toml", "monitor", {});
  for (const JointAssessment& joint : monitored.joints) {
    CHECK(joint.verdict == "would slip");
    CHECK_FALSE(joint.has_slipped);
    CHECK(joint.smallest_margin < 1.0);
  }
  Assessed bare = assess("paper/no_interference.toml", "slip", k_fast);
  std::erase_if(bare.model.elements,
                [](const ElementEntry& entry) { return entry.kind->name == "step_lap_interface"; });
  for (const JointAssessment& joint : assess_joints(bare.model, bare.result))
    CHECK(joint.verdict == "not assessed");
}
