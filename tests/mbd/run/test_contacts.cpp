// Compares the description of each kind of contact (contact_description.h) with its gap, and tests runs in which contacts leave their parts.
#include "mbd/base/counter_random.h"
#include "mbd/base/number_text.h"
#include "mbd/rest/statics.h"
#include "mbd/run/overview.h"
#include "mbd/run/report.h"
#include "mbd/run/tipping.h"
#include "mbd/system/contact_description.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

using namespace steplap;

namespace {

double drawn(std::uint32_t stream, std::uint64_t n) { return counter_uniform(5, stream, n, 0); }
std::string number(double value) { return number_text(value); }

std::string pose(double x, double y, double angle) {
  return "position = [" + number(x) + ", " + number(y) + "]\nangle = " + number(angle) + "\n";
}
const std::string k_box = "outline = [[-0.4, -0.3], [0.5, -0.3], [0.4, 0.3], [-0.4, 0.3]]\n";

// A contact of each kind between bodies 'a' and 'b' in a random pose, in which it presses or nearly touches.
std::string scene_of(const std::string& kind, std::uint64_t n) {
  const double turn = 0.6 * (drawn(0, n) - 0.5), x = 2.0 * drawn(1, n) - 1.0, y = 2.0 * drawn(2, n) - 1.0;
  const double across = 0.3 * (drawn(3, n) - 0.5), own = 0.6 * (drawn(4, n) - 0.5);
  double height = 0.29; // of a above b, in b's axes
  std::string law;
  if (kind == "unilateral_contact") law = "a = { body = \"a\", point = [0.1, -0.2] }\nnormal = [0.2, 1.0]\nstiffness = 1e6\n", height = 0.1;
  if (kind == "circle_contact") law = "a = \"a\"\nradius_a = 0.2\nradius_b = 0.15\nstiffness = 1e6\n", height = 0.3;
  if (kind == "segment_contact") law = "a = \"a\"\nradius = 0.3\nfrom = [-1.0, 0.0]\nto = [1.0, 0.1]\nstiffness = 1e6\n";
  if (kind == "polygon_contact") law = "a = \"a\"\nstiffness = 1e8\n", height = 0.58;
  if (kind == "tyre")
    law = "a = \"a\"\nradius = 0.3\nroad = [[-2.0, 0.0], [0.0, 0.02], [2.0, 0.0]]\nstiffness = 1e6\nfriction = 0.5\nslip_stiffness = 1e4\n"
          "relaxation_length = 0.2\ntread_damping = 100.0\n";
  const double c = std::cos(turn), s = std::sin(turn);
  return "[simulation]\nend = 0.001\n[[body]]\nname = \"a\"\nmass = 10.0\ninertia = 1.0\n" + k_box +
         pose(x + c * across - s * height, y + s * across + c * height, turn + own) +
         "[[body]]\nname = \"b\"\nmass = 10.0\ninertia = 1.0\n" + k_box + pose(x, y, turn) + "[[element]]\nkind = \"" + kind +
         "\"\nname = \"touch\"\nb = \"b\"\n" + law;
}

// Gap of 'touch' with body a (index 1) displaced by (dx, dy, dθ).
double gap_of(const LoadedModel& loaded, const Vec3& by) {
  const System& system = *loaded.system;
  State state = system.initial_state();
  for (int i = 0; i < 3; ++i) state.q[static_cast<std::size_t>(3 + i)] += by[i];
  Statics statics(system);
  statics.evaluate(state);
  Snapshot snapshot;
  snapshot.motion = statics.motion().data();
  snapshot.evaluation = &statics.evaluation();
  snapshot.impacts = state.impacts.data();
  return system.find_channel("touch.gap")->value(snapshot);
}

Report run_of(const std::string& name, const std::vector<std::string>& overrides = {}) {
  RunOptions options;
  options.estimating = Estimating::never;
  return judged_run(load_model(std::string(STEPLAP_TEST_DATA) + "/contacts/" + name + ".toml", overrides), options);
}

const Finding* found(const Report& report, const std::string& code) {
  for (const Finding& finding : report.findings)
    if (finding.code == code) return &finding;
  return nullptr;
}

} // namespace

TEST_CASE("every kind that makes a normal force describes its contact, and no other") {
  std::set<std::string> described, forces;
  for (const ElementKind* kind : program_catalogue().elements)
    if (kind->contact) described.insert(kind->name);
  for (const std::string& kind : described)
    CHECK_MESSAGE(load_model_text(scene_of(kind, 0), "contact.toml")->system->contact_count == 1, kind);
  for (const char* folder : {"machines", "layouts", "paper"})
    for (const auto& file : std::filesystem::directory_iterator(std::string(STEPLAP_MODELS) + "/" + folder)) {
      if (file.path().extension() != ".toml") continue;
      const auto loaded = load_model(file.path().string());
      const auto count = std::count_if(loaded->model.elements.begin(), loaded->model.elements.end(),
                                       [](const ElementEntry& entry) { return entry.kind->contact != nullptr; });
      CHECK_MESSAGE(loaded->system->contact_count == count, file.path().string());
    }
}

