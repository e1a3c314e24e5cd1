// Runs of one scene a second and core: one after the other, and side by side in lanes (mbd/ensemble). The numbers at PATHs scatter by
// a fifth up and down (without any: the paper's scene with friction of the floor and the joints, their pressure and the shock);
// systems are made before, no extremes are looked for. The last states of both ways are compared to the bit.
//   bench_ensemble [SAMPLES [TOLERANCE [WIDTH [MODEL PATH...]]]]
#include "mbd/analysis/start.h"
#include "mbd/ensemble/ensemble.h"
#include "mbd/io/reader.h"
#include "mbd/model/model_path.h"
#include "mbd/system/instance.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace steplap;

namespace {

constexpr int k_turns = 3; // the least time of both ways, in turn

struct Request {
  std::size_t samples = 1000;
  double tolerance = 1e-6;
  int width = Ensemble::k_usual_width;
  std::string model = STEPLAP_MODELS "/studies/transformer.toml";
  std::vector<std::string> paths{"element.tank bottom.static_friction", "core.core.static_friction", "core.core.pressure",
                                 "signal.braking.peak"};
};

struct Way {
  double seconds = std::numeric_limits<double>::infinity();
  std::vector<std::uint64_t> sums; ///< of the bits of each sample's last state
};

std::uint64_t sum_of(const State& state) {
  std::uint64_t sum = 14695981039346656037ULL;
  for (const auto* values : {&state.q, &state.v})
    for (const double x : *values) sum = (sum ^ std::bit_cast<std::uint64_t>(x)) * 1099511628211ULL;
  return sum;
}

template <class Work> void time_way(Way& way, const Work& work) {
  const double begin = thread_cpu_seconds();
  work(way.sums);
  way.seconds = std::min(way.seconds, thread_cpu_seconds() - begin);
}

void compare(const Request& request) {
  const Model given = read_given_model(request.model, transformer_catalog());
  const std::vector<std::string> none;
  Variants variants(given, request.paths, &none);
  std::mt19937_64 engine(1);
  std::vector<std::unique_ptr<System>> systems;
  std::vector<State> starts;
  for (std::size_t i = 0; i < request.samples; ++i) {
    std::vector<double> values;
    for (const std::string& path : request.paths)
      values.push_back(number_of(given, path) * (0.8 + 0.4 * static_cast<double>(engine() >> 11U) * 0x1p-53));
    systems.push_back(variants.make(values));
    starts.push_back(start_of(variants.model(), *systems.back()));
  }
  SimulationOptions options = options_of(variants.model());
  options.integrator = "dop853";
  options.settings.tolerance = request.tolerance;
  options.settings.step = 0.0;
  options.output_step = 0.0;
  options.has_extremes = false;

  Way alone, together;
  alone.sums.resize(request.samples);
  together.sums.resize(request.samples);
  Ensemble ensemble(request.width);
  for (int turn = 0; turn < k_turns; ++turn) {
    time_way(alone, [&](auto& sums) {
      for (std::size_t i = 0; i < request.samples; ++i) sums[i] = sum_of(simulate(*systems[i], starts[i], options).final_state);
    });
    time_way(together, [&](auto& sums) {
      std::size_t started = 0;
      const auto start = [&]() -> std::unique_ptr<Simulation> {
        if (started == request.samples) return nullptr;
        const std::size_t i = started++;
        return std::make_unique<Simulation>(*systems[i], starts[i], options);
      };
      ensemble.run(start, [&](Ensemble::Finished&& run) {
        if (run.failure) std::rethrow_exception(run.failure);
        sums[run.number] = sum_of(std::move(*run.simulation).result().final_state);
      });
    });
  }
  long others = 0;
  for (std::size_t i = 0; i < request.samples; ++i) others += alone.sums[i] != together.sums[i] ? 1 : 0;
  const auto& s = ensemble.statistics();
  const double n = static_cast<double>(request.samples), runs = n * k_turns;
  std::printf("alone %.4f ms a run, ensemble %.4f ms, ratio %.2f; %ld of %zu with other bits\n", 1e3 * alone.seconds / n,
              1e3 * together.seconds / n, alone.seconds / together.seconds, others, request.samples);
  std::printf("tries of steps: %.1f a run in lanes, %.2f in a pass of %d; %.1f alone\n", static_cast<double>(s.lane_tries) / runs,
              static_cast<double>(s.lane_tries) / static_cast<double>(std::max(s.lane_passes, 1L)), ensemble.lanes(),
              static_cast<double>(s.lone_tries) / runs);
}

} // namespace

int main(int argc, char** argv) {
  Request request;
  if (argc > 1) request.samples = static_cast<std::size_t>(std::max(1L, std::atol(argv[1])));
  if (argc > 2) request.tolerance = std::atof(argv[2]);
  if (argc > 3) request.width = std::atoi(argv[3]);
  if (argc > 4) {
    request.model = argv[4];
    request.paths.assign(argv + 5, argv + argc);
  }
  try {
    compare(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
