// Cores that hold and cores that do not: random sound ones hold, and none of them does any more once one corner, one packet or one clamp
// is bad, whatever the rest of the joint makes good in a sum.
#include "elements/step_lap/step_lap_assessment.h"
#include "mbd/io/reader.h"
#include "mbd/rest/assembly.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judge.h"
#include "tests/random/random_number.h"
#include "tests/sanitized.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <tuple>

using namespace steplap;
using steplap::random::RandomNumber;

namespace {

struct Judged {
  Model model;
  std::unique_ptr<System> system;
  RunResult result;
  Judgement judgement;

  explicit Judged(Model made) : model(std::move(made)), system(compile(model)) {
    result = simulate(*system, assembled_start(*system, assemble(model, *system)), options_of(model));
    judgement = judge(model, *system, result, "");
  }
  [[nodiscard]] Verdict verdict() const { return judgement.verdict; }
  [[nodiscard]] bool fails(const std::string& text) const {
    return std::any_of(judgement.criteria.begin(), judgement.criteria.end(),
                       [&](const CriterionResult& c) { return c.outcome > Verdict::open && c.text.find(text) != std::string::npos; });
  }
};

Judged judged_file(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return Judged(read_model(STEPLAP_TEST_DATA "/cores/" + name + ".toml", transformer_catalog(), overrides));
}

// A core on a rail that is braked by a half sine; sound: its friction bears several times what the pulse asks.
struct RandomCore {
  std::vector<std::pair<double, double>> packets; ///< width, depth, m
  double friction = 0.2, pressure = 0.1e6, bottom_pressure = 0.1e6, peak = 0.5;
  std::vector<double> shares;   ///< of the pressure, per packet; empty: 1
  double bottom_friction = 0.0; ///< 0: as above
  double transverse = 0.0;      ///< m/s², across the stack; 0: none
  std::string support = "back";
  std::vector<double> yokes; ///< of each packet, m; empty: as wide as the limb
  std::string book = "saw_tooth", direction = "across", clearance = "0.5 mm";
  bool is_mirrored = false;         ///< accelerated, not braked; the rear limb stands first
  bool is_split = false;            ///< a table for each packet
  std::string head, signals, joint; ///< more text