TEST_CASE("the described normal is the gradient of the gap, and the described points bound its lever") {
  for (const char* kind : {"unilateral_contact", "circle_contact", "segment_contact", "polygon_contact", "tyre"})
    for (std::uint64_t n = 0; n < 40; ++n) {
      CAPTURE(kind);
      CAPTURE(n);
      const auto loaded = load_model_text(scene_of(kind, n), "contact.toml");
      const System& system = *loaded->system;
      const State state = system.initial_state();
      const ElementEntry& entry = loaded->model.elements.front();
      const ContactDescription contact = *contact_of(entry, loaded->model);
      const std::vector<ContactPoint> points = contact.points(*entry.element, ScenePose(loaded->model, system, state));
      REQUIRE(!points.empty());
      const Vec2 normal = points.front().normal, along(normal.y(), -normal.x());
      CHECK(normal.norm() == doctest::Approx(1.0).epsilon(1e-14));
      // Central differences: truncation h² / size² = 1e-10, rounding 1e-16 / h.
      constexpr double h = 1e-5;
      const auto slope = [&](const Vec3& by) { return (gap_of(*loaded, h * by) - gap_of(*loaded, -h * by)) / (2.0 * h); };
      CHECK(slope({normal.x(), normal.y(), 0.0}) == doctest::Approx(1.0).epsilon(1e-6));
      CHECK(std::abs(slope({along.x(), along.y(), 0.0})) < 1e-6);
      const Vec2 centre(state.q[3], state.q[4]);
      double low = 1e9, high = -1e9;
      for (const ContactPoint& point : points) {
        const Vec2 lever = point.point - centre;
        const double moment = lever.x() * normal.y() - lever.y() * normal.x();
        low = std::min(low, moment);
        high = std::max(high, moment);
      }
      const double turned = slope({0.0, 0.0, 1.0});
      CHECK(turned > low - 1e-6);
      CHECK(turned < high + 1e-6);
    }
}

TEST_CASE("contacts that leave their part leave the verdict open") {
  for (const char* name : {"deep_tyre", "deep_tyre_kN"}) {
    const Report report = run_of(name);
    CHECK_MESSAGE(report.judgement.verdict == Verdict::open, name);
    CHECK_MESSAGE(found(report, "contact_too_deep"), name);
  }
  for (const char* name : {"off_tyre", "off_foot", "off_and_back", "poly_plane"}) {
    const Report report = run_of(name);
    CHECK_MESSAGE(report.judgement.verdict == Verdict::open, name);
    CHECK_MESSAGE(found(report, "foot_beyond_edge"), name);
  }
}

TEST_CASE("a body that sinks into bare ground by more than a fifth of its size leaves the verdict open") {
  // A cube of 1 m on two feet: 0.2 sqrt(0.5) = 0.1414 m. It rests m g/(2 k) deep.
  const auto run = [](double depth, const std::string& floor) {
    const double k = 100.0 * 9.81 / (2.0 * depth);
    const auto foot = [&](const char* name, double x) {
      return std::string("[[element]]\nkind = \"unilateral_contact\"\nname = \"") + name + "\"\na = { body = \"box\", point = [" +
             number(x) + ", -0.5] }\n" + (floor.empty() ? "" : "b = { body = \"floor\", at = [0.0, 0.0] }\n") + "stiffness = " + number(k) +
             "\n";
    };
    const std::string text = "[simulation]\nend = 0.1\ninitial = \"equilibrium\"\n[[body]]\nname = \"box\"\nmass = 100.0\ninertia = 16.0\n"
                             "position = [0.0, 0.5]\noutline = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]\n" +
                             floor + foot("left", -0.4) + foot("right", 0.4) +
                             "[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"box\"\naxis = [0.0, 1.0]\n"
                             "[[acceptance]]\nname = \"height\"\nchannel = \"box.y\"\nwithin = 1.0\n";
    RunOptions options;
    options.estimating = Estimating::never;
    return judged_run(load_model_text(text, "sinks.toml"), options);
  };
  const Report deep = run(0.145, ""), shallow = run(0.14, "");
  CHECK(deep.judgement.verdict == Verdict::open);
  CHECK(found(deep, "contact_sinks"));
  CHECK(shallow.judgement.verdict == Verdict::hold);
  CHECK_FALSE(found(shallow, "contact_sinks"));
  // A floor with an outline says how deep a foot may go.
  const std::string floor = "[[body]]\nname = \"floor\"\nfixed = true\noutline = [[-2.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-2.0, 0.0]]\n";
  const Report bed = run(0.145, floor);
  CHECK(bed.judgement.verdict == Verdict::hold);
  CHECK_FALSE(found(bed, "contact_sinks"));
}

