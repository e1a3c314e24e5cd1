// Measures the cost of one evaluation, of one step of each integrator, and of a complete run of the paper's transformer. The same bodies
// with springs only are measured, too; the difference is the cost of contacts, friction and constraints.
//
// Benchmarks are named scene/quantity/…, so that results of the two scenes can be divided.
#include "mbd/dynamics/dynamics.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "mbd/system/instance.h"
#include "transformer/catalog.h"

#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>

using namespace steplap;

namespace {

constexpr double k_sliding = 0.10;  // time of the measured state, s: the active part slides, and the load is near its peak
constexpr double k_stretch = 0.005; // duration of the motion that the step benchmark repeats, s

struct PaperRun {
  Model model;
  std::unique_ptr<System> system;
  State state; ///< state at k_sliding
};

const PaperRun& scene(const std::string& path) {
  static std::map<std::string, std::unique_ptr<PaperRun>> scenes;
  std::unique_ptr<PaperRun>& entry = scenes[path];
  if (entry) return *entry;
  entry = std::make_unique<PaperRun>();
  entry->model = read_model(STEPLAP_MODELS "/" + path, transformer_catalog());
  entry->system = compile(entry->model);
  SimulationOptions options = options_of(entry->model);
  options.end = k_sliding;
  entry->state = simulate(*entry->system, entry->system->initial_state(), options).final_state;
  return *entry;
}

void evaluation(benchmark::State& state, const std::string& path) {
  const PaperRun& s = scene(path);
  Dynamics dynamics(*s.system);
  dynamics.use_coordinates(Coordinates::automatic);
  dynamics.set_state(s.state);
  std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
  dynamics.pack(s.state, y.data());
  for (auto _ : state) {
    dynamics.rates(s.state.t, y.data(), dy.data());
    benchmark::DoNotOptimize(dy.data());
    benchmark::ClobberMemory();
  }
  state.counters["evaluations"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

// Repeats steps over a short interval, without event search and samples.
void step(benchmark::State& state, const std::string& path, const std::string& method) {
  const PaperRun& s = scene(path);
  Dynamics dynamics(*s.system);
  dynamics.use_coordinates(Coordinates::automatic);
  dynamics.set_state(s.state);
  IntegratorSettings settings;
  settings.step = 1e-4;
  const auto integrator = make_integrator(method, dynamics, settings);
  std::vector<double> y(static_cast<std::size_t>(dynamics.dimension()));
  dynamics.pack(s.state, y.data());
  integrator->restart(dynamics, s.state.t, y.data());
  const long before = dynamics.evaluations();
  const double end = s.state.t + k_stretch;
  for (auto _ : state) {
    integrator->step(dynamics, end);
    if (integrator->t1() < end) integrator->accept();
    else integrator->restart(dynamics, s.state.t, y.data());
  }
  state.counters["evaluations_per_step"] = static_cast<double>(dynamics.evaluations() - before) / static_cast<double>(state.iterations());
}

// Measures a complete run with the settings of the model, including event location, without samples.
void whole_run(benchmark::State& state, const std::string& path, const std::string& method) {
  const PaperRun& s = scene(path);
  SimulationOptions options = options_of(s.model);
  options.integrator = method;
  options.output_step = 0.0;
  RunStatistics statistics;
  for (auto _ : state) statistics = simulate(*s.system, s.system->initial_state(), options).statistics;
  const auto runs = static_cast<double>(state.iterations());
  state.counters["steps"] = static_cast<double>(statistics.steps);
  state.counters["evaluations"] = static_cast<double>(statistics.evaluations);
  state.counters["evaluations_rate"] = benchmark::Counter(static_cast<double>(statistics.evaluations) * runs, benchmark::Counter::kIsRate);
}

// Measures the creation of a system with a changed mass, by instantiate() and by a variant of the model without channels.
void make_system(benchmark::State& state, bool has_variants) {
  const Model given = read_given_model(STEPLAP_MODELS "/paper/interference.toml", transformer_catalog());
  const std::string path = "body.active part.mass";
  const std::vector<std::string> none;
  Variants variants(given, {path}, &none);
  for (auto _ : state) {
    const auto system = has_variants ? variants.make({47e3}) : instantiate(given, {{path, 47e3}});
    benchmark::DoNotOptimize(system.get());
  }
}

void add_scene(const std::string& name, const std::string& path) {
  benchmark::RegisterBenchmark((name + "/evaluation").c_str(), evaluation, path);
  for (const std::string method : {"rk4", "tsit5", "dop853"}) {
    benchmark::RegisterBenchmark((name + "/step/" + method).c_str(), step, path, method);
    benchmark::RegisterBenchmark((name + "/run/" + method).c_str(), whole_run, path, method)->Unit(benchmark::kMillisecond);
  }
}

} // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  add_scene("transformer", "paper/no_interference.toml");
  benchmark::RegisterBenchmark("transformer/system/instantiate", make_system, false);
  benchmark::RegisterBenchmark("transformer/system/variants", make_system, true);
  add_scene("springs", "benchmarks/paper_springs_only.toml");
  benchmark::RunSpecifiedBenchmarks();
}
