// Evaluates the equations of motion of one model repeatedly, for use under a profiler (tools/profile). The state is that of the model's run
// at a given time.
//
//   profile_evaluation MODEL TIME COUNT [COORDINATES]
#include "mbd/dynamics/dynamics.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <string>
#include <vector>

using namespace steplap;

namespace {

constexpr int k_batches = 20; // number of batches, of which the fastest is used, because other processes disturb it least

void profile(const char* path, double time, long count, const std::string& coordinates) {
  const Model model = read_model(path, transformer_catalog());
  const auto system = compile(model);
  SimulationOptions options = options_of(model);
  options.end = time;
  if (coordinates != "automatic") options.coordinates = coordinates == "joint" ? Coordinates::joint : Coordinates::absolute;
  const State state = simulate(*system, system->initial_state(), options).final_state;
  Dynamics dynamics(*system);
  dynamics.use_coordinates(options.coordinates);
  dynamics.set_state(state);
  std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
  dynamics.pack(state, y.data());
  const double later = std::nextafter(state.t, std::numeric_limits<double>::infinity());
  // Alternates between two times, so that values cached for one time are not reused.
  const auto nanoseconds = [&](const auto& evaluate) {
    double best = std::numeric_limits<double>::infinity();
    for (int batch = 0; batch < k_batches; ++batch) {
      const double start = thread_cpu_seconds();
      for (long i = 0; i < count / k_batches; ++i) evaluate(i % 2 == 0 ? state.t : later);
      best = std::min(best, thread_cpu_seconds() - start);
    }
    return 1e9 * best / static_cast<double>(count / k_batches);
  };
  std::printf("%.1f ns per evaluation", nanoseconds([&](double t) { dynamics.rates(t, y.data(), dy.data()); }));
  dynamics.use_stage_code(StageCode::at_once);
  dynamics.begin_stages();
  dynamics.evaluate(Request::stage, state.t, y.data(), dy.data());
  const double coded = nanoseconds([&](double t) { dynamics.evaluate(Request::stage, t, y.data(), dy.data()); });
  if (dynamics.coded_stages() > 0) std::printf(", %.1f ns of a stage by machine code", coded);
  std::printf("\n");
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 4 || argc > 5) {
    std::fprintf(stderr, "usage: profile_evaluation MODEL TIME COUNT [COORDINATES]\n");
    return 2;
  }
  try {
    profile(argv[1], std::atof(argv[2]), std::max(static_cast<long>(k_batches), std::atol(argv[3])), argc > 4 ? argv[4] : "automatic");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
