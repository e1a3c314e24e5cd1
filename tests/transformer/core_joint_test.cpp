// What a [[core]] says of the joints it adds: compliance, edges, pressures in time and across the stack; what it says of
// joints that are declared elsewhere; yokes that several tables share; what bears beside a joint.
#include "elements/step_lap/joint_view.h"
#include "elements/step_lap/patch/overlap.h"
#include "elements/step_lap/step_lap_assessment.h"
#include "elements/step_lap/step_lap_interface.h"
#include "elements/step_lap/step_lap_joint.h"
#include "mbd/io/reader.h"
#include "mbd/model/method.h"
#include "mbd/simulation/simulation.h"
#include "mbd/system/system.h"
#include "mbd/trust/judge.h"
#include "tests/sanitized.h"
#include "transformer/catalog.h"
#include "transformer/core/core_builder.h"
#include "transformer/core/plausible.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>

using namespace steplap;

namespace {

const std::string k_text = R"(gravity = [0.0, 0.0]
[simulation]
end = 0.05
tolerance = 1e-8
[output]
step = 1e-3
[[body]]
name = "active part"
mass = 47000
inertia = 65200
position = [0.0, 1.95]
[[body]]
name = "front limb"
position = [1.25, 1.95]
[[body]]
name = "back limb"
position = [-1.25, 1.95]
[[signal]]
name = "shock"
kind = "half_sine"
peak = 30.0
duration = 0.05
[[core]]
name = "core"
active_part = "active part"
limbs = ["front limb", "back limb"]
limb_width = 0.5
core_height = 3.3
yoke_height = 0.5
stack_depth = 0.585
stacking_factor = 0.96
sheet_thickness = "0.27 mm"
sheets_per_layer = 1
steps = 5
step_pitch = "5 mm"
pitch_direction = "across"
book = "saw_tooth"
clearance = "0.5 mm"
pressure = "0.1 MPa"
static_friction = 0.2
)";
constexpr double k_sheet = 0.27e-3;
constexpr long k_sheets = 2080; // ⌊0.96 · 0.585 m/0.27 mm⌋

Model model_of(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return parse_model(k_text + more, "core.toml", transformer_catalog(), overrides);
}

template <class T> std::vector<const T*> all_of(const Model& model) {
  std::vector<const T*> found;
  for (const ElementEntry& entry : model.elements)
    if (const auto* e = dynamic_cast<const T*>(entry.element.get())) found.push_back(e);
  return found;
}