  explicit RandomCore(RandomNumber& random) {
    const int count = 1 + static_cast<int>(random.between(0.0, 3.99));
    for (int i = 0; i < count; ++i) packets.emplace_back(0.3 + 0.05 * i, random.between(0.05, 0.2));
    friction = random.between(0.18, 0.3);
    pressure = bottom_pressure = random.between(0.1e6, 0.3e6);
    peak = random.between(0.3, 0.9);
  }

  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    out << head
        << "[simulation]\nend = 0.2\nintegrator = \"dop853\"\ntolerance = 1e-6\n[output]\nstep = 0.02\n"
           "[[body]]\nname = \"yokes\"\nmass = \"80 t\"\ninertia = 2e5\n"
           "[[body]]\nname = \"limb A\"\nposition = ["
        << (is_mirrored ? -2.0 : 2.0) << ", 0]\n[[body]]\nname = \"limb C\"\nposition = [" << (is_mirrored ? 2.0 : -2.0)
        << ", 0]\n"
           "[[element]]\nkind = \"prismatic\"\nname = \"rail\"\na = \"yokes\"\naxis = [1.0, 0.0]\n"
           "[[signal]]\nname = \"pulse\"\nkind = \"half_sine\"\npeak = \""
        << (is_mirrored ? "" : "-") << peak
        << " gravity\"\nstart = 0.02\nduration = 0.1\n"
           "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"yokes\"\nsignal = \"pulse\"\n"
        << signals;
    if (transverse != 0.0)
      out << "[[signal]]\nname = \"side\"\nkind = \"half_sine\"\npeak = " << transverse << "\nstart = 0.02\nduration = 0.1\n";
    if (!is_split) {
      out << table("core", 0, packets.size());
      return out.str();
    }
    for (std::size_t i = 0; i < packets.size(); ++i) out << table("core " + std::to_string(i + 1), i, i + 1);
    return out.str();
  }
  // Returns a table of the packets from `first` to before `last`.
  [[nodiscard]] std::string table(const std::string& name, std::size_t first, std::size_t last) const {
    std::ostringstream out;
    const auto yoke = [&](std::size_t i) { return yokes.empty() ? packets[i].first : yokes[i]; };
    double highest = 0.0, highest_here = 0.0;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      highest = std::max(highest, yoke(i));
      if (i >= first && i < last) highest_here = std::max(highest_here, yoke(i));
    }
    out << "[[core]]\nname = \"" << name
        << "\"\nactive_part = \"yokes\"\nlimbs = [\"limb A\", \"limb C\"]\ncore_height = " << 3.0 - (highest - highest_here)
        << "\n" // the axes of all yokes are the same
        << "stacking_factor = 0.96\nsheet_thickness = \"0.27 mm\"\nsheets_per_layer = 1\nsteps = 5\nstep_pitch = \"5 mm\"\n"
        << "pitch_direction = \"" << direction << "\"\nbook = \"" << book << "\"\nclearance = \"" << clearance << "\"\npackets = [";
    for (std::size_t i = first; i < last; ++i) out << "[" << packets[i].first << ", " << packets[i].second << "], ";
    out << "]\nyoke_heights = [";
    for (std::size_t i = first; i < last; ++i) out << yoke(i) << ", ";
    out << "]\npressure = " << pressure << "\nbottom_pressure = " << bottom_pressure << "\nstatic_friction = " << friction << "\n";
    if (!shares.empty()) {
      out << "pressure_shares = [";
      for (std::size_t i = first; i < last; ++i) out << shares[i] << ", ";
      out << "]\n";
    }
    if (bottom_friction > 0.0) out << "bottom_static_friction = " << bottom_friction << "\n";
    if (transverse != 0.0) out << "transverse_acceleration = \"side\"\ntransverse_support = \"" << support << "\"\n";
    out << joint;
    return out.str();
  }
  [[nodiscard]] Judged judged() const {
    CAPTURE(text());
    return Judged(parse_model(text(), "core.toml", transformer_catalog()));
  }
};

} // namespace

TEST_CASE("sound random cores hold") {
  RandomNumber random(11);
  for (int i = 0; i < 20; ++i) {
    const RandomCore core(random);
    CAPTURE(core.text());
    const Judged run = core.judged();
    CHECK(run.verdict() == Verdict::hold);
    for (const CriterionResult& c : run.judgement.criteria) CHECK_MESSAGE(c.outcome == Verdict::hold, c.text);
  }
}

TEST_CASE("a core with one bad corner, packet or clamp does not hold") {
  RandomNumber random(12);
  for (int i = 0; i < 100; ++i) {
    RandomCore core(random);
    core.joint = "mode = \"monitor\"\n"; // what slides costs a hundred times as much and is judged the same
    const int kind = i % 5;
    switch (kind) {
    case 0: core.bottom_pressure = random.between(0.5, 500.0); break; // not clamped at the bottom
    case 1: core.bottom_friction = random.between(1e-6, 1e-3); break; // oil at the bottom
    case 2: {                                                         // one packet slack
      if (core.packets.size() < 2) core.packets.emplace_back(0.6, 0.1);
      core.shares.assign(core.packets.size(), 1.0);
      core.shares[static_cast<std::size_t>(random.between(0.0, static_cast<double>(core.packets.size()) - 0.01))] =
          random.between(1e-5, 1e-2);
      break;
    }
    case 3: { // the packets in front are lifted off: ρ b a over the stack is more than what presses it
      double depth = 0.0;
      for (const auto& packet : core.packets) depth += packet.second;
      core.transverse = 1.2 * core.pressure / (0.96 * 7650.0 * depth);
      core.packets.emplace_back(0.3, 0.05);
      break;
    }
    default: // the clamp lets go
      core.signals = "[[signal]]\nname = \"one\"\nkind = \"constant\"\nvalue = 1.0\n"
                     "[[signal]]\nname = \"less\"\nkind = \"haversine\"\npeak = -0.9999\nstart = 0.01\nduration = 0.15\n"
                     "[[signal]]\nname = \"clamp\"\nkind = \"sum\"\nsignals = [\"one\", \"less\"]\n";
      core.joint += "pressure_signal = \"clamp\"\n";
    }
    CAPTURE(kind);
    CAPTURE(core.text());
    CHECK(core.judged().verdict() > Verdict::open);
  }
}

