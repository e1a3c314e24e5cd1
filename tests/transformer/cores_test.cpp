// Cores that hold and cores that do not: random sound ones hold, and none of them does any more once one corner, one packet or one clamp
// is bad, whatever the rest of the joint makes good in a sum.
#include "mbd/acceptance/judge.h"
#include "mbd/analysis/assembly.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "tests/random/random_number.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>

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
    return std::any_of(judgement.criteria.begin(), judgement.criteria.end(), [&](const CriterionResult& c) {
      return c.outcome > Verdict::open && c.text.find(text) != std::string::npos;
    });
  }
};

Judged judged_file(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return Judged(read_model(STEPLAP_TEST_DATA "/cores/" + name + ".toml", transformer_catalog(), overrides));
}

// A core on a rail that is braked by a half sine; sound: its friction bears several times what the pulse asks.
struct RandomCore {
  std::vector<std::pair<double, double>> packets; ///< width, depth, m
  double friction = 0.2, pressure = 0.1e6, bottom_pressure = 0.1e6, peak = 0.5;
  std::vector<double> shares;      ///< of the pressure, per packet; empty: 1
  double bottom_friction = 0.0;    ///< 0: as above
  double transverse = 0.0;         ///< m/s², across the stack; 0: none
  std::string signals, joint;      ///< more text

  explicit RandomCore(RandomNumber& random) {
    const int count = 1 + static_cast<int>(random.between(0.0, 3.99));
    for (int i = 0; i < count; ++i) packets.emplace_back(0.3 + 0.05 * i, random.between(0.05, 0.2));
    friction = random.between(0.18, 0.3);
    pressure = bottom_pressure = random.between(0.1e6, 0.3e6);
    peak = random.between(0.3, 0.9);
  }

  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    out << "[simulation]\nend = 0.2\nintegrator = \"dop853\"\ntolerance = 1e-6\n[output]\nstep = 0.02\n"
           "[[body]]\nname = \"yokes\"\nmass = \"80 t\"\ninertia = 2e5\n"
           "[[body]]\nname = \"limb A\"\nposition = [2.0, 0]\n[[body]]\nname = \"limb C\"\nposition = [-2.0, 0]\n"
           "[[element]]\nkind = \"prismatic\"\nname = \"rail\"\na = \"yokes\"\naxis = [1.0, 0.0]\n"
           "[[signal]]\nname = \"pulse\"\nkind = \"half_sine\"\npeak = \"-" << peak << " gravity\"\nstart = 0.02\nduration = 0.1\n"
           "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"yokes\"\nsignal = \"pulse\"\n" << signals;
    if (transverse != 0.0)
      out << "[[signal]]\nname = \"side\"\nkind = \"half_sine\"\npeak = " << transverse << "\nstart = 0.02\nduration = 0.1\n";
    out << "[[core]]\nname = \"core\"\nactive_part = \"yokes\"\nlimbs = [\"limb A\", \"limb C\"]\ncore_height = 3.0\n"
           "stacking_factor = 0.96\nsheet_thickness = \"0.27 mm\"\nsheets_per_layer = 1\nsteps = 5\nstep_pitch = \"5 mm\"\npitch_direction = \"across\"\nbook = \"saw_tooth\"\nclearance = \"0.5 mm\"\n"
           "packets = [";
    for (const auto& [width, depth] : packets) out << "[" << width << ", " << depth << "], ";
    out << "]\nyoke_heights = [";
    for (const auto& packet : packets) out << packet.first << ", ";
    out << "]\npressure = " << pressure << "\nbottom_pressure = " << bottom_pressure << "\nstatic_friction = " << friction << "\n";
    if (!shares.empty()) {
      out << "pressure_shares = [";
      for (const double share : shares) out << share << ", ";
      out << "]\n";
    }
    if (bottom_friction > 0.0) out << "bottom_static_friction = " << bottom_friction << "\n";
    if (transverse != 0.0) out << "transverse_acceleration = \"side\"\ntransverse_support = \"back\"\n";
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
    case 2: { // one packet slack
      if (core.packets.size() < 2) core.packets.emplace_back(0.6, 0.1);
      core.shares.assign(core.packets.size(), 1.0);
      core.shares[static_cast<std::size_t>(random.between(0.0, static_cast<double>(core.packets.size()) - 0.01))] = random.between(1e-5, 1e-2);
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

TEST_CASE("cores that were called good") {
  SUBCASE("the third of three packets is lifted off") {
    const Judged run = judged_file("packet_lifted_off");
    CHECK(run.verdict() == Verdict::reject);
    CHECK(run.fails("every interface is pressed"));
    CHECK(run.fails("each packet of sheets holds its own weight"));
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
