// Samples side by side (mbd/ensemble) against the same runs alone: all bytes of rows, last states, events, messages and counts. Samples of
// one scene differ in masses, so that they meet their events at other times, leave the lanes and come back; the machine code is
// made at once, so that the scenes, which are short, come to use it.
#include "mbd/analysis/assembly.h"
#include "mbd/ensemble/ensemble.h"
#include "mbd/io/reader.h"
#include "tests/random/random_scene.h"
#include "tests/sanitized.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

using namespace steplap;
using namespace steplap::random;
using steplap::testing::k_is_sanitized;

namespace {

constexpr std::uint64_t k_scenes = k_is_sanitized ? 20 : 120;
constexpr int k_samples = 5; // of each, no multiple of any number of lanes
constexpr double k_longest = 0.1; // s, of models

struct Run {
  std::unique_ptr<System> system;
  State start;
  SimulationOptions options;
};

struct Outcome {
  std::vector<std::uint64_t> bits;
  std::vector<std::pair<std::uint64_t, EventKind>> events;
  std::string failure;
  long evaluations = 0, steps = 0, rejections = 0;

  friend bool operator==(const Outcome&, const Outcome&) = default;
};

Outcome outcome(Simulation& simulation, std::exception_ptr failure) {
  Outcome found;
  const auto keep = [&found](double x) { found.bits.push_back(std::bit_cast<std::uint64_t>(x)); };
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    found.failure = error.what();
  }
  const RunResult run = std::move(simulation).result();
  for (const Channel* channel : run.trajectory->channels())
    for (const double x : run.trajectory->series(channel->name)) keep(x);
  for (const double x : run.final_state.q) keep(x);
  for (const double x : run.final_state.v) keep(x);
  for (const Event& event : run.events) found.events.emplace_back(std::bit_cast<std::uint64_t>(event.t), event.kind);
  found.evaluations = run.statistics.evaluations;
  found.steps = run.statistics.steps;
  found.rejections = run.statistics.rejections;
  return found;
}

Outcome alone(const Run& run) {
  Simulation simulation(*run.system, run.start, run.options);
  std::exception_ptr failure;
  try {
    simulation.run();
  } catch (...) {
    failure = std::current_exception();
  }
  return outcome(simulation, failure);
}

std::vector<Outcome> together(const std::vector<Run>& runs, Ensemble& ensemble) {
  std::vector<Outcome> all(runs.size());
  std::size_t started = 0;
  const auto start = [&]() -> std::unique_ptr<Simulation> {
    if (started == runs.size()) return nullptr;
    const Run& run = runs[started++];
    SimulationOptions options = run.options;
    options.stage_code = StageCode::at_once;
    return std::make_unique<Simulation>(*run.system, run.start, std::move(options));
  };
  ensemble.run(start, [&](Ensemble::Finished&& done) { all[done.number] = outcome(*done.simulation, done.failure); });
  return all;
}

// The model and others with heavier bodies.
std::vector<Run> samples_of(const Model& model, const std::string& method, double end) {
  std::vector<Run> runs;
  for (int s = 0; s < k_samples; ++s) {
    Model changed = model;
    for (Body& body : changed.bodies) body.mass *= 1.0 + 0.003 * s;
    Run run;
    run.system = compile(changed);
    run.start = assembled_start(*run.system, assemble(changed, *run.system));
    run.options = options_of(changed);
    run.options.integrator = method;
    run.options.end = end;
    run.options.output_step = end / 20.0;
    run.options.max_events = 3000;
    runs.push_back(std::move(run));
  }
  return runs;
}

// How many tries were made in lanes.
long compare(const std::vector<Run>& runs) {
  Ensemble ensemble(4); // fewer than there are samples: some start when others have ended
  const std::vector<Outcome> found = together(runs, ensemble);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    CAPTURE(i);
    CHECK(found[i] == alone(runs[i]));
  }
  return ensemble.statistics().lane_tries;
}

Model pendulum() { return read_model(STEPLAP_MODELS "/benchmarks/simple_pendulum.toml", transformer_catalog()); }

} // namespace

