// Verdicts and extremes do not hang on what is written, nor how often: every model of models/, and exact extremes of
// motions that are known.
#include "mbd/base/number_text.h"
#include "mbd/io/presentation.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judge.h"
#include "tests/random/random_number.h"
#include "tests/sanitized.h"
#include "tests/transformer/swing.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

using namespace steplap;

namespace {

struct Ran {
  Model model;
  std::unique_ptr<System> system;
  RunResult result;
  std::string failure;
  Judgement judgement;

  explicit Ran(Model model_) : model(std::move(model_)), system(compile(model)) {
    check_presentation(model, *system);
    Simulation simulation(*system, system->initial_state(), options_of(model));
    try {
      simulation.run();
    } catch (const NumericalFailure& f) {
      failure = f.what();
    }
    result = std::move(simulation).result();
    judgement = judge(model, *system, result, failure);
  }
  [[nodiscard]] const ChannelRange& range(const std::string& channel) const {
    const auto found =
        std::find_if(result.ranges.begin(), result.ranges.end(), [&](const ChannelRange& r) { return r.channel->name == channel; });
    REQUIRE(found != result.ranges.end());
    return *found;
  }
};

Ran run_text(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return Ran(parse_model(text, "a.toml", transformer_catalog(), overrides));
}

// The same double, not-a-number included.
bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void compare(const Ran& a, const Ran& b) {
  CHECK(a.failure == b.failure);
  CHECK(a.judgement.verdict == b.judgement.verdict);
  CHECK(a.judgement.so_far == b.judgement.so_far);
  REQUIRE(a.judgement.criteria.size() == b.judgement.criteria.size());
  for (std::size_t i = 0; i < a.judgement.criteria.size(); ++i) {
    const CriterionResult &x = a.judgement.criteria[i], &y = b.judgement.criteria[i];
    CAPTURE(x.name);
    CHECK(x.outcome == y.outcome);
    CHECK(is_same(x.value.value_or(0.0), y.value.value_or(0.0)));
  }
  REQUIRE(a.result.ranges.size() == a.system->channels.size());
  REQUIRE(a.result.ranges.size() == b.result.ranges.size());
  for (std::size_t c = 0; c < a.result.ranges.size(); ++c) {
    const ChannelRange &x = a.result.ranges[c], &y = b.result.ranges[c];
    CAPTURE(x.channel->name);
    // Not to a tolerance: what is looked at depends on the steps alone.
    const bool is_equal =
        is_same(x.low.value, y.low.value) && is_same(x.high.value, y.high.value) && is_same(x.first, y.first) && is_same(x.final, y.final);
    CHECK(is_equal);
  }
}

// Long or costly runs are cut off: what is compared is the same motion under different outputs.
double shortened(const std::string& name, double end) {
  if (name.starts_with("andrews")) return std::min(end, 0.005);
  const bool is_large = name.starts_with("chain") || name.starts_with("grid") || name.starts_with("four_bar");
  return std::min(end, is_large ? 0.1 : 0.3);
}

} // namespace

TEST_CASE("every model: the same verdict and extremes whatever is written, and how often") {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(STEPLAP_MODELS))
    if (entry.path().extension() == ".toml" && entry.path().parent_path().filename() != "studies") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() > 30);
  for (std::size_t i = 0; i < files.size(); i += steplap::testing::k_is_sanitized ? 3 : 1) {
    const fs::path& file = files[i];
    CAPTURE(file.string());
    const auto with = [&](double step, const std::vector<std::string>& channels) {
      Model model = read_model(file.string(), transformer_catalog());
      model.simulation.end = shortened(file.filename().string(), model.simulation.end);
      model.output.step = std::min(step, model.simulation.end);
      model.output.channels = channels;
      return Ran(std::move(model));
    };
    const Ran fine = with(1e-4, {});
    compare(fine, with(1e-3, {"no channel has this name"}));
    compare(fine, with(0.1, {"*.x"}));
  }
}

namespace {

// A mass on a spring, x = 0.1 sin(ω t), ω = √(k/m) = 50 1/s: samples every 0.04 s are three to a period.
const std::string k_oscillator = swing("[simulation]\nend = 1\n[output]\nstep = 0.04\n", "5", "2500");

} // namespace