std::string refusal(const std::string& more, const std::vector<std::string>& overrides = {}) {
  try {
    static_cast<void>(compile(model_of(more, overrides)));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string k_joint = "[[element]]\nkind = \"step_lap_joint\"\nname = \"front limb joint\"\n"
                            "limb = \"front limb\"\nactive_part = \"active part\"\n";

} // namespace

TEST_CASE("all joints of a core are as compliant, pressed and bounded as it says, by path as by file") {
  const std::string fields = "contact_stiffness = 2e10\nshear_modulus = \"80 GPa\"\nedge_stiffness = 1e11\n"
                             "allowed_line_load = 2e7\npressure_loss = 0.2\npressure_signal = \"fading\"\n"
                             "[[signal]]\nname = \"fading\"\nkind = \"trapezoid\"\npeak = 1.0\nstart = -10.0\nrise = 5.0\n"
                             "fall = 10.0\nduration = 20.0\n";
  const std::vector<std::string> paths = {"core.core.contact_stiffness=2e10", "core.core.shear_modulus=80 GPa",
                                          "core.core.edge_stiffness=1e11", "core.core.allowed_line_load=2e7",
                                          "core.core.pressure_loss=0.2"};
  for (const Model& model : {model_of(fields), model_of("", paths)}) {
    REQUIRE(all_of<StepLapJoint>(model).size() == 2);
    for (const StepLapJoint* joint : all_of<StepLapJoint>(model)) {
      CHECK(joint->contact_stiffness == 2e10);
      CHECK(joint->shear_modulus == 80e9);
      CHECK(joint->sheet_thickness == k_sheet);
      CHECK(joint->edge_stiffness == 1e11);
      CHECK(joint->allowed_line_load == 2e7);
      CHECK(joint->pressure_loss == 0.2);
      CHECK(joint->steel_thickness.value() == doctest::Approx(k_sheets * k_sheet).epsilon(1e-14));
    }
    static_cast<void>(compile(model));
  }
  CHECK(all_of<StepLapJoint>(model_of(fields))[0]->pressure_signal == "fading");
  CHECK(all_of<StepLapJoint>(model_of("", {"core.core.tangential_stiffness=3 GN/m"}))[1]->tangential_stiffness == 3e9);
  // Rigid, without edges, uniform unless it says so.
  const StepLapJoint plain;
  const Model without = model_of("");
  for (const StepLapJoint* joint : all_of<StepLapJoint>(without)) {
    CHECK_FALSE(is_elastic(*joint));
    CHECK_FALSE(joint->edge_stiffness);
    CHECK_FALSE(joint->steel_thickness);
    CHECK(joint->pressure_loss == plain.pressure_loss);
  }
}

TEST_CASE("joints pressed differently, and a gradient by path: a change of sign mirrors it") {
  const Model model = model_of("joint_pressure_shares = [1.0, 0.5]\n", {"core.core.pressure_gradient=[1e5,0.0]"});
  for (const StepLapInterface* face : all_of<StepLapInterface>(model)) {
    const bool is_front = face->joint == "front limb joint";
    // Outwards is +x in front, −x behind; shares are of all of it.
    CHECK(face->pressure_gradient.x() == (is_front ? 1e5 : -0.5e5));
    // The middles of the bands lie within a hundredth of a metre of the mitre's middle: a kilopascal.
    CHECK(std::abs(face->pressure - (is_front ? 1e5 : 0.5e5)) < 1e3);
  }
}

TEST_CASE("what of it contradicts itself or is missing is refused where it stands") {
  CHECK(has(refusal("tangential_stiffness = 1e9\ncontact_stiffness = 1e10\n"),
            "core.toml:42:21: error: core 'core': 'tangential_stiffness' and 'contact_stiffness' say the same"));
  CHECK(has(refusal("shear_modulus = 8e10\n"), "'shear_modulus' is in series with 'contact_stiffness', which is not given"));
  CHECK(has(refusal("allowed_line_load = 1e7\n"), "'allowed_line_load' needs 'edge_stiffness'"));
  CHECK(has(refusal("tangential_stiffness = 1e9\nmode = \"monitor\"\n"), "'mode' = \"monitor\" contradicts 'tangential_stiffness'"));
  CHECK(has(refusal("tangential_stiffness = 1e9\nkinetic_friction = 0.15\n"), "'kinetic_friction' contradicts 'tangential_stiffness'"));
  CHECK(refusal("tangential_stiffness = 1e9\nkinetic_friction = 0.2\n") == "");
  CHECK(has(refusal("joint_pressure_shares = [1.0]\n"), "one share for each of the 2 joints, got 1"));
  CHECK(has(refusal("joint_pressure_shares = [1.0, 0.0]\n"), "must be greater than 0"));
  CHECK(has(refusal("bottom_pressure_gradient = [0.0, 0.0]\n"), "'bottom_pressure_gradient' needs 'pressure_gradient'"));
  CHECK(has(refusal("pressure_gradient = [6e5, 0.0]\n"),
            "core.toml:41:21: error: core 'core': 'pressure_gradient' is too steep for 'pressure'"));
  CHECK(refusal("pressure_gradient = [3.9e5, 0.0]\n") == ""); // a mitre reaches 0.25 m to either side
  CHECK(has(refusal("pressure_loss = 1.0\n"), "0.99"));
  CHECK(has(refusal("pressure_signal = \"shok\"\n"), "(did you mean 'shock'?)"));
  CHECK(has(refusal("edge_stiffness = \"1 GN/m\"\n"),
            "core.toml:41:18: error: 'edge_stiffness' of core 'core': '1 GN/m' has the unit 'GN/m', but a unit like 'N/m^2'"));
  CHECK(has(refusal("pressure_gradient = [\"1 kPa\", 0.0]\n"), "Pa/m"));
  // across the stack
  CHECK(has(refusal("transverse_support = \"front\"\n"), "'transverse_support' needs 'transverse_acceleration'"));
  CHECK(has(refusal("transverse_slices = 2\n"), "'transverse_slices' needs 'transverse_acceleration'"));
  const std::string shock = "transverse_acceleration = \"shock\"\n";
  CHECK(has(refusal(shock), "needs 'transverse_support'"));
  CHECK(has(refusal(shock + "transverse_support = \"both\"\n"), "changes nothing: held by both faces, a stack of one packet"));
  CHECK(refusal(shock + "transverse_support = \"both\"\ntransverse_slices = 4\n") == "");
  CHECK(refusal(shock + "transverse_support = \"back\"\n") == "");
}

TEST_CASE("a joint declared by itself may say its own; what it leaves out is not passed over") {
  const std::string all = "edge_stiffness = 1e11\ntangential_stiffness = 2e9\n";
  CHECK(has(refusal(all + k_joint), "'tangential_stiffness' is for joints that this table adds; step_lap_joint 'front limb joint' exists "
                                    "already and does not say its own"));
  const Model model = model_of(all + k_joint + "edge_stiffness = 3e11\ntangential_stiffness = 5e9\n");
  for (const StepLapJoint* joint : all_of<StepLapJoint>(model)) {
    CHECK(joint->edge_stiffness == (joint->name == "front limb joint" ? 3e11 : 1e11));
    CHECK(joint->tangential_stiffness == (joint->name == "front limb joint" ? 5e9 : 2e9));
  }
  CHECK(has(refusal("pressure_loss = 0.1\n" + k_joint), "'pressure_loss' is for joints that this table adds"));
}

// 3 g across, held by the back face: the front loses nothing, the back face's interfaces 30 · 7650 · 0.5616 m = 129 kPa.
TEST_CASE("a shock across the stack takes the pressure off, slice by slice") {
  const auto least_margin = [](const std::string& slices) {
    const Model model = model_of("transverse_acceleration = \"shock\"\ntransverse_support = \"back\"\ntransverse_slices = " + slices +
                                 "\n[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"front limb\"\nforce = [20000.0, 0.0]\n"
                                 "[[element]]\nkind = \"weld\"\nname = \"held\"\na = \"active part\"\nb = \"ground\"\n");
    const auto system = compile(model);
    const RunResult result = simulate(*system, system->initial_state(), options_of(model));
    return assess_joints(model, result).at(0).smallest_margin;
  };
  const Model model = model_of("");
  double capacity = 0.0;
  for (const LapPressure& p : {LapPressure{1e5, {0, 0}, 1e5, 0}}) {
    const auto* core = dynamic_cast<const Core*>(model.tables.front().table.get());
    REQUIRE(core);
    for (const CoreCorner& corner : CoreGeometry(*core).corners(false, 1.0, 1.25))
      for (const Lap& lap : corner.laps) capacity += 0.2 * p.middle * lap.count * lap.area;
  }
  // In the mean p₀ − a ρ z̄; of many slices ∫ max(0, p₀ − a ρ z) dz/h, which is more, since pressures are not negative.
  const double lost = 30.0 * 7650.0 * k_sheets * k_sheet / 1e5; // of the pressure, at the back face
  CHECK(least_margin("1") == doctest::Approx(capacity / 20000.0 * (1.0 - 0.5 * lost)).epsilon(1e-3));
  CHECK(least_margin("20") == doctest::Approx(capacity / 20000.0 * 0.5 / lost).epsilon(2e-3));
}

// A return limb takes half of the rectangle where it crosses each yoke, a wound limb a triangle 0.4 m high; all of it 0.25 mm
// (half the clearance) more along each mitre.
TEST_CASE("yokes that two tables share are weighed: five limbs") {
  const Model model = read_model(std::string(STEPLAP_MODELS) + "/layouts/five_limb.toml", transformer_catalog());
  const double strip = 0.48 * (2 * 2.8 + 0.44), half_gap = 0.25e-3;
  const double cuts =
      2 * (0.5 * 0.44 * 0.48 + half_gap * std::hypot(0.44, 0.48)) + 3 * (0.5 * 0.8 * 0.4 + half_gap * 2 * 0.4 * std::sqrt(2.0));
  const double surface = 7650 * std::floor(0.62 * 0.96 / k_sheet) * k_sheet;
  const auto steel = yoke_steel(model, "active part");
  REQUIRE(steel);
  // The lines of a book lie to either side of the mitre: areas differ by their squares, (10 mm)² at each of ten corners' ends
  CHECK(*steel == doctest::Approx(2 * surface * (strip - cuts)).epsilon(3e-4));
  CHECK_FALSE(yoke_steel(model, "nobody"));
  try {
    static_cast<void>(
        read_model(std::string(STEPLAP_MODELS) + "/layouts/five_limb.toml", transformer_catalog(), {"body.active part.mass=19000"}));
    CHECK(false);
  } catch (const ModelError& error) {
    CHECK(has(error.what(), "19000 kg, is less than the yokes of core 'return limbs' weigh alone, 20"));
  }
}

TEST_CASE("two tables that are parts of one stack have yokes each; a table without both ends leaves the weight unknown") {
  const double one = yoke_steel(model_of(""), "active part").value();
  std::string second = k_text.substr(k_text.find("[[core]]"));
  second.replace(second.find("\"core\""), 6, "\"more\"");
  second.replace(second.find("limb_width = 0.5"), 16, "limb_width = 0.4");
  second.replace(second.find("yoke_height = 0.5"), 17, "yoke_height = 0.4");
  const std::string masses = "[[body]]\nname = \"spare\"\nposition = [9.0, 9.0]\nmass = 1.0\ninertia = 1.0\n";
  const std::vector<std::string> given = {"body.front limb.mass=9000", "body.front limb.inertia=9000", "body.back limb.mass=9000",
                                          "body.back limb.inertia=9000"};
  const double both = yoke_steel(model_of(masses + second, given), "active part").value();
  // The second: two yokes of 2.9 m × 0.4 m less half of 0.16 m² at each of four crossings, and the clearances' 8 · 0.14e-3 m².
  const double more = 7650 * k_sheets * k_sheet * 2 * (0.4 * 2.9 - 0.16 - 2 * 0.25e-3 * 0.4 * std::sqrt(2.0));
  CHECK(both - one == doctest::Approx(more).epsilon(3e-4));
  CHECK_FALSE(
      yoke_steel(model_of("", {"core.core.limbs=[\"front limb\"]", "body.back limb.mass=1", "body.back limb.inertia=1"}), "active part"));
}

TEST_CASE("tables that name one limb make one joint and one stack, or are refused") {
  // The second packet, 0.4 m wide, in the same yokes' axes.
  const auto with = [](const std::string& more, const std::string& joints = "") {
    std::string second = k_text.substr(k_text.find("[[core]]"));
    for (const auto& [old, now] : {std::pair{"\"core\"", "\"more\""},
                                   {"limb_width = 0.5", "limb_width = 0.4"},
                                   {"core_height = 3.3", "core_height = 3.2"},
                                   {"yoke_height = 0.5", "yoke_height = 0.4"}})
      second.replace(second.find(old), std::string(old).size(), now);
    return joints + second + more;
  };
  const std::string edges = "edge_stiffness = 1e11\n";
  CHECK(refusal(with("")) == "");
  const Model both = model_of(with(edges, edges));
  for (const StepLapJoint* joint : all_of<StepLapJoint>(both))
    CHECK(joint->steel_thickness.value() == doctest::Approx(2.0 * k_sheets * k_sheet).epsilon(1e-14)); // of both stacks
  // A packet need not be as deep as a section is wide: the stack is.
  const auto remarks = [&](double depth) {
    return implausible_cores(model_of(with(""), {"core.core.stack_depth=0.3", "core.more.stack_depth=" + std::to_string(depth)}));
  };
  CHECK(remarks(0.15).empty());
  REQUIRE(remarks(0.7).size() == 1);
  CHECK(has(remarks(0.7).front().text, "core 'core': a stack 1 m deep of limbs 0.5 m wide is unusual"));
  CHECK(has(refusal(with("joints = [\"a\", \"b\"]\n")),
            "limb 'front limb', which core 'core' names, too, is held by joint 'front limb joint' there and by 'a' here"));
  CHECK(has(refusal(with("edge_stiffness = 2e11\n", edges)), "'edge_stiffness' differs from that of core 'core'"));
  CHECK(has(refusal(with("contact_stiffness = 2e10\n", "contact_stiffness = 1e10\n")), "'contact_stiffness' differs"));
  CHECK(has(refusal(with("pressure_loss = 0.2\n", "pressure_loss = 0.1\n")), "'pressure_loss' differs"));
  CHECK(refusal(with("pressure_loss = 0.1\n", "pressure_loss = 0.1\n")) == "");
  CHECK(has(refusal(with("centre_of_gravity = \"as_given\"\n")), "has 'centre_of_gravity' = \"of_the_sheets\" there"));
  CHECK(has(refusal(with("", "transverse_acceleration = \"shock\"\ntransverse_support = \"back\"\n")),
            "limb 'front limb', which core 'more' names, too, needs its whole stack in one table for 'transverse_acceleration'"));
  CHECK(has(refusal(with(""), {"body.front limb.mass=6000"}), "contradicts cores 'core' and 'more', whose sheets make it 10823 kg"));
  std::string middle = with("middle_limbs = [\"front limb\"]\n");
  const std::string both_outer = "limbs = [\"front limb\", \"back limb\"]";
  middle.replace(middle.find(both_outer), both_outer.size(), "limbs = [\"back limb\"]");
  CHECK(has(refusal(middle), "counts as a middle limb here and as an outer one there"));
}

// In a saw tooth the last layer of a packet ends farthest from the yoke and the first of the next nearest to it: there the yoke's sheets of
// the first packet overlap limb sheets of the second, and none of the second packet's yoke sheets those of the first.
TEST_CASE("the interface between two packets holds the packet whose limb sheets it presses") {
  const auto grip = [](const std::string& more) { // capacity of each packet's interfaces at both limbs, N
    std::string text = k_text + more;
    for (const auto& [old, now] : {std::pair{"limb_width = 0.5\n", ""},
                                   {"yoke_height = 0.5\n", ""},
                                   {"stack_depth = 0.585\n", "packets = [[0.5, 0.0085], [0.4, 0.0085]]\nyoke_heights = [0.5, 0.4]\n"}})
      text.replace(text.find(old), std::string(old).size(), now);
    const Model model = parse_model(text, "core.toml", transformer_catalog());
    std::map<std::string, double> sum;
    for (const StepLapInterface* face : all_of<StepLapInterface>(model)) {
      OverlapWorkspace workspace;
      Region region;
      intersect_exactly(make_outline({face->yoke, {}}), make_outline({face->limb, {}}), {}, workspace, region);
      sum[face->part] += face->static_friction * face->pressure * face->count * area(region);
    }
    return sum;
  };
  for (const std::string& by_place : {std::string(), std::string("transverse_acceleration = \"shock\"\ntransverse_support = \"back\"\n"
                                                                 "transverse_slices = 2\n")}) {
    CAPTURE(by_place);
    auto touching = grip(by_place), apart = grip(by_place + "ducts = [[0.0085, 0.005]]\n"); // 30 sheets, and a duct behind them
    REQUIRE(touching.size() == 2);
    CHECK(touching["packet 1"] == doctest::Approx(apart["packet 1"]).epsilon(1e-12));
    CHECK(touching["packet 2"] > 1.01 * apart["packet 2"]); // one wide interface in 29
  }
}

TEST_CASE("what bears between a limb and the active part is named beside the joint, with what it bore") {
  const auto assess = [](const std::string& more) {
    const Model model = model_of(more + "[[marker]]\nname = \"plate end\"\nbody = \"active part\"\nat = [1.25, 0.0]\n"
                                        "[[element]]\nkind = \"tie\"\nname = \"tie plate\"\na = \"front limb\"\nb = \"plate end\"\n"
                                        "axis = [0.0, 1.0]\nacts = \"both\"\nstiffness = 1e9\n"
                                        "[[element]]\nkind = \"weld\"\nname = \"held\"\na = \"active part\"\nb = \"ground\"\n"
                                        "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"front limb\"\nforce = [0.0, -20000.0]\n");
    const auto system = compile(model);
    return assess_joints(model, simulate(*system, system->initial_state(), options_of(model)));
  };
  const auto rigid = assess("");
  REQUIRE(rigid.at(0).shared_with.size() == 1);
  CHECK(rigid[0].shared_with[0].element == "tie plate");
  CHECK(rigid[0].shared_with[0].largest == 0.0); // nothing before it slides
  CHECK_FALSE(rigid[0].is_elastic);
  CHECK(rigid.at(1).shared_with.empty());
  // A load that is there at once swings about its rest, undamped: twice what each bears of it at rest, half.
  const auto elastic = assess("tangential_stiffness = 1e9\n");
  CHECK(elastic[0].is_elastic);
  CHECK(elastic[0].shared_with.at(0).largest == doctest::Approx(20000.0).epsilon(0.02)); // 2 k/(K + k)
  // The other half, twice, and a little turning. Before the load came the margin was infinite: what is found of it later must
  // not be measured by that.
  CHECK(elastic[0].smallest_margin == doctest::Approx(rigid[0].smallest_margin).epsilon(0.05));
  CHECK(elastic[0].smallest_margin == doctest::Approx(1e5 / elastic[0].largest_required_pressure).epsilon(2e-6));
}

TEST_CASE("edges of a core: an allowed line load is a criterion, met, not met, or open") {
  const auto judged = [](const std::string& more) {
    const Model model = model_of("edge_stiffness = 1e11\n" + more +
                                 "[[element]]\nkind = \"weld\"\nname = \"held\"\na = \"active part\"\nb = \"ground\"\n"
                                 "[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"front limb\"\nforce_x = \"push\"\n"
                                 "[[signal]]\nname = \"push\"\nkind = \"half_sine\"\npeak = -1.2e6\nduration = 0.03\n");
    const auto system = compile(model);
    const RunResult result = simulate(*system, system->initial_state(), options_of(model));
    return std::pair{assess_joints(model, result).at(0), judge(model, *system, result, "")};
  };
  const auto [bare, without] = judged("");
  REQUIRE(bare.edge_load.value > 1e4); // it butted
  CHECK(bare.edge_pressure.value == doctest::Approx(bare.edge_load.value / (k_sheets * k_sheet)).epsilon(1e-9));
  CHECK(std::isnan(bare.edge_margin()));
  const auto find = [](const Judgement& judgement) {
    for (const CriterionResult& c : judgement.criteria)
      if (c.name == "front limb joint" && has(c.text, "line load")) return c;
    return CriterionResult();
  };
  CHECK(find(without).text.empty()); // nothing allowed, nothing asked
  const auto with = [](double allowed) { return "allowed_line_load = " + std::to_string(allowed) + "\n"; };
  const auto [borne, good] = judged(with(2.0 * bare.edge_load.value));
  CHECK(borne.edge_margin() == doctest::Approx(2.0).epsilon(1e-6));
  CHECK(find(good).outcome == Verdict::hold);
  const auto [crushed, bad] = judged(with(0.5 * bare.edge_load.value));
  CHECK(crushed.has_crushed_edges());
  CHECK(find(bad).outcome == Verdict::reject);
  CHECK(bad.verdict == Verdict::reject);
  // Figures that are not known leave it open.
  const Model model = model_of("edge_stiffness = 1e11\nallowed_line_load = 1e7\n");
  const auto system = compile(model);
  CHECK(find(judge(model, *system, RunResult(), "")).outcome == Verdict::open);
}

// --- the whole scene turned ---------------------------------------------------------------------------------------

namespace {

// Half of a core that is pushed along its yoke beyond the clearance, with gravity and pushed off its axis, all of it turned by `angle`
// about the ground's origin. The active part is fixed, or moves as a body with a push of its own.
Model turned_scene(double angle, bool is_fixed, const std::string& fields) {
  std::ostringstream out;
  out.precision(17);
  const auto turned = [&](double x, double y) {
    const Vec2 v = rotated(Vec2(x, y), angle);
    std::ostringstream pair;
    pair.precision(17);
    pair << "[" << v.x() << ", " << v.y() << "]";
    return pair.str();
  };
  const auto load = [&](const char* at, double x, double y, const char* shape) {
    const Vec2 force = rotated(Vec2(x, y), angle);
    for (const int axis : {0, 1})
      out << "[[signal]]\nname = \"" << at << axis << "\"\nkind = \"half_sine\"\npeak = " << force[axis] << "\n" << shape;
    out << "[[element]]\nkind = \"load\"\nname = \"push on " << at << "\"\nat = \"" << at << "\"\nforce_x = \"" << at << "0\"\nforce_y = \""
        << at << "1\"\n";
  };
  out << "gravity = " << turned(0.0, -9.81)
      << "\n[simulation]\nend = 0.03\nintegrator = \"auto\"\ntolerance = 1e-8\n[output]\nstep = 1e-3\n"
      << "[[body]]\nname = \"part\"\nmass = 47000\ninertia = 65200\nposition = " << turned(0.3, 1.9) << "\nangle = " << angle
      << "\ncg = [-0.3, 0.05]\nfixed = " << (is_fixed ? "true" : "false")
      << "\n[[body]]\nname = \"limb\"\nposition = " << turned(1.25, 1.95) << "\nangle = " << angle << "\n";
  load("limb", -1.2e6, 2e5, "duration = 0.03\n");
  if (!is_fixed) load("part", 3e5, 0.0, "duration = 0.02\n");
  out << "[[core]]\nname = \"core\"\nactive_part = \"part\"\nlimbs = [\"limb\"]\n" << k_text.substr(k_text.find("limb_width")) << fields;
  return parse_model(out.str(), "turned.toml", transformer_catalog());
}

} // namespace

// Nature knows no up: what a joint says of itself is in the axes of the active part, whether that moves or is fixed.
TEST_CASE("a core turned with all that loads it slides, closes its clearances and bears on its edges as before") {
  const std::string bands = "bands = \"mean\"\npressure_gradient = [\"0.05 MPa/m\", \"0.02 MPa/m\"]\n";
  for (const bool is_fixed : {true, false})
    for (const std::string& fields : {bands, bands + "edge_stiffness = 1e11\ncontact_stiffness = 2e10\n"}) {
      const bool has_edges = fields != bands; // whose runs take a second each
      if (has_edges && testing::k_is_sanitized) continue;
      struct Seen {
        std::map<std::string, std::pair<double, double>> ranges;
        std::size_t events = 0;
        std::vector<double> view;
      };
      const auto see = [&](double angle) {
        const Model model = turned_scene(angle, is_fixed, fields);
        const auto system = compile(model);
        const RunResult run = simulate(*system, system->initial_state(), options_of(model));
        Seen seen;
        seen.events = run.events.size();
        for (const ChannelRange& range : run.ranges)
          for (const char* name : {"clearance_left", "edge_force_1", "edge_load", "dx", "dy", "theta_acc", "slid_share", "area_lost", "u",
                                   "m", "strain_x", "strain_y", "least_pressure", "corner_margin"})
            if (range.channel->name == std::string("limb joint.") + name) seen.ranges[name] = {range.low.value, range.high.value};
        for (const char* name : {"centre_x", "centre_y"}) {
          const std::vector<double> all = run.trajectory->series(std::string("limb joint.") + name);
          seen.view.push_back(all.at(10)); // while it is pushed hardest
        }
        const JointView view = joint_views(model, *system).at(0);
        const RequiredPressure need = view.required(Vec3(1e5, -2e5, 3e4));
        seen.view.insert(seen.view.end(), {view.centre().x(), view.centre().y(), need.centre->x(), need.centre->y()});
        for (const int i : {0, 1, 2}) seen.view.insert(seen.view.end(), {1e-6 * view.sliding(i), 1e-6 * view.alone(i)}); // MN, MN m
        return seen;
      };
      // Steps at 1e-8 are chosen by other components; the search of extremes leaves 1e-6 of a range. The direction in which an elastic joint
      // yields is known to 1e-5 from these steps.
      const double exact = has_edges ? 3e-5 : 3e-6;
      const Seen upright = see(0.0);
      REQUIRE(upright.ranges.at("clearance_left").first < -1e-5); // it closes more than its clearance
      REQUIRE(std::abs(upright.ranges.at("dx").first) > 1e-5);
      if (has_edges) REQUIRE(upright.ranges.at("edge_load").second > 1e4);
      for (const double angle : {0.5 * std::numbers::pi, std::numbers::pi, 0.1}) {
        if (has_edges && (is_fixed ? angle == 0.1 : angle != 0.1)) continue;
        CAPTURE(is_fixed);
        CAPTURE(fields);
        CAPTURE(angle);
        const Seen turned = see(angle);
        CHECK(turned.events == upright.events);
        REQUIRE(turned.ranges.size() == upright.ranges.size());
        for (const auto& [name, range] : upright.ranges) {
          CAPTURE(name);
          const double near = exact * std::max(std::abs(range.first), std::abs(range.second)) + 1e-10;
          CHECK(std::abs(turned.ranges.at(name).first - range.first) < near);
          CHECK(std::abs(turned.ranges.at(name).second - range.second) < near);
        }
        for (std::size_t i = 0; i < upright.view.size(); ++i)
          CHECK(turned.view[i] == doctest::Approx(upright.view[i]).epsilon(exact).scale(1.0)); // m, MN
      }
    }
}

// Within long steps of an explicit method a stiff joint that slides may be said to bear many times what it can, although the
// ends of the steps are right: such a run must not be believed.
// A joint of 0.39 MN pushed beyond it, stiff enough to slide after a strain of a micrometre.
Model pushed_core(const std::string& integrator, const std::string& tolerance) {
  return model_of("bands = \"mean\"\ncontact_stiffness = 2e10\npressure_loss = 0.1\n"
                  "[[element]]\nkind = \"weld\"\nname = \"held\"\na = \"active part\"\nb = \"ground\"\n"
                  "[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"front limb\"\nforce_x = \"push\"\n"
                  "[[signal]]\nname = \"push\"\nkind = \"half_sine\"\npeak = -1.2e6\nduration = 0.03\n",
                  {"simulation.integrator=" + integrator, "simulation.tolerance=" + tolerance, "simulation.end=0.005"});
}

RunResult run(const Model& model, const System& system) { return simulate(system, system.initial_state(), options_of(model)); }

ChannelRange& range_of(RunResult& result, const std::string& name) {
  for (ChannelRange& range : result.ranges)
    if (range.channel->name == name) return range;
  throw std::out_of_range(name);
}

// What joints bear turns to the way of the slip within a strain of a micrometre: dop853 takes steps of 500 times that, and
// its dense output said 39 MN in them. The strain is known to 1e-11 m (the tolerance of a millimetre), a hundred thousandth.
TEST_CASE("an elastic joint bears within steps what its limit surface allows, by every method that chooses its steps") {
  const Model fine = pushed_core("rodas5p", "1e-11");
  const auto fine_system = compile(fine);
  RunResult reference = run(fine, *fine_system);
  const double capacity = range_of(reference, "front limb joint.fx").high.value;
  CHECK(capacity == doctest::Approx(3.918e5).epsilon(1e-3));
  for (const Method& method : methods()) {
    if (method.has_fixed_step || method.is_time_stepping) continue;
    const Model model = pushed_core(method.name, "1e-8");
    const auto system = compile(model);
    RunResult result = run(model, *system);
    CAPTURE(method.name);
    CHECK(judge(model, *system, result, "").distrust == "");
    CHECK(assess_joints(model, result).at(0).smallest_margin == doctest::Approx(1.0).epsilon(1e-5));
    for (const char* channel : {"front limb joint.fx", "front limb joint.fy", "front limb joint.m"}) {
      CAPTURE(channel);
      const ChannelRange &is = range_of(result, channel), &ought = range_of(reference, channel);
      CHECK(std::abs(is.low.value - ought.low.value) < 1e-5 * capacity); // N, N m
      CHECK(std::abs(is.high.value - ought.high.value) < 1e-5 * capacity);
    }
  }
}

TEST_CASE("an elastic joint that is found beyond its limit surface makes the run distrusted") {
  const Model model = pushed_core("rodas5p", "1e-8");
  const auto system = compile(model);
  RunResult result = run(model, *system);
  CHECK(judge(model, *system, result, "").distrust == "");
  range_of(result, "front limb joint.margin").low.value = 0.9; // what a step beyond stability would have said
  CHECK(has(judge(model, *system, result, "").distrust, "'front limb joint' slides with a margin of "));
}

TEST_CASE("masses that a core would have given are not asked for while its own fields are wrong") {
  for (const char* wrong : {"core.core.core_height=2.8 kg", "core.core.clearance=1 kPa", "core.core.steps=1"}) {
    std::string said;
    try {
      model_of("", {wrong});
    } catch (const ModelError& error) {
      said = error.what();
    }
    CAPTURE(said);
    CHECK(has(said, "of core 'core'"));
    CHECK(!has(said, "needs 'mass'"));
  }
}

TEST_CASE("stiffnesses, losses and shares that no core has are told of") {
  const auto said = [](const std::string& more) {
    std::string all;
    for (const CoreRemark& remark : implausible_cores(model_of(more))) all += remark.text + "\n";
    return all;
  };
  CHECK(said("") == "");
  CHECK(said("contact_stiffness = 2e10\nshear_modulus = 8e10\nedge_stiffness = 1e11\nallowed_line_load = 1e7\npressure_loss = 0.1\n") ==
        "");
  CHECK(has(said("contact_stiffness = 2e5\n"), "'contact_stiffness' = 2e+05 N/m^3 is unusual"));
  CHECK(has(said("tangential_stiffness = 2e5\n"), "'tangential_stiffness' ="));
  CHECK(has(said("contact_stiffness = 2e10\nshear_modulus = 8e6\n"), "'shear_modulus' = 8e+06 Pa is unusual"));
  CHECK(has(said("edge_stiffness = 1e3\n"), "'edge_stiffness' ="));
  CHECK(has(said("edge_stiffness = 1e11\nallowed_line_load = 1e12\n"), "'allowed_line_load' ="));
  CHECK(has(said("pressure_loss = 0.9\n"), "'pressure_loss' = 0.9 is unusual"));
  CHECK(has(said("joint_pressure_shares = [1.0, 0.1]\n"), "'joint_pressure_shares': 0.1 of 'pressure' is 10000 Pa"));
}
