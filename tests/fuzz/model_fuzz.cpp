// Model files: read, compiled, joints closed, run for a short while and judged.
#include "mbd/io/presentation.h"
#include "mbd/io/reader.h"
#include "mbd/rest/assembly.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judge.h"
#include "tests/fuzz/fuzz.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <utility>

using namespace steplap;

namespace {

// Far enough for contacts to close and events to happen, not so far that a model costs more than some milliseconds.
void run_a_little(const Model& model, const System& system, const State& start) {
  constexpr double k_most = 0.02; // s
  constexpr long k_most_evaluations = 1000;
  SimulationOptions options = options_of(model);
  options.end = std::min(options.end, k_most);
  options.output_step = 0.25 * options.end;
  Simulation simulation(system, start, options);
  while (simulation.statistics().evaluations < k_most_evaluations && simulation.advance()) {}
  const RunResult result = std::move(simulation).result();
  (void)judge(model, system, result, "");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    Model model = parse_model(std::string(data, data + size), STEPLAP_FUZZ_SCENES "/given.toml", transformer_catalog());
    const auto system = compile(model);
    (void)check_presentation(model, *system);
    run_a_little(model, *system, assembled_start(*system, assemble(model, *system)));
  } catch (const ModelError& error) {
    fuzz::require_readable(error);
  } catch (const NumericalFailure&) { // joints that cannot be closed, motions that cannot be followed
  }
  return 0;
}