// --- other kinds of badness ------------------------------------------------------------------------------------

namespace {

// Bad cores of a kind: fewer under the sanitizers, where each goes through the same code.
constexpr int k_bad = testing::k_is_sanitized ? 2 : 20;

// As `core` makes it bad, none holds; it may be refused at reading, too.
template <class Spoil> void expect_bad(const char* what, std::uint64_t seed, Spoil spoil) {
  RandomNumber random(seed);
  for (int i = 0; i < k_bad; ++i) {
    RandomCore core(random);
    core.joint = "mode = \"monitor\"\n";
    spoil(core, random);
    CAPTURE(what);
    CAPTURE(core.text());
    CHECK(core.judged().verdict() > Verdict::open);
  }
}

// Another order of its packets.
void shuffle(RandomCore& core, RandomNumber& random) {
  for (std::size_t i = core.packets.size(); i > 1; --i)
    std::swap(core.packets[i - 1], core.packets[static_cast<std::size_t>(random.between(0.0, static_cast<double>(i) - 0.01))]);
}

double depth_of(const RandomCore& core) {
  double depth = 0.0;
  for (const auto& packet : core.packets) depth += packet.second;
  return depth;
}

std::string joint_margins(const Judged& run, const char* front, const char* rear) {
  std::ostringstream out;
  out.precision(7); // of steps at 1e-6, sums in another order leave less than this
  for (const char* const joint : {front, rear})
    for (const JointAssessment& a : assess_joints(run.model, run.result))
      if (a.joint == joint) out << a.smallest_margin << " " << a.corner_margin.value << " " << a.part_margin.value << "\n";
  return out.str();
}

} // namespace

TEST_CASE("a core that is bad in a way of its own does not hold") {
  expect_bad("one of two limbs is pressed", 21, [](RandomCore& core, RandomNumber& random) {
    const bool is_first = random.between(0.0, 1.0) < 0.5;
    std::ostringstream share;
    share << random.between(1e-6, 1e-3);
    core.joint += "joint_pressure_shares = [" + (is_first ? share.str() + ", 1.0" : "1.0, " + share.str()) + "]\n";
  });
  expect_bad("pushed from behind the stack, held by its front", 22, [](RandomCore& core, RandomNumber&) {
    core.transverse = -1.2 * core.pressure / (0.96 * 7650.0 * depth_of(core));
    core.packets.emplace_back(0.3, 0.05);
    core.support = "front";
  });
  expect_bad("a slack packet anywhere, packets in any order, the core mirrored", 23, [](RandomCore& core, RandomNumber& random) {
    if (core.packets.size() < 2) core.packets.emplace_back(0.6, 0.1);
    shuffle(core, random);
    core.is_mirrored = random.between(0.0, 1.0) < 0.5;
    core.shares.assign(core.packets.size(), 1.0);
    core.shares[static_cast<std::size_t>(random.between(0.0, static_cast<double>(core.packets.size()) - 0.01))] =
        random.between(1e-6, 1e-2);
  });
  expect_bad("mirrored, not clamped at the bottom", 24, [](RandomCore& core, RandomNumber& random) {
    core.is_mirrored = true;
    core.bottom_pressure = random.between(0.5, 500.0);
  });
  expect_bad("all pressure relaxed", 25, [](RandomCore& core, RandomNumber& random) {
    std::ostringstream loss;
    loss.precision(10);
    loss << random.between(0.985, 0.99); // more is refused
    core.pressure = core.bottom_pressure = random.between(0.05e6, 0.1e6);
    core.joint += "pressure_loss = " + loss.str() + "\n";
  });
  expect_bad("seen from above, without gravity: not clamped at the bottom, or one packet slack", 30,
             [](RandomCore& core, RandomNumber& random) {
               core.head = "gravity = [0, 0]\n";
               if (random.between(0.0, 1.0) < 0.5) {
                 core.bottom_pressure = random.between(0.5, 500.0);
                 return;
               }
               if (core.packets.size() < 2) core.packets.emplace_back(0.6, 0.1);
               core.shares.assign(core.packets.size(), 1.0);
               core.shares[static_cast<std::size_t>(random.between(0.0, static_cast<double>(core.packets.size()) - 0.01))] =
                   random.between(1e-5, 1e-2);
             });
  expect_bad("oil between the sheets", 26, [](RandomCore& core, RandomNumber& random) { core.friction = random.between(1e-6, 1e-3); });
}

