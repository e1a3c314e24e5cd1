// Runs a model file like the program `steplap`, and prints the events and the extremes:
//   run_file braked_block.toml [simulation.end=0.5 …]
#include <steplap/catalog.h>
#include <steplap/model_file.h>
#include <steplap/simulate.h>

#include <cstdio>

using namespace steplap;

int main(int argc, char** argv) try {
  if (argc < 2) {
    std::fprintf(stderr, "usage: run_file MODEL.toml [path=value …]\n");
    return 2;
  }
  const Model model = read_model(argv[1], transformer_catalog(), {argv + 2, argv + argc});
  const auto system = compile(model);

  SimulationOptions options = options_of(model);
  options.has_extremes = true;
  const RunResult run = simulate(*system, start_of(model, *system), options);

  std::printf("%s\n", model.header.title.c_str());
  for (const Event& event : run.events)
    if (event.kind != EventKind::changes_foot) std::printf("%.4f s  %s %s\n", event.t, event.element.c_str(), event.words().c_str());
  for (const ChannelRange& range : run.ranges)
    std::printf("%-24s %13.6g to %13.6g %s\n", range.channel->name.c_str(), range.low.value, range.high.value, range.channel->unit.c_str());
} catch (const std::exception& error) { // ModelError: file, line and remedy; NumericalFailure: time and advice
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