TEST_CASE("extremes are the motion's, not the samples'") {
  for (const char* method : {"\"rk4\"", "\"dop853\"", "\"tsit5\"", "\"rodas5p\"", "\"auto\""}) {
    CAPTURE(std::string(method));
    std::vector<std::string> overrides{"simulation.integrator=" + std::string(method)};
    overrides.emplace_back(method == std::string("\"rk4\"") ? "simulation.step=2e-4" : "simulation.tolerance=1e-9");
    const Ran run = run_text(k_oscillator, overrides);
    // Located to 1e-6 of the range (ExtremeFinder::k_resolution); the run's own error is below 1e-7 of it.
    CHECK(run.range("mass.x").high.value == doctest::Approx(0.1).epsilon(2e-6));
    CHECK(run.range("mass.x").low.value == doctest::Approx(-0.1).epsilon(2e-6));
    CHECK(run.range("mass.vx").high.value == doctest::Approx(5.0).epsilon(2e-6));
    CHECK(run.range("mass.ax").high.value == doctest::Approx(250.0).epsilon(2e-6));
    CHECK(run.range("spring.force").low.value == doctest::Approx(-250.0).epsilon(2e-6));
  }
}

TEST_CASE("a load that rises and falls within a step of a body at rest is seen") {
  // Held fast, so that no error limits the step: 8 periods and a half of the load, largest 3 + 2 N.
  const Ran run = run_text(R"(
gravity = [0, 0]
[simulation]
end = 0.85
[output]
step = 0.85
[[body]]
name = "mass"
mass = 1
inertia = 1
[[signal]]
name = "wave"
kind = "harmonics"
offset = 3
amplitudes = [2]
frequencies = [10]
[[element]]
kind = "weld"
name = "hold"
a = "mass"
[[element]]
kind = "load"
name = "push"
at = "mass"
force_x = "wave"
)");
  CHECK(run.range("hold.force_x").low.value == doctest::Approx(-5.0).epsilon(1e-6));
  CHECK(run.range("hold.force_x").high.value == doctest::Approx(-1.0).epsilon(1e-6));
}

TEST_CASE("the least reaction of a pin is found where one component passes zero, within a step of a body at rest") {
  // R = |(x(t), y(t) − m g)|: where x passes zero, R has a kink that is as narrow as y − m g is small.
  random::RandomNumber random(5);
  for (int n = 0; n < 40; ++n) {
    struct Pulse {
      double peak, start, duration;
      [[nodiscard]] double at(double t) const {
        return t > start && t < start + duration ? peak * std::sin(std::numbers::pi * (t - start) / duration) : 0.0;
      }
    };
    const Pulse first{random.between(50.0, 150.0), 0.0, random.between(1.0, 3.0)};
    const Pulse second{-random.between(100.0, 300.0), random.between(0.2, 1.5), random.between(0.3, 1.0)};
    const double weight = random.between(1.0, 10.0);
    const auto signal = [](const char* name, const Pulse& p) {
      return "[[signal]]\nname = \"" + std::string(name) + "\"\nkind = \"half_sine\"\npeak = " + number_text(p.peak) +
             "\nstart = " + number_text(p.start) + "\nduration = " + number_text(p.duration) + "\n";
    };
    const Ran ran =
        run_text("gravity = [0.0, " + number_text(-weight) + "]\n[simulation]\nend = 4.0\n[output]\nalso = [\"pin.reaction\"]\n" +
                 "[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\n[[element]]\nkind = \"revolute\"\nname = \"pin\"\na = "
                 "\"b\"\n" +
                 signal("s", first) + signal("s2", second) +
                 "[[signal]]\nname = \"x\"\nkind = \"sum\"\nsignals = [\"s\", \"s2\"]\n[[element]]\nkind = \"load\"\nname = "
                 "\"push\"\nat = \"b\"\nforce_x = \"x\"\n");
    double least = weight, most = weight;
    constexpr int k_samples = 400000; // 1e-5 s apart: within 1e-5 s · 1000 N/s of the least, where its square is flat
    for (int i = 0; i <= k_samples; ++i) {
      const double t = 4.0 * i / k_samples, x = first.at(t) + second.at(t), r = std::hypot(x, weight);
      least = std::min(least, r);
      most = std::max(most, r);
    }
    const ChannelRange& found = ran.range("pin.reaction");
    CAPTURE(n);
    CHECK(std::abs(found.low.value - least) < 1e-5 * most);
    CHECK(std::abs(found.high.value - most) < 1e-5 * most);
  }
}