// One packet's pressure is such that it bears its weight, and the other packets bear what it lacks under the pulse: in a sum.
TEST_CASE("a packet that bears its weight, but not the pulse, does not hold") {
  RandomNumber random(31);
  for (int i = 0; i < k_bad; ++i) {
    RandomCore core(random);
    core.peak = random.between(0.75, 0.9); // the force on the limb is 1.25 to 1.35 of its weight
    core.packets.emplace_back(0.6, 0.05);
    core.joint = "mode = \"monitor\"\n";
    const double aim = random.between(0.85, 0.95); // of its share of the pulse, more than 1.06 of its weight
    const auto run_with = [&](double share) {
      core.shares.assign(core.packets.size(), 1.0);
      core.shares.back() = share;
      return core.judged();
    };
    const auto margin_of = [](const Judged& run) {
      double least = 1e300;
      for (const JointAssessment& a : assess_joints(run.model, run.result)) least = std::min(least, a.part_margin.value);
      return least;
    };
    double share = 0.01, margin = margin_of(run_with(share)), before = 0.005, margin_before = margin_of(run_with(before));
    const double rise = (margin - margin_before) / (share - before); // its capacity is linear in its pressure
    share += (aim - margin) / rise;
    const Judged run = run_with(share);
    CAPTURE(core.text());
    REQUIRE(margin_of(run) == doctest::Approx(aim).epsilon(1e-3)); // of steps at 1e-6
    CHECK(run.verdict() == Verdict::inspect);
    CHECK(run.fails("each packet of sheets holds its share of the load"));
    CHECK(!run.fails("the step-lap joint holds"));
    share += (aim * 1.6 - aim) / rise;
    CHECK(run_with(share).verdict() == Verdict::hold);
  }
}

// The upper corner is sound, of the lower one a thousandth of the overlap is left, and less.
TEST_CASE("a joint with a sliver of overlap at one corner does not hold") {
  RandomNumber random(27);
  for (int i = 0; i < k_bad; ++i) {
    const double width = random.between(0.0, 1e-4), high = random.between(0.5, 1.5), reach = random.between(0.1, 0.6);
    std::ostringstream out;
    out << "[simulation]\nend = 0.2\nintegrator = \"dop853\"\ntolerance = 1e-6\n[output]\nstep = 0.02\n"
           "[[body]]\nname = \"yoke\"\nmass = 50000\ninertia = 5e4\n[[body]]\nname = \"limb\"\nmass = 5000\ninertia = 5000\n"
           "[[element]]\nkind = \"prismatic\"\nname = \"rail\"\na = \"yoke\"\naxis = [1.0, 0.0]\n"
           "[[signal]]\nname = \"pulse\"\nkind = \"half_sine\"\npeak = -3.0\nstart = 0.02\nduration = 0.1\n"
           "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"yoke\"\nsignal = \"pulse\"\n"
           "[[element]]\nkind = \"step_lap_joint\"\nname = \"j\"\nlimb = \"limb\"\nactive_part = \"yoke\"\nmode = \"monitor\"\n";
    for (const bool is_top : {true, false}) {
      const double edge = is_top ? high : -high, lap = is_top ? 0.1 : width, side = is_top ? 1.0 : -1.0;
      out << "[[element]]\nkind = \"step_lap_interface\"\nname = \"" << (is_top ? "top" : "bottom") << "\"\njoint = \"j\"\n";
      const double y0 = edge, y1 = edge + side * 0.3, l0 = edge - side * 0.3, l1 = edge + side * lap;
      for (const auto& [sheet, a, b] : {std::tuple{"yoke", y0, y1}, std::tuple{"limb", l0, l1}})
        out << sheet << " = [[" << -reach << ", " << std::min(a, b) << "], [" << reach << ", " << std::min(a, b) << "], [" << reach << ", "
            << std::max(a, b) << "], [" << -reach << ", " << std::max(a, b) << "]]\n";
      out << "pressure = 1e5\nstatic_friction = 0.2\ncount = 800\n";
    }
    CAPTURE(out.str());
    const Judged run(parse_model(out.str(), "joint.toml", transformer_catalog()));
    CHECK(run.verdict() > Verdict::open);
  }
}

