// A core's joints from its dimensions: the paper's polygons and capacity, the book of a step-lap stack,
// what is refused.
#include "elements/step_lap/patch/overlap.h"
#include "elements/step_lap/patch/polygon.h"
#include "elements/step_lap/step_lap_friction.h"
#include "elements/step_lap/step_lap_interface.h"
#include "elements/step_lap/step_lap_joint.h"
#include "mbd/io/reader.h"
#include "mbd/system/system.h"
#include "transformer/catalog.h"
#include "transformer/core/book.h"
#include "transformer/core/plausible.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;

namespace {

const std::string k_bodies = R"(
[simulation]
step = 1e-3
[[body]]
name = "active part"
mass = 47000
inertia = 65200
position = [0.0, 1.95]
[[body]]
name = "front limb"
mass = 9000
inertia = 6500
position = [1.25, 1.95]
[[body]]
name = "back limb"
mass = 9000
inertia = 6500
position = [-1.25, 1.95]
)";

const std::string k_shape = R"(
[[core]]
name = "core"
active_part = "active part"
limbs = ["front limb", "back limb"]
limb_width = 0.5
core_height = 3.3
yoke_height = 0.5
pressure = "0.1 MPa"
static_friction = 0.25
)";

const std::string k_overlaps = "overlap = 0.01\ninterfaces = 1165\n";
const std::string k_counted = k_overlaps + "sheet_outlines = \"strips\"\n"; // as in the paper
const std::string k_built = "stack_depth = 0.585\nstacking_factor = 0.96\nsheet_thickness = \"0.27 "
                            "mm\"\nsheets_per_layer = 1\n"
                            "steps = 5\nstep_pitch = \"5 mm\"\npitch_direction = \"across\"\nbook "
                            "= \"saw_tooth\"\nclearance = 0.0\n";

Model model_of(const std::string& core, const std::vector<std::string>& overrides = {}) {
  return parse_model(k_bodies + core, "core.toml", transformer_catalog(), overrides);
}

std::vector<const StepLapInterface*> interfaces_of(const Model& model) {
  std::vector<const StepLapInterface*> found;
  for (const ElementEntry& entry : model.elements)
    if (const auto* e = dynamic_cast<const StepLapInterface*>(entry.element.get())) found.push_back(e);
  return found;
}

/// Friction of the i-th joint over its overlap in the reference pose.
Patch patch_of(const Model& model, std::size_t i = 0, const Pose& moved = {0, 0, 0}) {
  const auto system = compile(model);
  const auto& friction = dynamic_cast<const StepLapFriction&>(*system->frictions.at(i).friction);
  const State state = system->initial_state();
  std::vector<Motion<double>> motion(static_cast<std::size_t>(system->body_count()));
  place_bodies(state.q, state.v, motion);
  Pose pose = friction.pose_of(motion.data());
  pose.x += moved.x;
  pose.y += moved.y;
  pose.theta += moved.theta;
  return friction.patch_at(pose, GripLaw::holding);
}

double overlap_area(const StepLapInterface& e) {
  const Outline yoke = make_outline({e.yoke, {}}), limb = make_outline({e.limb, {}});
  OverlapWorkspace workspace;
  Region region;
  intersect(yoke, limb, {0, 0, 0}, workspace, region);
  return area(region);
}