TEST_CASE("a knock shorter than the output step counts") {
  // Two balls of 1 kg, one at 1 m/s: with stiffness k the contact's force is v √(k m/2), over π √(m/(2k)) = 0.7 ms.
  const std::string knock = R"(
gravity = [0, 0]
[simulation]
end = 0.2
tolerance = 1e-9
[output]
step = 0.05
[[body]]
name = "one"
mass = 1
inertia = 1
velocity = [1, 0]
[[body]]
name = "two"
mass = 1
inertia = 1
position = [0.3, 0]
[[element]]
kind = "circle_contact"
name = "knock"
a = "one"
b = "two"
radius_a = 0.1
radius_b = 0.1
stiffness = 1e7
[[acceptance]]
name = "knocks"
channel = "knock.force"
at_most = "1 kN"
consequence = "reject"
)";
  const Ran run = run_text(knock);
  CHECK(run.judgement.verdict == Verdict::reject);
  CHECK(run.range("knock.force").high.value == doctest::Approx(std::sqrt(0.5e7)).epsilon(2e-6));
  const double contact = 0.1 + 0.5 * M_PI * std::sqrt(0.5e-7); // it touches at 0.1 s, is closest a quarter of a period later
  CHECK(run.range("knock.force").high.t == doctest::Approx(contact).epsilon(1e-5));
}

TEST_CASE("a run that ends between samples has its last row") {
  const Ran run = run_text(k_oscillator, {"simulation.end=0.99", "simulation.tolerance=1e-9"});
  CHECK(run.result.trajectory->times().back() == 0.99);
  CHECK(run.result.trajectory->series("mass.x").back() == doctest::Approx(0.1 * std::sin(50.0 * 0.99)).epsilon(1e-6));
  CHECK(run.range("mass.x").final == run.result.trajectory->series("mass.x").back());
  // One that ends on the grid has no row more.
  CHECK(run_text(k_oscillator).result.trajectory->size() == 26);
}

TEST_CASE("a joint that comes apart between samples: the last row is at the event") {
  const Ran run(read_model(std::string(STEPLAP_MODELS) + "/layouts/joint_apart.toml", transformer_catalog(), {"output.step=0.1"}));
  REQUIRE_FALSE(run.result.stop_reason.empty());
  CHECK(run.result.trajectory->times().back() == run.result.events.back().t);
  CHECK(run.judgement.verdict == Verdict::reject);
}

// Where its joints begin to slide and hold again, what they bear turns within a step: no polynomial goes through that, and sections
// follow it, of one channel 40 looks at the motion. More channels with the same curve take no more of them, and find the same.
TEST_CASE("channels with one kink are followed by the same looks") {
  const Model model = read_model(STEPLAP_MODELS "/paper/weak_clamping.toml", transformer_catalog(),
                                 {"simulation.integrator=dop853", "simulation.tolerance=1e-6", "simulation.end=0.13"});
  const auto run_with = [&model](const std::string& name, std::size_t copies) {
    std::unique_ptr<System> system = compile(model);
    for (Channel& c : system->channels) c.has_extremes = c.name == name;
    const auto channel = std::find_if(system->channels.begin(), system->channels.end(), [&](const Channel& c) { return c.name == name; });
    REQUIRE(channel != system->channels.end());
    const Channel copied = *channel;
    for (std::size_t i = 0; i < copies; ++i) {
      system->channels.push_back(copied);
      system->channels.back().name += " " + std::to_string(i);
    }
    Simulation simulation(*system, system->initial_state(), options_of(model));
    simulation.run();
    RunResult result = std::move(simulation).result();
    std::erase_if(result.ranges,
                  [&](const ChannelRange& r) { return r.channel->name != name && !r.channel->name.starts_with(name + ' '); });
    for (ChannelRange& range : result.ranges) range.channel = nullptr; // of a system that goes now
    return std::pair(result.statistics.evaluations, std::move(result.ranges));
  };
  for (const std::string name : {"front joint.fx", "front joint.u", "back joint.m"}) {
    CAPTURE(name);
    const auto [alone, range] = run_with(name, 0);
    const auto [together, ranges] = run_with(name, 3);
    CHECK(together == alone);
    REQUIRE(ranges.size() == 4);
    for (const ChannelRange& r : ranges) {
      CHECK(r.low.value == range.front().low.value);
      CHECK(r.high.value == range.front().high.value);
      CHECK(r.low.t == range.front().low.t);
      CHECK(r.high.t == range.front().high.t);
    }
  }
}
