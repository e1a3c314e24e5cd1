// Starts that contradict what the file says: each sort is found by its code, and sound ones say nothing.
#include "mbd/run/findings.h"
#include "mbd/run/run.h"
#include "tests/random/random_number.h"
#include "tests/tools/steplap/workbench.h"
#include "transformer/program.h"

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <numbers>
#include <set>

using namespace steplap;
using namespace steplap::testing;
using Random = steplap::random::RandomNumber;

namespace {

constexpr double k_g = 9.81;

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}
std::string point(double x, double y) { return "[" + number(x) + ", " + number(y) + "]"; }
std::string element(const std::string& kind, const std::string& name, const std::string& fields) {
  return "[[element]]\nkind = \"" + kind + "\"\nname = \"" + name + "\"\n" + fields + "\n";
}

// A box of any size over the line y = 0, on two feet or an outline; `up`: how far its bottom is above it.
struct Box {
  double half, high, mass, inertia_share = 1.0, weight, sag;

  explicit Box(Random& random) {
    half = random.decades(-3.0, 3.0);
    high = half * random.between(0.3, 2.0);
    mass = random.decades(-2.0, 4.0);
    weight = mass * k_g;
    sag = half * random.decades(-5.0, -3.0);
  }
  [[nodiscard]] double size() const { return std::sqrt((half * half + high * high) / 3.0); }
  [[nodiscard]] double stiffness() const { return 0.5 * weight / sag; } // of a foot
  [[nodiscard]] std::string body(double up, const std::string& name = "box", double x = 0.0) const {
    return "[[body]]\nname = \"" + name + "\"\nmass = " + number(mass) + "\ninertia = " + number(inertia_share * mass * size() * size()) +
           "\nposition = " + point(x, high + up) + "\noutline = [" + point(-half, -high) + ", " + point(half, -high) + ", " +
           point(half, high) + ", " + point(-half, high) + "]\n";
  }
  [[nodiscard]] std::string foot(const std::string& name, double x, const std::string& more = "") const {
    return element("unilateral_contact", name,
                   "a = { body = \"box\", point = " + point(x, -high) + " }\nstiffness = " + number(stiffness()) +
                       "\ndamping = " + number(0.2 * std::sqrt(stiffness() * mass)) + "\n" + more);
  }
  [[nodiscard]] std::string feet(const std::string& more = "") const { return foot("left", -half, more) + foot("right", half, more); }
};

struct Codes {
  std::set<std::string> warnings, notes;
};
Codes codes_of(const std::string& text) {
  static const Workbench bench;
  const auto loaded = load_model(bench.write("start.toml", "[simulation]\nend = 1.0\n" + text), {});
  Codes codes;
  for (const Finding& finding : findings_of(*loaded)) {
    (finding.level == FindingLevel::warning ? codes.warnings : codes.notes).insert(finding.code);
    CHECK(finding.text.size() > 20);
    if (finding.level == FindingLevel::note || finding.code.rfind("start", 0) == 0) CHECK(finding.where.line > 0);
  }
  return codes;
}
const std::set<std::string> k_none;

// An arm on a pin, which leans on a stop; `beyond`: how far the stop lies on the other side of it, rad.
std::string arm(Random& random, double beyond) {
  const double length = random.decades(-3.0, 3.0), mass = random.decades(-2.0, 4.0), angle = random.between(-0.5, 0.5);
  const double moment = mass * k_g * 0.5 * length * std::cos(angle), stiffness = moment / 1e-4;
  return "[[body]]\nname = \"arm\"\nmass = " + number(mass) + "\ninertia = " + number(mass * length * length / 12.0) +
         "\nposition = " + point(0.5 * length * std::cos(angle), 0.5 * length * std::sin(angle)) + "\nangle = " + number(angle) + "\n" +
         element("revolute", "pin", "a = { body = \"arm\", point = " + point(-0.5 * length, 0.0) + " }\nb = \"ground\"") +
         element("limit", "stop", "a = \"arm\"\ncoordinate = \"angle\"\nlower = " + number(beyond) + "\nstiffness = " + number(stiffness));
}

} // namespace

TEST_CASE("what begins deep in a contact is found, whatever the contact, and what lies on it is not") {
  Random random(1);
  for (int i = 0; i < 150; ++i) {
    CAPTURE(i);
    const Box box(random);
    const double deep = box.sag * random.between(15.0, 100.0);
    const std::string outline =
        element("polygon_contact", "face", "a = \"box\"\nstiffness = " + number(box.weight / (box.sag * 2.0 * box.half)));
    const std::string wheel =
        element("segment_contact", "wheel",
                "a = { body = \"box\", point = [0.0, 0.0] }\nradius = " + number(box.high) + "\nfrom = " + point(-9.0 * box.half, 0.0) +
                    "\nto = " + point(9.0 * box.half, 0.0) + "\nstiffness = " + number(2.0 * box.stiffness()));
    for (const std::string& contact : {box.feet(), outline, wheel}) {
      CAPTURE(contact);
      CHECK(codes_of(box.body(-deep) + contact).warnings == std::set<std::string>{"starts_deep"});
      const Codes sound = codes_of(box.body(-box.sag) + contact), touching = codes_of(box.body(0.0) + contact);
      CHECK(sound.warnings == k_none);
      CHECK(sound.notes == k_none);
      CHECK(touching.warnings == k_none);
      CHECK(touching.notes == k_none);
    }
  }
}