TEST_CASE("what a foot falls through after an action has let go of it is no depth of the foot") {
  const std::string text =
      "[simulation]\nend = 1.0\n[[body]]\nname = \"box\"\nmass = 100.0\ninertia = 16.0\nposition = [0.0, 0.5]\n"
      "[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"box\"\naxis = [0.0, 1.0]\n[[element]]\nkind = \"unilateral_contact\"\n"
      "name = \"foot\"\na = { body = \"box\", point = [0.0, -0.5] }\nstiffness = 1e7\ndamping = 1e4\n[[action]]\nname = \"let go\"\n"
      "when = \"t > '0.2 s'\"\ndo = [\"release foot\"]\n[[acceptance]]\nname = \"fall\"\nchannel = \"box.y\"\nwithin = 100.0\n";
  RunOptions options;
  options.estimating = Estimating::never;
  const Report report = judged_run(load_model_text(text, "let_go.toml"), options);
  CHECK(report.find("foot.gap")->low.value < -3.0); // 9.81/2 of 0.8² m
  CHECK_FALSE(found(report, "contact_sinks"));
}

TEST_CASE("a lumped mass may press a soft one-sided spring as deep as it will") {
  const std::string text =
      "gravity = [0.0, -1.0]\n[simulation]\nend = 0.1\ninitial = \"equilibrium\"\n[[body]]\nname = \"m\"\nmass = 1.0\n"
      "inertia = 0.01\n[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"m\"\naxis = [0.0, 1.0]\n[[element]]\n"
      "kind = \"unilateral_contact\"\nname = \"spring\"\na = \"m\"\nstiffness = 1.0\n[[acceptance]]\n"
      "name = \"sag\"\nchannel = \"m.y\"\nwithin = 2.0\n";
  RunOptions options;
  options.estimating = Estimating::never;
  const Report report = judged_run(load_model_text(text, "lumped.toml"), options);
  CHECK(report.judgement.verdict == Verdict::hold);
  CHECK_FALSE(found(report, "contact_sinks"));
}

TEST_CASE("how far a foot was driven beyond its edge, and when, is that of its motion") {
  // x = A sin 2πft on a deck that ends at 1 m: at most A − 1 beyond, at a quarter of the period. Within a step the motion is a cubic, whose
  // error is (2πf h)⁴/384 of A: below 1e-4 for steps up to a fifth of a radian.
  for (std::uint64_t n = 0; n < 12; ++n)
    for (const char* method : {"auto", "rk4", "tsit5"}) {
      CAPTURE(n);
      CAPTURE(method);
      const double amplitude = 1.05 + drawn(10, n), frequency = 0.5 + 2.0 * drawn(11, n);
      const Report report =
          run_of("off_and_back",
                 {"signal.to and fro.amplitudes=[" + number(amplitude) + "]", "signal.to and fro.frequencies=[" + number(frequency) + "]",
                  "simulation.end=" + number(0.45 / frequency), std::string("simulation.integrator=") + method,
                  std::string(method) == "rk4" ? "simulation.step=1e-3" : "simulation.tolerance=1e-7"});
      const std::vector<FaceTravel>& travels = report.run.result.face_travels;
      REQUIRE(travels.size() == 1);
      CHECK(travels.front().beyond == doctest::Approx(amplitude - 1.0).epsilon(1e-3));
      CHECK(travels.front().t == doctest::Approx(0.25 / frequency).epsilon(1e-2));
      CHECK(found(report, "foot_beyond_edge"));
    }
  const Report inside = run_of("off_and_back", {"signal.to and fro.amplitudes=[0.99]"});
  CHECK(inside.run.result.face_travels.empty());
}

TEST_CASE("a cart on tyres tips as one on feet at the same places") {
  const auto least = [](const char* name) {
    const auto loaded = load_model(std::string(STEPLAP_TEST_DATA) + "/contacts/" + name + ".toml");
    const std::vector<Tipping> found = tipping_of(*loaded, equilibrium_of(*loaded).state);
    REQUIRE(found.size() == 1);
    return found.front();
  };
  const Tipping tyres = least("tyre_box"), feet = least("foot_box");
  // Both stand 2 m apart with the centre of gravity 0.98 m high: atan(1/0.98) = 45.6°, and g/0.98 = 10.0 m/s².
  CHECK(tyres.margin * 180.0 / std::numbers::pi == doctest::Approx(45.6).epsilon(1e-3));
  CHECK(tyres.acceleration == doctest::Approx(10.03).epsilon(1e-3));
  CHECK(tyres.margin == doctest::Approx(feet.margin).epsilon(1e-6));
}

TEST_CASE("one lift has one name, whatever the kind of contact") {
  for (const char* name : {"hop_foot", "hop_segment", "hop_polygon", "hop_circle"}) {
    const Report report = run_of(name);
    const Overview overview = overview_of(report);
    CHECK_MESSAGE(
        std::any_of(overview.story.begin(), overview.story.end(), [](const auto& entry) { return entry.what == StorySubject::lifts; }),
        name);
  }
}
