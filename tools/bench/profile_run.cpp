// Runs models repeatedly without samples and extremes, for use under a profiler (tools/profile_run). Reading and compiling are outside
// profiled_run().
//
//   profile_run METHOD COORDINATES TOLERANCE COUNT MODEL...
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace steplap;

namespace {

struct Counts {
  long steps = 0, rejections = 0, events = 0, evaluations = 0;
};

} // namespace

[[gnu::noinline]] Counts profiled_run(const System& system, const SimulationOptions& options) {
  const RunStatistics s = simulate(system, system.initial_state(), options).statistics;
  return {s.steps, s.rejections, s.events, s.evaluations};
}

namespace {

void profile(const char* method, const std::string& coordinates, double tolerance, long count, char** models, int model_count) {
  double time = 0.0;
  Counts all;
  for (int m = 0; m < model_count; ++m) {
    const Model model = read_model(models[m], transformer_catalog());
    const auto system = compile(model);
    SimulationOptions options = options_of(model);
    options.integrator = method;
    options.settings.tolerance = tolerance;
    options.settings.step = 0.0;
    options.output_step = 0.0;
    options.has_extremes = false;
    if (coordinates != "automatic") options.coordinates = coordinates == "joint" ? Coordinates::joint : Coordinates::absolute;
    double best = std::numeric_limits<double>::infinity();
    Counts counts;
    for (long i = 0; i < count; ++i) {
      const double start = thread_cpu_seconds();
      counts = profiled_run(*system, options);
      best = std::min(best, thread_cpu_seconds() - start);
    }
    time += best;
    all.steps += counts.steps;
    all.rejections += counts.rejections;
    all.events += counts.events;
    all.evaluations += counts.evaluations;
  }
  std::printf("%.3f ms; %ld steps, %ld rejected, %ld events, %ld evaluations\n", 1e3 * time, all.steps, all.rejections, all.events,
              all.evaluations);
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 6) {
    std::fprintf(stderr, "usage: profile_run METHOD automatic|joint|absolute TOLERANCE COUNT MODEL...\n");
    return 2;
  }
  try {
    profile(argv[1], argv[2], std::atof(argv[3]), std::max(1L, std::atol(argv[4])), argv + 5, argc - 5);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