TEST_CASE("a box that hovers over its feet is noted with the gap, one that is dropped or lies is not") {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    CAPTURE(i);
    const Box box(random);
    CHECK(codes_of(box.body(box.size() * random.between(0.01, 0.4)) + box.feet()).notes == std::set<std::string>{"restless_start"});
    CHECK(codes_of(box.body(box.size() * random.between(1.0, 4.0)) + box.feet()).notes == k_none);
  }
}

TEST_CASE("a gap, an interference or a preload that the poses contradict is found") {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    CAPTURE(i);
    const Box box(random);
    const double up = box.size() * random.between(0.05, 3.0), gap = up * (random.chance(0.5) ? 0.5 : 2.0);
    const std::set<std::string> found{"gap_contradicts_poses"};
    CHECK(codes_of(box.body(up) + box.feet("gap = " + number(gap))).warnings == found);
    CHECK(codes_of(box.body(up) + box.feet("preload = " + number(0.5 * box.weight))).warnings == found);
    CHECK(codes_of(box.body(up) + box.feet("interference = " + number(box.sag))).warnings == found);
    CHECK(codes_of(box.body(up) + box.feet("gap = " + number(up))).warnings == k_none);
    CHECK(codes_of(box.body(0.0) + box.feet("preload = " + number(0.5 * box.weight))).warnings == k_none);
    CHECK(codes_of(box.body(-box.sag) + box.feet("interference = " + number(box.sag))).warnings == k_none);
    // A preload without its answer throws the box up.
    CHECK(codes_of(box.body(0.0) + box.feet("preload = " + number(20.0 * box.weight))).warnings == std::set<std::string>{"starts_deep"});
  }
}

TEST_CASE("a foot beside its face is found, unless another face carries it") {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    CAPTURE(i);
    const Box box(random);
    const double beside = box.half * random.between(0.1, 2.5), up = random.chance(0.5) ? 0.0 : 0.1 * box.size();
    const auto face = [&](double low, double high) { return "ends = " + point(low, high); };
    const std::string away = box.foot("left", -box.half, face(-box.half + beside, 9.0 * box.half)) +
                             box.foot("right", box.half, face(-2.0 * box.half, box.half - beside));
    CHECK(codes_of(box.body(up) + away).warnings.count("foot_beside_face") == 1);
    CHECK(codes_of(box.body(0.0) + box.feet(face(-1.5 * box.half, 1.5 * box.half))).warnings == k_none);
    // Two faces in a row: each foot is on one of them.
    std::string row;
    for (const double x : {-box.half, box.half})
      for (const bool is_left : {true, false})
        row += box.foot((x < 0.0 ? "left on " : "right on ") + std::string(is_left ? "1" : "2"), x,
                        is_left ? face(-9.0 * box.half, 0.0) : face(0.0, 9.0 * box.half));
    CHECK(codes_of(box.body(0.0) + row).warnings == k_none);
  }
}

TEST_CASE("an inertia that no such outline has is found") {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    Box box(random);
    box.inertia_share = random.decades(-1.5, 0.4); // from a fifth of the plate's radius of gyration to the frame's
    CHECK(codes_of(box.body(0.0) + box.feet()).warnings == k_none);
    box.inertia_share = random.chance(0.5) ? random.decades(-6.0, -2.1) : random.decades(0.9, 6.0);
    CHECK(codes_of(box.body(0.0) + box.feet()).warnings.count("inertia_unlike_outline") == 1);
  }
}

TEST_CASE("what begins beyond a stop is found, what leans on one or is free of it is not") {
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    CHECK(codes_of(arm(random, random.between(0.001, 0.5))).warnings == std::set<std::string>{"starts_beyond_stop"});
    CHECK(codes_of(arm(random, 1e-4)).warnings == k_none); // bears its weight
    CHECK(codes_of(arm(random, 0.0)).warnings == k_none);
    CHECK(codes_of(arm(random, -random.between(0.001, 0.5))).warnings == k_none);
  }
}

TEST_CASE("no model of this project begins in contradiction") {
  int models = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(STEPLAP_MODELS)) {
    if (file.path().extension() != ".toml" || file.path().parent_path().filename() == "studies") continue;
    CAPTURE(file.path().string());
    const auto loaded = load_model(file.path().string(), {});
    for (const Finding& finding : start_findings(*loaded)) FAIL_CHECK(finding.code << ": " << finding.text);
    ++models;
  }
  CHECK(models > 40);
}

TEST_CASE("check lists each contact's gap, force and place, and findings with file and line") {
  const Workbench bench;
  Random random(7);
  const Box box(random);
  const std::string file = bench.write("deep.toml", "[simulation]\nend = 1.0\n" + box.body(-50.0 * box.sag) + box.feet());
  const Outcome outcome = steplap_does({"check", file});
  CAPTURE(outcome.out);
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "contact at the start  between"));
  CHECK(has(outcome.out, "left                  box, ground  -"));
  CHECK(has(outcome.out, "warning: 'left' begins pressed "));
  CHECK(has(outcome.out, "deep.toml:9)"));
  const Outcome run = steplap_does({"simulate", file, "-o", bench.at("out"), "--no-estimate"});
  CHECK(has(run.err, "'left' begins pressed "));
}