TEST_CASE("a packet of sheets that nothing holds is refused") {
  RandomNumber random(28);
  const auto refusal = [](const RandomCore& core) -> std::string {
    try {
      (void)parse_model(core.text(), "core.toml", transformer_catalog());
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  };
  for (int i = 0; i < k_bad; ++i) {
    const RandomCore sound(random);
    CAPTURE(sound.text());
    REQUIRE(refusal(sound) == "");
    { // Its mitre is steep: s cos α, s = 5 mm, is 3.5 mm at 45° and 2.2 mm where the yoke is twice as high as the limb is wide.
      RandomCore core = sound;
      core.packets = {{0.3, random.between(0.05, 0.2)}, {0.6, random.between(0.05, 0.2)}};
      core.yokes = {0.6, 0.6};
      core.direction = "along_limb";
      core.book = "zig_zag";
      core.clearance = "3 mm";
      CHECK(refusal(core).find("no two layers of packet 1 overlap at an outer limb") != std::string::npos);
      core.clearance = "1 mm";
      CHECK(refusal(core) == "");
    }
    { // A duct lies between any two of its layers; the last one left out, two layers overlap.
      RandomCore core = sound;
      const double sheet = 0.27e-3 / 0.96, front = core.packets.front().second;
      core.packets.resize(1);
      core.packets.emplace_back(0.3, 5.5 * sheet);
      std::ostringstream ducts;
      ducts.precision(12);
      for (int k = 1; k < 4; ++k) ducts << "[" << front + k * sheet << ", 0.003], ";
      core.joint = "ducts = [" + ducts.str() + "]\n";
      CHECK(refusal(core) == "");
      ducts << "[" << front + 4 * sheet << ", 0.003]";
      core.joint = "ducts = [" + ducts.str() + "]\n";
      CHECK(refusal(core).find("no two layers of packet 2 overlap at an outer limb") != std::string::npos);
    }
    { // It is thinner than a book.
      RandomCore core = sound;
      core.packets.emplace_back(0.6, random.between(0.1e-3, 1.3e-3));
      CHECK(refusal(core).find("holds no book of 5 layers") != std::string::npos);
    }
  }
}

TEST_CASE("a mirrored core bears what the core bears, limb by limb, whatever the order of its packets") {
  RandomNumber random(29);
  for (int i = 0; i < k_bad; ++i) {
    RandomCore core(random);
    CAPTURE(core.text());
    const Judged as_drawn = core.judged();
    core.is_mirrored = true;
    const Judged mirrored = core.judged();
    CHECK(mirrored.verdict() == as_drawn.verdict());
    CHECK(joint_margins(mirrored, "limb A joint", "limb C joint") == joint_margins(as_drawn, "limb A joint", "limb C joint"));
    core.is_mirrored = false;
    shuffle(core, random);
    CHECK(core.judged().verdict() == as_drawn.verdict());
  }
}

// Where packets are in tables of their own nothing is said of how they touch: as with a duct between them.
TEST_CASE("packets in tables of their own are one limb: the same mass, margins and verdict as in one table") {
  RandomNumber random(33);
  int rejected = 0;
  for (int i = 0; i < k_bad; ++i) {
    RandomCore core(random);
    if (core.packets.size() < 2) core.packets.emplace_back(0.6, 0.1);
    core.is_mirrored = i % 2 == 1;
    if (i % 3 != 0) { // one packet slack: what the others make good in a sum
      core.shares.assign(core.packets.size(), 1.0);
      core.shares[i % core.packets.size()] = random.between(0.05, 0.3);
    }
    const std::string fields = i % 4 == 3 ? "mode = \"monitor\"\n" : "";
    std::ostringstream ducts;
    double depth = 0.0;
    for (std::size_t p = 0; p + 1 < core.packets.size(); ++p) ducts << "[" << (depth += core.packets[p].second) << ", 0.005], ";
    core.joint = fields + "ducts = [" + ducts.str() + "]\n";
    CAPTURE(core.text());
    const Judged one = core.judged();
    core.joint = fields;
    core.is_split = true;
    CAPTURE(core.text());
    const Judged several = core.judged();
    for (const char* name : {"limb A", "limb C"}) {
      const Body &a = *one.model.find_body(name), &b = *several.model.find_body(name);
      CHECK(b.mass == doctest::Approx(a.mass).epsilon(1e-12)); // sums in another order
      CHECK(b.inertia == doctest::Approx(a.inertia).epsilon(1e-12));
      CHECK((b.cg - a.cg).norm() < 1e-12);
    }
    CHECK(joint_margins(several, "limb A joint", "limb C joint") == joint_margins(one, "limb A joint", "limb C joint"));
    CHECK(several.verdict() == one.verdict());
    CHECK(several.fails("each packet of sheets holds its share") == one.fails("each packet of sheets holds its share"));
    if (one.fails("each packet of sheets holds its share")) ++rejected;
  }
  CHECK(rejected > 0);
  CHECK(rejected < k_bad);
}

TEST_CASE("cores that were called good") {
  SUBCASE("the third of three packets is lifted off") {
    const Judged run = judged_file("packet_lifted_off");
    CHECK(run.verdict() == Verdict::reject);
    CHECK(run.fails("every interface is pressed"));
    CHECK(run.fails("each packet of sheets holds its share of the load"));
  }
  SUBCASE("the bottom corner has no overlap") {
    const Judged run = judged_file("corner_without_overlap");
    CHECK(run.verdict() == Verdict::reject);
    CHECK(run.fails("no corner parts"));
  }
  SUBCASE("the bottom corner is clamped by 1 Pa") {
    const Judged run = judged_file("corner_not_clamped");
    CHECK(run.verdict() >= Verdict::inspect);
    CHECK(run.fails("each corner holds its share"));
  }
  SUBCASE("a joint that slid is not met, whatever the error of its margin") {
    const Judged run = judged_file("slides_far");
    CHECK(run.verdict() >= Verdict::inspect);
    for (const CriterionResult& c : run.judgement.criteria)
      if (c.text.find("the step-lap joint holds") == 0) CHECK(!c.reserve);
  }
}

TEST_CASE("pressures that begin with the run") {
  for (const char* const name : {"pressure_from_the_start", "pressure_as_a_sum"}) {
    CAPTURE(name);
    const Model model = read_model(STEPLAP_TEST_DATA "/cores/" + std::string(name) + ".toml", transformer_catalog());
    const auto system = compile(model);
    SimulationOptions options = options_of(model);
    options.end = 0.01;
    const RunResult run = simulate(*system, system->initial_state(), options);
    CHECK(run.trajectory->series("j.pressure").front() == doctest::Approx(1.5e5).epsilon(1e-12));
  }
}

TEST_CASE("a tie that is meant to go first") {
  const std::string soon = "simulation.end=0.06", weak = "element.resin.strength=1"; // the pulse begins at 0.05 s
  CHECK(judged_file("tie_that_breaks_first", {soon, weak}).verdict() == Verdict::reject);
  CHECK(judged_file("tie_that_breaks_first", {soon, weak, "element.resin.consequence=inspect"}).verdict() == Verdict::inspect);
  CHECK(judged_file("tie_that_breaks_first", {soon, weak, "element.resin.consequence=none"}).verdict() == Verdict::hold);
}

TEST_CASE("a run that asks nothing of a joint does not show that it holds") {
  RandomNumber random(13);
  RandomCore core(random);
  core.peak = 1e-6;
  const Judged quiet = core.judged();
  CHECK(quiet.judgement.so_far == Verdict::hold);
  CHECK(quiet.verdict() == Verdict::open);
  REQUIRE(quiet.judgement.caps.size() == 2); // either limb
  core.peak = 0.3;
  CHECK(core.judged().judgement.caps.empty());
}