/// The message that a core is refused with; "" if it is not.
std::string refusal(const std::string& core, const std::vector<std::string>& overrides = {}) {
  try {
    static_cast<void>(model_of(core, overrides));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("a core that has been built before comes to the same, to the bit") {
  const auto numbers_of = [](const Model& model) {
    std::vector<double> numbers;
    for (const StepLapInterface* e : interfaces_of(model)) {
      for (const auto* ring : {&e->yoke, &e->limb})
        for (const Vec2& corner : *ring) numbers.insert(numbers.end(), {corner.x(), corner.y()});
      numbers.insert(numbers.end(), {e->count, e->pressure, e->pressure_gradient.x(), e->pressure_gradient.y()});
    }
    return numbers;
  };
  const std::string core = k_shape + k_built + "pressure_gradient = [0.0, \"0.02 MPa/m\"]\n";
  const std::vector<double> first = numbers_of(model_of(core));
  CHECK(numbers_of(model_of(core, {"core.core.step_pitch=4.9 mm"})) != first);
  CHECK(numbers_of(model_of(core)) == first); // overlaps are known from before
  // Other pressures over overlaps that are known.
  const std::vector<double> pressed = numbers_of(model_of(core, {"core.core.pressure=0.2 MPa"}));
  CHECK(pressed != first);
  CHECK(numbers_of(model_of(core, {"core.core.pressure=0.2 MPa"})) == pressed);
}

TEST_CASE("the paper's dimensions give the paper's sheets") {
  const Model model = model_of(k_shape + k_counted);
  const auto interfaces = interfaces_of(model);
  REQUIRE(interfaces.size() == 4);
  const double l = std::sqrt(0.5), r = 1.0 / std::sqrt(2.0), w = 0.01;
  for (const StepLapInterface* e : interfaces) {
    CAPTURE(e->name);
    const double side = e->joint == "front limb joint" ? 1.0 : -1.0;
    const double level = has(e->name, "top") ? 1.0 : -1.0;
    const Vec2 centre(1.25 * side, 1.95), corner(-0.25 * side, 1.15 * level);
    const Vec2 t(side * r, level * r), n(side * r, -level * r);
    const auto at = [&](double s, double q) { return Vec2(centre + corner + s * t + q * n); };
    const std::vector<Vec2> limb = {at(0, -w / 2), at(l, -w / 2), at(l, 0.05), at(0, 0.05)};
    const std::vector<Vec2> yoke = {at(-0.02, -0.05), at(l + 0.02, -0.05), at(l + 0.02, w / 2), at(-0.02, w / 2)};
    // A few roundings of coordinates up to 4 m.
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK((e->limb.at(i) - limb[i]).norm() < 2e-15);
      CHECK((e->yoke.at(i) - yoke[i]).norm() < 2e-15);
    }
    CHECK(e->frame == "ground");
    CHECK(e->count == 1165.0);
    CHECK(e->pressure == 1e5);
    CHECK(e->static_friction == 0.25);
    CHECK(overlap_area(*e) == doctest::Approx(l * w).epsilon(1e-12));
  }
}

TEST_CASE("the paper's joint bears 411.9 kN") {
  const Model model = model_of(k_shape + k_counted);
  for (const std::size_t joint : {0u, 1u}) {
    const Patch patch = patch_of(model, joint);
    // 2 corners · 1165 · 0.25 · 0.1 MPa · 10 mm · √0.5 m; 411.9 as printed
    CHECK(patch.force() == doctest::Approx(2 * 1165 * 0.25 * 1e5 * 0.01 * std::sqrt(0.5)).epsilon(1e-12));
    CHECK(std::abs(patch.force() / 1e3 - 411.9) < 0.05);
    CHECK((patch.centroid() - patch.reference()).norm() < 1e-13); // symmetric about the limb's centre
  }
}

TEST_CASE("joints get the names asked for, or those of their limbs") {
  const Model own = model_of(k_shape + k_counted),
              named = model_of(k_shape + k_counted + "joints = [\"front joint\", \"back joint\"]\nmode = \"monitor\"\n");
  const auto names = [](const Model& model) {
    std::vector<std::string> found;
    for (const ElementEntry& entry : model.elements)
      if (dynamic_cast<const StepLapJoint*>(entry.element.get())) found.push_back(entry.element->name);
    return found;
  };
  CHECK(names(own) == std::vector<std::string>{"front limb joint", "back limb joint"});
  CHECK(names(named) == std::vector<std::string>{"front joint", "back joint"});
  for (const ElementEntry& entry : named.elements)
    if (const auto* joint = dynamic_cast<const StepLapJoint*>(entry.element.get())) CHECK(joint->mode == "monitor");
}

TEST_CASE("packets of a core share the joints") {
  const std::string second = "[[core]]\nname = \"packet 2\"\nactive_part = \"active part\"\n"
                             "limbs = [\"front limb\", \"back limb\"]\nlimb_width = 0.4\ncore_height = 3.2\n"
                             "yoke_height = 0.4\npressure = 5e4\nstatic_friction = 0.25\noverlap = 0.01\n"
                             "interfaces = 300\nsheet_outlines = \"strips\"\n";
  const Model model = model_of(k_shape + k_counted + second);
  CHECK(compile(model)->frictions.size() == 2);
  CHECK(interfaces_of(model).size() == 8);
  // The weight of each part of the stack is unknown, so that no packet is judged alone. The remark makes a run open.
  const std::vector<CoreRemark> remarks = implausible_cores(model);
  CHECK(std::count_if(remarks.begin(), remarks.end(), [](const CoreRemark& remark) {
          return has(remark.text, "2 [[core]] tables name it, and 'overlap' of core 'core' does not say what its part");
        }) == 2);
  const double both = 2 * 0.25 * 0.01 * (1165 * 1e5 * std::sqrt(0.5) + 300 * 5e4 * 0.4 * std::sqrt(2.0));
  CHECK(patch_of(model).force() == doctest::Approx(both).epsilon(1e-12));
}

TEST_CASE("a joint of the model is used as it stands") {
  const std::string joint = "[[element]]\nkind = \"step_lap_joint\"\nname = \"front limb joint\"\n"
                            "limb = \"front limb\"\nactive_part = \"active part\"\non_apart = \"continue\"\n";
  const Model model = model_of(k_shape + k_counted + joint);
  CHECK(compile(model)->frictions.size() == 2);
  for (const ElementEntry& entry : model.elements)
    if (entry.element->name == "front limb joint") CHECK(dynamic_cast<const StepLapJoint&>(*entry.element).on_apart == "continue");
  const std::string other = "[[element]]\nkind = \"step_lap_joint\"\nname = \"front limb joint\"\n"
                            "limb = \"back limb\"\nactive_part = \"active part\"\n";
  CHECK(has(refusal(k_shape + k_counted + other), "holds 'back limb' to 'active part', not 'front limb'"));
}

TEST_CASE("what a core says of joints declared elsewhere is honoured or refused, never ignored") {
  const std::string joint = "[[element]]\nkind = \"step_lap_joint\"\nname = \"front limb joint\"\n"
                            "limb = \"front limb\"\nactive_part = \"active part\"\n";
  const std::string core = k_shape + k_counted;
  CHECK(
      has(refusal(core + "mode = \"monitor\"\n" + joint), "'mode' is for joints that this table adds; step_lap_joint 'front limb joint'"));
  CHECK(has(refusal(core + "on_apart = \"continue\"\n" + joint), "'on_apart' is for joints"));
  CHECK(has(refusal(core + "least_margin = 1.5\n" + joint), "'least_margin' is for joints"));
  CHECK(refusal(core + "mode = \"monitor\"\n" + joint + "mode = \"monitor\"\n") == ""); // they agree
}

TEST_CASE("the same core over again is refused: it would bear twice as much") {
  std::string again = k_shape + k_counted;
  again.replace(again.find("name = \"core\""), 13, "name = \"more\"");
  CHECK(has(refusal(k_shape + k_counted + again), "would count twice"));
}

// --- the book ---------------------------------------------------------------------------------------------

// The mean over one period, line after line: q_k of the next layer against q_k of this one.
TEST_CASE("the mean overlap of a book is that of its closed form") {
  for (const BookKind kind : {BookKind::saw_tooth, BookKind::zig_zag, BookKind::zig_zag_doubled})
    for (const long n : {2L, 3L, 5L, 7L, 10L})
      for (const double clearance : {0.0, 0.5e-3}) {
        const Book book{kind, 1, n, 5e-3, clearance};
        double sum = 0.0;
        for (long i = 0; i < period_of(book); ++i) {
          const double step = line_at(book, position_of(book, i + 1)) - line_at(book, position_of(book, i));
          sum += std::max(0.0, std::abs(step) - clearance);
        }
        CHECK(mean_overlap(book) == doctest::Approx(sum / static_cast<double>(period_of(book))).epsilon(1e-14));
        CHECK(position_of(book, period_of(book)) == position_of(book, 0));
        CHECK(std::abs(line_at(book, 0) + line_at(book, n - 1)) < 1e-17); // about the middle of the mitre
      }
  // Of five steps a zig-zag has 5 mm where a saw tooth has 8.
  CHECK(mean_overlap({BookKind::saw_tooth, 1, 5, 5e-3, 0.5e-3}) == doctest::Approx(7.5e-3).epsilon(1e-14));
  CHECK(mean_overlap({BookKind::zig_zag, 1, 5, 5e-3, 0.5e-3}) == doctest::Approx(4.5e-3).epsilon(1e-14));
}

namespace {

/// Between a and b across a diagonal of length l of a rectangle whose corners are h off it: chords are l (1 − |q|/h).
double between_lines(double l, double h, double a, double b) { return l * (b - a - (b * std::abs(b) - a * std::abs(a)) / (2.0 * h)); }

} // namespace

TEST_CASE("a stack as it is built: sheets, interfaces, capacity") {
  // D = 0.585 m deep, 827 mm mitre: 2080 sheets, 5 steps of 5 mm, 8 mm of overlap in the mean
  const Model model = model_of(k_shape + k_built, {"core.core.limb_width=0.585", "core.core.yoke_height=0.585"});
  const auto interfaces = interfaces_of(model);
  REQUIRE(interfaces.size() == 20);
  const double l = 0.585 * std::sqrt(2.0), h = 0.5 * l;
  double count = 0.0, area = 0.0;
  for (std::size_t i = 0; i < 5; ++i) {
    count += interfaces[i]->count;
    area += interfaces[i]->count * overlap_area(*interfaces[i]);
  }
  CHECK(count == 2079.0); // 416 books of 4 narrow overlaps, 415 wide ones between them
  double exact = 415 * between_lines(l, h, -10e-3, 10e-3);
  for (const double q : {-10e-3, -5e-3, 0.0, 5e-3}) exact += 416 * between_lines(l, h, q, q + 5e-3);
  CHECK(area == doctest::Approx(exact).epsilon(1e-12));
  // One corner, mu 0.2, p 0.1 MPa: 275 kN but for the ends, 1.2 %.
  CHECK(std::abs(patch_of(model).force() / 2 * 0.2 / 0.25 - 275e3 * (1 - 0.0121)) < 0.5e3);
  // with two sheets in a layer half of the interfaces carry none
  const Model pairs = model_of(k_shape + k_built, {"core.core.sheets_per_layer=2"});
  double of_pairs = 0.0;
  for (std::size_t i = 0; i < 5; ++i) of_pairs += interfaces_of(pairs)[i]->count;
  CHECK(of_pairs == 1039.0);
}

TEST_CASE("a pitch along the sheet is one across the mitre times the cosine or sine of its angle") {
  const auto force = [](const std::vector<std::string>& overrides) { return patch_of(model_of(k_shape + k_built, overrides)).force(); };
  const auto pitch = [](double s) { return "core.core.step_pitch=" + std::to_string(s); };
  const std::string limb = "core.core.pitch_direction=along_limb", yoke = "core.core.pitch_direction=along_yoke";
  // 45°: both the same; six digits of the text
  CHECK(force({limb}) == doctest::Approx(force({yoke})).epsilon(1e-12));
  CHECK(force({limb}) == doctest::Approx(force({pitch(5e-3 / std::sqrt(2.0))})).epsilon(1e-3));
  // tan α = 0.6/0.5
  const std::string high = "core.core.yoke_height=0.6", front = "body.front limb.inertia=4000", back = "body.back limb.inertia=4000";
  const double c = 0.5 / std::hypot(0.5, 0.6), s = 0.6 / std::hypot(0.5, 0.6);
  CHECK(force({limb, high, front, back}) / force({yoke, high, front, back}) == doctest::Approx(c / s).epsilon(0.02)); // but for the ends
}

TEST_CASE("all bands as one of their mean area: same capacity, parts earlier") {
  const Model mean = model_of(k_shape + k_built, {"core.core.bands=mean"}), each = model_of(k_shape + k_built);
  CHECK(interfaces_of(each).size() == 20);
  CHECK(interfaces_of(mean).size() == 4);
  CHECK(interfaces_of(mean)[0]->count == 2079.0);
  CHECK(patch_of(each).force() == doctest::Approx(patch_of(mean).force()).epsilon(1e-12));
  // Drawn forward, off both mitres, by a third of the pitch: the corners' bands narrow alike, but for the ends. By 6 mm
  // across the mitre the narrow ones, 5 mm wide, have parted, of the wide one 14 mm are left.
  const double d = 6e-3 * std::sqrt(2.0);
  CHECK(patch_of(mean, 0, {d / 3, 0, 0}).force() == doctest::Approx(patch_of(each, 0, {d / 3, 0, 0}).force()).epsilon(0.01));
  const double whole = patch_of(mean).force();
  CHECK(patch_of(mean, 0, {d, 0, 0}).force() / whole < 0.26);
  CHECK(patch_of(each, 0, {d, 0, 0}).force() / whole > 0.34);
}

// The overlap of 10 mm along a diagonal of the square of 0.5 m is cut off aslant at both ends: w²/4 each.
TEST_CASE("counted overlaps end where limb and yoke do") {
  const Model real = model_of(k_shape + k_overlaps), strips = model_of(k_shape + k_counted);
  const double l = std::sqrt(0.5), w = 0.01;
  CHECK(overlap_area(*interfaces_of(real)[0]) == doctest::Approx(l * w - 0.5 * w * w).epsilon(1e-12));
  CHECK(overlap_area(*interfaces_of(strips)[0]) == doctest::Approx(l * w).epsilon(1e-12));
}

TEST_CASE("the limb's centre of gravity is that of its sheets, its body's origin the middle of the limb") {
  // A trapezoid with sides of 3.3 m outside and 2.3 m inside, 0.5 m apart.
  const double off = 0.5 * (3.3 + 2 * 2.3) / (3 * (3.3 + 2.3));
  const Model real = model_of(k_shape + k_overlaps);
  const Body& front = *real.find_body("front limb");
  CHECK((front.cg - Vec2(0.25 - off, 0)).norm() < 1e-14);
  CHECK((real.find_body("back limb")->cg + front.cg).norm() < 1e-14); // mirrored
  // As given, if asked for; strips lie about the centre of gravity, as in the paper.
  CHECK(model_of(k_shape + k_overlaps, {"core.core.centre_of_gravity=as_given"}).find_body("front limb")->cg.norm() == 0.0);
  CHECK(model_of(k_shape + k_counted).find_body("front limb")->cg.norm() == 0.0);
  CHECK(model_of(k_shape + k_overlaps, {"body.front limb.cg=[0.01,0.0]"}).find_body("front limb")->cg.x() == 0.01);
}

TEST_CASE("limbs without a mass have that of their sheets, given ones must agree") {
  std::string bodies = k_bodies;
  for (const char* given : {"mass = 9000\ninertia = 6500\n"})
    for (std::size_t at = bodies.find(given); at != std::string::npos; at = bodies.find(given)) bodies.erase(at, 27);
  const Model model = parse_model(bodies + k_shape + k_built, "core.toml", transformer_catalog());
  // 2080 sheets of 0.27 mm and of 1.4 m² in the mean (the lines lie about the middle of the mitre)
  const Body& limb = *model.find_body("front limb");
  CHECK(limb.mass == doctest::Approx(7650 * 2080 * 0.27e-3 * 0.5 * (3.3 + 2.3) / 2).epsilon(1e-4));
  const auto said = [&](const std::string& text) {
    try {
      static_cast<void>(parse_model(text, "core.toml", transformer_catalog()));
    } catch (const ModelError& wrong) {
      return std::string(wrong.what());
    }
    return std::string();
  };
  // Counted overlaps say nothing of the stack: the mass is missed as before.
  CHECK(has(said(bodies + k_shape + k_overlaps), "body 'front limb' needs 'mass' (mass; in kg)"));
  CHECK(has(refusal(k_shape + k_built, {"body.front limb.mass=3000"}),
            "'mass' of body 'front limb', 3000 kg, contradicts core 'core', whose sheets make it 60"));
  CHECK(has(refusal(k_shape + k_built, {"body.front limb.inertia=65000"}), "'inertia' of body 'front limb', 65000 kg m², contradicts"));
}

TEST_CASE("top and bottom may differ") {
  const Model model = model_of(k_shape + k_counted + "bottom_pressure = 5e4\nbottom_static_friction = 0.2\n");
  for (const StepLapInterface* e : interfaces_of(model)) {
    CHECK(e->pressure == (has(e->name, "bottom") ? 5e4 : 1e5));
    CHECK(e->static_friction == (has(e->name, "bottom") ? 0.2 : 0.25));
  }
}

// --- geometry -------------------------------------------------------------------------------------------------

TEST_CASE("a core that stands aslant has the same joints, turned") {
  const double angle = 0.3;
  const auto turned = [&](double x, double y) {
    const Vec2 p = Vec2(0, 1.95) + rotated(Vec2(x, y - 1.95), angle);
    return "[" + std::to_string(p.x()) + "," + std::to_string(p.y()) + "]";
  };
  const Model upright = model_of(k_shape + k_counted);
  const Model aslant =
      model_of(k_shape + k_counted, {"body.active part.angle=0.3", "body.front limb.angle=0.3", "body.back limb.angle=0.3",
                                     "body.front limb.position=" + turned(1.25, 1.95), "body.back limb.position=" + turned(-1.25, 1.95)});
  const Patch a = patch_of(upright), b = patch_of(aslant);
  CHECK(b.force() == doctest::Approx(a.force()).epsilon(1e-12));
  CHECK(b.gyration() == doctest::Approx(a.gyration()).epsilon(1e-12));
}

TEST_CASE("a mitre that does not run from corner to corner ends where limb or yoke does") {
  const auto length = [](const std::vector<std::string>& overrides) {
    const Model model = model_of(k_shape + k_counted, overrides);
    const StepLapInterface& e = *interfaces_of(model).front();
    return (e.limb[1] - e.limb[0]).norm();
  };
  CHECK(length({"core.core.yoke_height=0.6"}) == doctest::Approx(std::hypot(0.5, 0.6)).epsilon(1e-12));
  CHECK(length({"core.core.yoke_height=0.6", "core.core.mitre_angle=45 degree"}) == doctest::Approx(0.5 * std::sqrt(2.0)).epsilon(1e-12));
  CHECK(length({"core.core.yoke_height=0.4", "core.core.mitre_angle=45 degree"}) == doctest::Approx(0.4 * std::sqrt(2.0)).epsilon(1e-12));
}

// A limb of 0.5 m ends in a point of 45°: two mitres of 0.25 m/cos 45° at either end.
TEST_CASE("a middle limb has two mitres at either end, together as long as one from corner to corner") {
  const std::vector<std::string> middle = {"core.core.limbs=[\"front limb\"]", "core.core.middle_limbs=[\"back limb\"]",
                                           "body.back limb.position=[0.0,1.95]"};
  const Model model = model_of(k_shape + k_counted, middle);
  CHECK(interfaces_of(model).size() == 2 + 4);
  const Patch outer = patch_of(model, 0), inner = patch_of(model, 1);
  CHECK(inner.force() == doctest::Approx(outer.force()).epsilon(1e-12));
  CHECK((inner.centroid() - inner.reference()).norm() < 1e-13); // fore and aft, top and bottom alike
  // Each mitre begins at a corner of the window and ends on the limb's centre line.
  for (const StepLapInterface* e : interfaces_of(model)) {
    if (e->joint != "back limb joint") continue;
    CAPTURE(e->name);
    const double front = has(e->name, "front") ? 1.0 : -1.0, level = has(e->name, "top") ? 1.0 : -1.0;
    const Vec2 inner_edge(-front, -level); // across the mitre, towards the limb
    const Vec2 start = e->limb[0] + 0.005 * inner_edge.normalized(), end = e->limb[1] + 0.005 * inner_edge.normalized();
    CHECK((start - Vec2(0.25 * front, 1.95 + 1.15 * level)).norm() < 1e-14);
    CHECK((end - Vec2(0.0, 1.95 + 1.40 * level)).norm() < 1e-14);
  }
  CHECK(has(refusal(k_shape + k_counted, {middle[0], middle[1], "core.core.notch_angle=70 degree"}), "is higher than the yoke of 0.5 m"));
  CHECK(has(refusal(k_shape + k_counted, {"core.core.middle_limbs=[\"back limb\"]"}), "names limb 'back limb' twice"));
}

// --- what is refused ---------------------------------------------------------------------------------------------

TEST_CASE("impossible cores are refused, with what would be right") {
  const std::string counted = k_shape + k_counted, built = k_shape + k_built, real = k_shape + k_overlaps;
  CHECK(refusal(counted) == "");
  CHECK(refusal(built) == "");
  CHECK(has(refusal(counted, {"core.core.limbs=[\"front lim\"]"}),
            "override core.core.limbs=[\"front lim\"]: error: core 'core': limb 'front lim' is no body (did you mean 'front limb'?)"));
  CHECK(has(refusal(counted, {"core.core.limbs=[\"active part\"]"}), "is the active part itself"));
  CHECK(has(refusal(counted, {"core.core.limbs=[\"back limb\",\"back limb\"]"}), "twice"));
  CHECK(has(refusal(counted, {"core.core.limbs=[]"}), "at least one"));
  CHECK(has(refusal(counted, {"core.core.active_part=ground"}), "not 'ground'"));
  CHECK(has(refusal(counted, {"core.core.active_part=active"}), "active"));
  CHECK(has(refusal(counted, {"core.core.joints=[\"a\"]"}), "one joint for each of the 2 limbs, got 1"));
  CHECK(has(refusal(counted, {"body.front limb.position=[0.1,1.95]"}), "in the middle of the active part"));
  CHECK(has(refusal(counted, {"core.core.yoke_height=1.7"}), "leave no window"));
  CHECK(has(refusal(counted, {"core.core.yoke_height=0.05"}), "must be 10° to 80°"));
  CHECK(has(refusal(counted, {"core.core.mitre_angle=85 degree"}), "a mitre at 85°"));
  CHECK(has(refusal(counted, {"core.core.overlap=0.11"}), "wider than the strips"));
  CHECK(refusal(real, {"core.core.overlap=0.11"}) == "");
  CHECK(has(refusal(real, {"core.core.overlap=0.71"}), "an overlap of 0.71 m is wider than the sheets"));
  CHECK(has(refusal(real + "tongue = 0.05\n"), "'tongue' is of strips only"));
  CHECK(has(refusal(built + "sheet_outlines = \"strips\"\n"), "is for counted overlaps"));
  CHECK(has(refusal(counted, {"core.core.overlap=-0.01"}), "greater than 0"));
  CHECK(has(refusal(counted, {"core.core.kinetic_friction=0.3"}), "must not exceed 'static_friction'"));
  CHECK(has(refusal(counted + "steps = 5\n"), "not both"));
  CHECK(has(refusal(k_shape + "overlap = 0.01\n"), "needs 'interfaces' besides 'overlap'"));
  CHECK(has(refusal(k_shape), "needs either 'overlap' and 'interfaces', or how the stack is built: 'stack_depth'"));
  for (const char* field : {"sheets_per_layer", "pitch_direction", "book", "clearance", "stacking_factor"}) {
    std::string without = built;
    const std::size_t at = without.find(field);
    without.erase(at, without.find('\n', at) - at);
    CHECK(has(refusal(without), "needs '" + std::string(field) + "' ("));
  }
  CHECK(has(refusal(built, {"core.core.clearance=6 mm"}), "leaves no overlap"));
  CHECK(has(refusal(built, {"core.core.stack_depth=1 mm"}), "3 sheets"));
  CHECK(has(refusal(built, {"core.core.step_pitch=0.2"}), "a book that reaches 0.8 m across the mitre is wider than the sheets"));
  CHECK(has(refusal(counted + "limb_wdth = 3\n"), "did you mean 'limb_width'?"));
  CHECK(has(refusal(counted, {"body.back limb.position=[0.9,1.95]"}),
            "limbs 'back limb' and 'front limb' stand 0.35 m apart ('position' of the bodies), "
            "less than a limb is wide, 0.5 m ('limb_width')"));
}

TEST_CASE("stepped sections, ducts and holes that cannot be are refused, with the field and its line") {
  std::string shape = k_shape;
  for (const char* field : {"limb_width = 0.5\n", "yoke_height = 0.5\n"}) shape.erase(shape.find(field), std::string(field).size());
  std::string built = k_built;
  built.erase(built.find("stack_depth"), built.find('\n') + 1);
  const std::string packets = "packets = [[0.4, 0.05], [0.5, 0.4], [0.4, 0.05]]\nyoke_heights = [0.4, 0.5, 0.4]\n";
  const std::string stepped = shape + built + packets;
  const std::vector<std::string> steel = {"body.front limb.mass=5000", "body.back limb.mass=5000", "body.front limb.inertia=3400",
                                          "body.back limb.inertia=3400"};
  CHECK(refusal(stepped, steel) == "");
  const auto with = [&](const std::string& more) { return refusal(stepped + more, steel); };
  CHECK(has(refusal(shape + built), "needs 'limb_width' (width of a limb's sheets; in m; or 'packets'"));
  CHECK(has(with("limb_width = 0.5\n"), ": error: core 'core': 'limb_width' and 'packets' say the same"));
  CHECK(has(with("stack_depth = 0.5\n"), "'stack_depth' and 'packets' say the same"));
  CHECK(has(refusal(stepped, {"core.core.yoke_heights=[0.4,0.5]"}), "one height for each of the 3 packets, got 2"));
  CHECK(has(with("pressure_shares = [1.0]\n"), "one share for each of the 3 packets, got 1"));
  CHECK(has(refusal(stepped, {"core.core.packets=[[0.4,0.0],[0.5,0.4],[0.4,0.05]]"}), "must be greater than 0"));
  CHECK(has(refusal(stepped, {"core.core.packets=[[0.4,0.001],[0.5,0.4],[0.4,0.05]]"}), "a packet of 3 sheets"));
  CHECK(has(with("ducts = [[0.6, 0.006]]\n"), "a duct at 0.6 m lies outside the stack of 0.5 m"));
  CHECK(has(with("ducts = [[0.1, 0.0]]\n"), "a width above 0 m"));
  CHECK(has(with("bolt_holes = [[0.0, 0.0]]\n"), "'bolt_holes' needs 'bolt_hole_diameter'"));
  CHECK(has(with("bolt_hole_diameter = 0.02\n"), "'bolt_hole_diameter' needs 'bolt_holes'"));
  CHECK(has(with("bolt_holes = [[0.3, 0.3]]\nbolt_hole_diameter = 0.02\n"), "bolt hole 1 at (0.3 m, 0.3 m) lies outside a limb"));
  CHECK(has(with("bolt_holes = [[0.0, 0.0], [0.0, 0.02]]\nbolt_hole_diameter = 0.02\n"), "bolt holes 1 and 2 run into each other"));
  CHECK(has(with("bolt_holes = [[0.19, 0.19]]\nbolt_hole_diameter = 0.12\n"), "cuts a sheet in two"));
  CHECK(has(refusal(k_shape + k_counted + "yoke_heights = [0.5]\n"), "'yoke_heights' is for 'packets'"));
}

TEST_CASE("limbs that cannot stand between two straight yokes are refused, where they are named") {
  const std::string middle = "middle_limbs = [\"middle limb\"]\n", counted = k_shape + k_overlaps;
  const auto with_middle = [&](const char* place) {
    return refusal(counted + middle + "[[body]]\nname = \"middle limb\"\nmass = 9000\ninertia = 6500\nposition = " + place + "\n");
  };
  CHECK(with_middle("[0.0, 1.95]") == "");
  CHECK(with_middle("[0.4, 1.95]") == ""); // limbs of a core of five that are no bodies may stand elsewhere
  CHECK(has(with_middle("[2.0, 1.95]"), "middle limb 'middle limb' stands outside outer limb 'front limb', where the yokes end"));
  CHECK(has(with_middle("[-2.0, 1.95]"), "middle limb 'middle limb' stands outside outer limb 'back limb'"));
  CHECK(has(with_middle("[0.0, 2.15]"), "limbs 'front limb' and 'middle limb' stand at heights that differ by 0.2 m"));
  CHECK(has(refusal(counted, {"body.back limb.position=[2.5,1.95]"}),
            "limbs 'front limb' and 'back limb' are both outer limbs on one side of the middle of 'active part'"));
  CHECK(has(refusal(counted, {"body.back limb.position=[-1.25,1.85]"}), "stand at heights that differ by 0.1 m"));
  CHECK(refusal(counted, {"body.back limb.position=[-1.25,1.94]"}) == "");
  const std::string more = "[[body]]\nname = \"A\"\nmass = 9000\ninertia = 6500\nposition = [2.5, 1.95]\n"
                           "[[body]]\nname = \"B\"\nmass = 9000\ninertia = 6500\nposition = [-2.5, 1.95]\n";
  const std::string four = refusal(counted + more, {"core.core.limbs=[\"front limb\",\"back limb\",\"A\",\"B\"]"});
  CHECK(has(four, "limbs 'front limb' and 'A' are both outer limbs"));
  CHECK(has(four, "limbs 'back limb' and 'B' are both outer limbs"));
}

TEST_CASE("limbs that may be meant otherwise are told of: turned against the yokes, beyond the yokes of another table") {
  const auto said = [](const Model& model) {
    std::string all;
    for (const CoreRemark& remark : implausible_cores(model))
      if (!remark.is_note) all += remark.text + "\n";
    return all;
  };
  const std::string turned = "'angle' differs by 180° from that of 'active part'";
  CHECK(!has(said(model_of(k_shape + k_overlaps)), "'angle'"));
  CHECK(has(said(model_of(k_shape + k_overlaps, {"body.back limb.angle=180 degree"})), "body 'back limb': " + turned));
  CHECK(!has(said(model_of(k_shape + k_overlaps, {"body.back limb.angle=360 degree"})), "'angle'")); // the same direction
  const auto beyond = [&](double x) {
    std::string more = k_shape + k_overlaps;
    more.replace(more.find("name = \"core\""), 13, "name = \"more\"");
    more.replace(more.find("[\"front limb\", \"back limb\"]"), 27, "[\"A\", \"B\"]");
    for (const auto& [name, place] : {std::pair{"A", x}, {"B", -x}})
      more +=
          "[[body]]\nname = \"" + std::string(name) + "\"\nmass = 9000\ninertia = 6500\nposition = [" + std::to_string(place) + ", 1.95]\n";
    return said(model_of(k_shape + k_overlaps + more));
  };
  CHECK(has(beyond(2.5), "core 'core': limb 'A' of core 'more', which has the same yokes, stands beyond outer limb 'front limb'"));
  CHECK(has(beyond(0.6), "core 'more': limb 'front limb' of core 'core', which has the same yokes, stands beyond outer limb 'A'"));
  CHECK(has(beyond(1.25), "core 'core': limb 'A' of core 'more', which has the same yokes, stands in the same place as 'front limb'"));
}

TEST_CASE("all that is wrong with a core is said at once") {
  const std::string all = refusal(k_shape, {"core.core.limbs=[\"nobody\"]", "core.core.yoke_height=1.7"});
  CHECK(has(all, "'nobody' is no body"));
  CHECK(has(all, "leave no window"));
  CHECK(has(all, "needs either"));
}

// Two yokes of 3 m over limbs 2.5 m apart, less half the square where an outer limb crosses, 0.25 m² · 1/2.
TEST_CASE("an active part lighter than its own yokes contradicts the core") {
  const double area = 2 * (0.5 * 3.0 - 2 * 0.5 * 0.25), steel = 7650 * 2080 * 0.27e-3 * area;
  CHECK(refusal(k_shape + k_built, {"body.active part.mass=" + std::to_string(1.001 * steel)}) == "");
  CHECK(has(refusal(k_shape + k_built, {"body.active part.mass=" + std::to_string(0.999 * steel)}),
            "kg, is less than the yokes of core 'core' weigh alone, "));
}

TEST_CASE("limbs and active part without an outline are drawn by the core's dimensions") {
  Model model = read_model(std::string(STEPLAP_MODELS) + "/layouts/three_limb.toml", transformer_catalog());
  const auto area = [&](const char* name) {
    const std::vector<Vec2>& p = model.find_body(name)->outline;
    double sum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec2 &a = p[i], &b = p[(i + 1) % p.size()];
      sum += 0.5 * (a.x() * b.y() - b.x() * a.y());
    }
    return sum;
  };
  const auto core = std::find_if(model.elements.begin(), model.elements.end(),
                                 [](const ElementEntry& e) { return e.element->name == "core: front joint, top 1"; });
  REQUIRE(core != model.elements.end());
  // Counter-clockwise, and the two outer limbs are mirror images: equal areas, to rounding.
  CHECK(area("front limb") > 0.0);
  CHECK(area("front limb") == doctest::Approx(area("rear limb")).epsilon(1e-12));
  CHECK(model.find_body("middle limb")->outline.size() == 6);
}
