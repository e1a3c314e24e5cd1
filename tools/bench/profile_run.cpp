// Runs models one after the other, without extremes and samples, and does nothing else: to be run under a profiler (tools/profile).
//   profile_run COORDINATES TOLERANCE MODEL...
#include "transformer/catalog.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

using namespace steplap;

namespace {

Coordinates coordinates_called(const std::string& name) {
  if (name == "absolute") return Coordinates::absolute;
  return name == "joint" ? Coordinates::joint : Coordinates::automatic;
}

void run(const char* path, Coordinates coordinates, double tolerance) {
  const Model model = read_model(path, transformer_catalog());
  const auto system = compile(model);
  SimulationOptions options = options_of(model);
  options.integrator = "dop853";
  options.settings.tolerance = tolerance;
  options.settings.step = 0.0;
  options.coordinates = coordinates;
  options.output_step = options.end;
  options.channels.clear();
  options.has_extremes = false;
  const RunResult result = simulate(*system, system->initial_state(), options);
  std::printf("%s: %ld steps, %zu events, %ld evaluations\n", path, result.statistics.steps, result.events.size(),
              result.statistics.evaluations);
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: profile_run COORDINATES TOLERANCE MODEL...\n");
    return 2;
  }
  try {
    for (int i = 3; i < argc; ++i) run(argv[i], coordinates_called(argv[1]), std::atof(argv[2]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
