// Systems, simulations and evaluations in parallel, to be run under valgrind's helgrind, which sees accesses of two
// threads to the same memory that nothing orders, whether or not they collide this time. It needs no build of its own:
// the whole program with -fsanitize=thread would be a third one.
//
//   threads [shared]     what the library promises: exit code 0 if the results are the same bytes as without threads
//   threads RACE         what it does not promise, of which helgrind has to complain, or it would see nothing at all:
//     dynamics             two threads evaluate one Dynamics
//     system               one thread writes a number into a System that another one runs
//     once                 a flag without a lock guards what the first thread to come fills in
#include "mbd/dynamics/dynamics.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "mbd/system/instance.h"
#include "transformer/catalog.h"

#include <cstdio>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

using namespace steplap;

namespace {

constexpr int k_threads = 3;

struct SharedModel {
  Model given;
  std::unique_ptr<System> system;
  SimulationOptions options;
};

// `end`, s: so far that it slips, swings, or is loaded once.
SharedModel scene(const std::string& file, const std::string& method, double end) {
  SharedModel s;
  s.given = read_given_model(STEPLAP_MODELS "/" + file + ".toml", transformer_catalog());
  s.system = instantiate(s.given, {});
  s.options.end = end;
  s.options.integrator = method;
  s.options.settings.step = method == "rk4" || method == "moreau" ? 1e-3 : 0.0;
  s.options.settings.tolerance = 1e-4;
  s.options.has_extremes = true;
  return s;
}

std::vector<SharedModel> scenes() {
  std::vector<SharedModel> all;
  all.push_back(scene("paper/no_interference", "dop853", 0.09));      // joints that hold, an event, a drive
  all.push_back(scene("benchmarks/andrews", "tsit5", 2e-3));          // joint coordinates
  all.push_back(scene("benchmarks/stick_slip_belt", "rodas5p", 0.5)); // Jacobians
  all.push_back(scene("benchmarks/block_on_incline", "moreau", 0.1)); // time stepping
  return all;
}

std::vector<double> numbers(const State& state) {
  std::vector<double> all = state.q;
  all.insert(all.end(), state.v.begin(), state.v.end());
  all.insert(all.end(), {state.dissipated, state.work});
  return all;
}

std::vector<double> run(const System& system, const SimulationOptions& options) {
  return numbers(simulate(system, system.initial_state(), options).final_state);
}

void in_threads(int count, const std::function<void(int)>& job) {
  std::vector<std::thread> threads;
  for (int i = 0; i < count; ++i) threads.emplace_back(job, i);
  for (std::thread& thread : threads) thread.join();
}

// One scene: runs on its system, which all share, beside systems made of its model, which all share, and of variants.
std::vector<double> all_of(const SharedModel& s, const std::string& path, double value) {
  std::vector<double> results = run(*s.system, s.options);
  const auto append = [&results](const std::vector<double>& more) { results.insert(results.end(), more.begin(), more.end()); };
  if (path.empty()) return results;
  const Model copy = s.given;
  const auto changed = instantiate(copy, {{path, value}});
  append(numbers(changed->initial_state()));
  Variants variants(s.given, {path});
  const auto variant = variants.make({value});
  append(run(*variant, s.options));
  SimulationOptions by_code = s.options; // which all threads share
  by_code.stage_code = StageCode::at_once;
  append(run(*variant, by_code));
  return results;
}

int shared() {
  const std::vector<SharedModel> all = scenes();
  std::vector<std::vector<double>> alone, together(all.size() * k_threads);
  const auto job = [&all](std::size_t k) { return all_of(all[k], k == 0 ? "element.tank bottom.static_friction" : "", 0.33); };
  in_threads(k_threads, [&](int thread) {
    for (std::size_t k = 0; k < all.size(); ++k) together[thread * all.size() + k] = job(k);
  });
  for (std::size_t k = 0; k < all.size(); ++k) alone.push_back(job(k)); // last: what is made once is made by the threads
  for (std::size_t i = 0; i < together.size(); ++i)
    if (together[i] != alone[i % all.size()]) {
      std::printf("scene %zu: other numbers in a thread than alone\n", i % all.size());
      return 1;
    }
  std::printf("%zu runs in %d threads\n", together.size(), k_threads);
  return 0;
}

int dynamics_of_two() {
  const SharedModel s = scene("benchmarks/andrews", "dop853", 0.0);
  const State start = s.system->initial_state();
  Dynamics dynamics(*s.system);
  dynamics.set_state(start);
  std::vector<double> y(dynamics.dimension());
  dynamics.pack(start, y.data());
  in_threads(2, [&](int) {
    std::vector<double> dy(y.size());
    dynamics.rates(0.0, y.data(), dy.data());
  });
  return 0;
}

int system_of_two() {
  SharedModel s = scene("benchmarks/andrews", "dop853", 1e-4);
  in_threads(2, [&s](int thread) {
    if (thread == 0) s.system->gravity.y() = -9.80665;
    else (void)run(*s.system, s.options);
  });
  return 0;
}

int filled_once() {
  bool is_filled = false;
  std::vector<double> filled;
  in_threads(2, [&](int thread) {
    if (is_filled) return;
    filled.assign(3, thread);
    is_filled = true;
  });
  return filled.size() == 3 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "shared";
  try {
    if (what == "shared") return shared();
    if (what == "dynamics") return dynamics_of_two();
    if (what == "system") return system_of_two();
    if (what == "once") return filled_once();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  std::fprintf(stderr, "usage: threads [shared|dynamics|system|once]\n");
  return 2;
}