TEST_CASE("samples of random scenes run to the same bytes side by side as alone") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("steplap_ensemble_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  long in_lanes = 0;
  for (std::uint64_t seed = 2001; seed <= 2000 + k_scenes; ++seed) {
    const Scene scene = seed % 4 == 0 ? random_friction_scene(seed) : random_scene(seed);
    CAPTURE(seed);
    try {
      if (compare(samples_of(model_of(scene, folder.string()), seed % 3 == 0 ? "auto" : "dop853", scene.end)) > 0) ++in_lanes;
    } catch (const ModelError&) { // a drive that does not begin where the body is
    }
  }
  std::filesystem::remove_all(folder);
  if (MachineCode::is_available()) CHECK(in_lanes > static_cast<long>(k_scenes / 8)); // else next to nothing was compared
}

TEST_CASE("samples of every model run to the same bytes side by side as alone") {
  long models = 0, in_lanes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(STEPLAP_MODELS)) {
    const std::string file = entry.path().string();
    if (entry.path().extension() != ".toml" || entry.path().parent_path().filename() == "studies") continue;
    if (file.ends_with("brick_wall.toml") || file.ends_with("pile.toml")) continue; // stiff: half a minute
    if (k_is_sanitized && models % 4 != 0 && ++models) continue;
    CAPTURE(file);
    const Model model = read_model(file, transformer_catalog());
    ++models;
    if (compare(samples_of(model, "dop853", std::min(model.simulation.end, 0.5 * k_longest))) > 0) ++in_lanes;
  }
  CHECK(models > 50);
  if (MachineCode::is_available()) CHECK(in_lanes > (k_is_sanitized ? models / 20 : models / 5));
}

TEST_CASE("a sample that cannot be started, and one that fails, leave the others as they are") {
  std::vector<Run> runs = samples_of(pendulum(), "dop853", 1.0);
  runs[1].options.settings.tolerance = 1e-30; // no step is short enough
  Ensemble ensemble;
  std::vector<int> ended;
  std::size_t calls = 0;
  ensemble.run(
      [&]() -> std::unique_ptr<Simulation> {
        const std::size_t call = calls++;
        if (call == 0) throw NumericalFailure("no start");
        if (call > runs.size()) return nullptr;
        const Run& run = runs[call - 1];
        return std::make_unique<Simulation>(*run.system, run.start, run.options);
      },
      [&](Ensemble::Finished&& done) {
        if (done.number == 0) {
          CHECK(done.simulation == nullptr);
          CHECK_THROWS_WITH_AS(std::rethrow_exception(done.failure), "no start", NumericalFailure);
        } else if (done.number == 2) {
          CHECK(done.failure != nullptr);
        } else {
          REQUIRE(done.simulation != nullptr);
          CHECK(outcome(*done.simulation, done.failure) == alone(runs[done.number - 1]));
        }
        ended.push_back(static_cast<int>(done.number));
      });
  std::sort(ended.begin(), ended.end());
  CHECK(ended == std::vector<int>{0, 1, 2, 3, 4, 5});
}

TEST_CASE("any width of an ensemble, another method, and no sample at all") {
  const std::vector<Run> runs = samples_of(pendulum(), "dop853", 2.0);
  std::vector<Outcome> wanted;
  for (const Run& run : runs) wanted.push_back(alone(run));
  for (const int width : {1, 2, 3, 64}) {
    CAPTURE(width);
    Ensemble ensemble(width);
    CHECK(together(runs, ensemble) == wanted);
    if (width == 1) CHECK(ensemble.statistics().lane_tries == 0);
    if (width == 64 && MachineCode::is_available()) CHECK(ensemble.statistics().lane_tries > 0);
    CHECK(together({}, ensemble).empty());
  }
  for (const char* method : {"rk4", "tsit5", "rodas5p"}) {
    std::vector<Run> others = samples_of(pendulum(), method, 0.5);
    for (Run& run : others) run.options.settings.step = 1e-3;
    Ensemble ensemble;
    const std::vector<Outcome> found = together(others, ensemble);
    for (std::size_t i = 0; i < others.size(); ++i) CHECK(found[i] == alone(others[i]));
    CHECK(ensemble.statistics().lane_tries == 0);
  }
}
