// Records one evaluation of a model at a given time on a tape (mbd/tape). Measures recording, simplification and code generation, and an
// evaluation with and without machine code. Prints the minimum of many batches.
//
//   profile_tape MODEL TIME
#include "mbd/dynamics/dynamics.h"
#include "mbd/dynamics/traced_evaluation.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "mbd/tape/machine_code.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <vector>

using namespace steplap;

namespace {

constexpr int k_batches = 20;
constexpr double k_least_pivot = 2.5e-2;

template <class Work> double nanoseconds(long count, const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < k_batches; ++batch) {
    const double start = thread_cpu_seconds();
    for (long i = 0; i < count; ++i) work();
    best = std::min(best, thread_cpu_seconds() - start);
  }
  return 1e9 * best / static_cast<double>(count);
}

std::vector<double> time_inputs(const System& system, const State& state, const Layout& layout) {
  std::vector<double> inputs;
  for (const Lock& lock : layout.locks) {
    const SignalJet target = row_target(system.rows[lock.row], state.bases.data(), state.t);
    inputs.insert(inputs.end(), {target.value + lock.offset, target.rate, target.acceleration});
  }
  for (const int r : layout.driven_rows) {
    const SignalJet target = row_target(*layout.active[r].spec, state.bases.data(), state.t);
    inputs.insert(inputs.end(), {target.acceleration, target.rate});
  }
  return inputs;
}

int profile(const char* path, double time) {
  const Model model = read_model(path, transformer_catalog());
  const auto system = compile(model);
  SimulationOptions options = options_of(model);
  options.end = time;
  const State state = simulate(*system, system->initial_state(), options).final_state;
  Dynamics dynamics(*system);
  dynamics.use_coordinates(options.coordinates);
  dynamics.set_state(state);
  std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
  dynamics.pack(state, y.data());
  dynamics.rates(state.t, y.data(), dy.data());
  std::vector<double> inputs = time_inputs(*system, state, dynamics.layout());
  TracedRates traced;
  bool is_traced = true;
  const double writing = nanoseconds(100, [&] {
    is_traced = trace_rates(*system, dynamics.layout(), state, dynamics.evaluation(), state.t, y.data(), inputs, k_least_pivot, traced) &&
                is_traced;
  });
  if (!is_traced) {
    std::fprintf(stderr, "%s: some part of it is not traced\n", path);
    return 3;
  }
  inputs.insert(inputs.begin(), y.begin(), y.begin() + 2 * dynamics.coordinate_count() + dynamics.inner_count());
  for (const SignalInput& signal : traced.signals) inputs.push_back(signal.at(state.t));
  Tape tape;
  const double simplifying = nanoseconds(100, [&] { tape = simplified(traced.tape); });
  const double making = nanoseconds(20, [&] { (void)MachineCode(tape); });
  std::printf("%zu steps, %zu simplified; writing %.0f, simplifying %.0f, making code %.0f ns\n", traced.tape.steps.size(),
              tape.steps.size(), writing, simplifying, making);
  std::printf("evaluation %.1f ns\n", nanoseconds(5000, [&] { dynamics.rates(state.t, y.data(), dy.data()); }));
  tape.first_inputs = 0; // all inputs, and all outputs, are in one array
  tape.places.clear();
  const MachineCode code(tape);
  std::vector<double> out(tape.outputs.size());
  const double one = nanoseconds(5000, [&] { (void)code.run(inputs.data(), tape.constants.data(), out.data()); });
  std::printf("by code %.1f ns, %zu instructions\n", one, code.instruction_count());
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: profile_tape MODEL TIME\n");
    return 2;
  }
  try {
    return profile(argv[1], std::atof(argv[2]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
