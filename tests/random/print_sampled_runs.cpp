// sampled_runs COUNT METHOD TOLERANCE FIRST LAST: random scenes, sampled COUNT times and not at all; a line for each that differs, or of
// which a sample lies beyond its channel's extremes.
// sampled_runs COUNT METHOD TOLERANCE MODEL...: model files.
#include "mbd/base/number_text.h"
#include "mbd/io/reader.h"
#include "mbd/model/validate.h"
#include "mbd/rest/assembly.h"
#include "tests/random/random_scene.h"
#include "tests/random/sampled_runs.h"
#include "transformer/catalog.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

using namespace steplap;
using namespace steplap::random;

namespace {

struct Setting {
  int count = 0;
  std::string method;
  double value = 0.0;
};

struct Totals {
  long runs = 0, different = 0, beyond = 0;
};

void look_at(const std::string& name, const Model& model, const Setting& setting, Totals& totals) {
  const auto system = compile(model);
  const State start = assembled_start(*system, assemble(model, *system));
  SimulationOptions options = options_of(model);
  options.integrator = setting.method;
  (has_fixed_step(setting.method) ? options.settings.step : options.settings.tolerance) = setting.value;
  const Sampled found = sampled(*system, start, options, setting.count);
  ++totals.runs;
  if (!found.difference.empty()) {
    ++totals.different;
    std::printf("%s: %s\n", name.c_str(), found.difference.c_str());
  }
  if (!found.beyond.empty()) ++totals.beyond;
  std::size_t shown = 0;
  for (const Beyond& b : found.beyond)
    if (++shown <= 3)
      std::printf("%s: %s at %.9g s is %.3g beyond its range of %.6g, allowed %.2g (%zu channels)\n", name.c_str(), b.channel.c_str(), b.t,
                  b.excess, b.range, b.allowed, found.beyond.size());
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: sampled_runs COUNT METHOD TOLERANCE FIRST LAST\n       sampled_runs COUNT METHOD TOLERANCE MODEL...\n");
    return 2;
  }
  const Setting setting{std::atoi(argv[1]), argv[2], std::strtod(argv[3], nullptr)};
  Totals totals;
  if (argc == 6 && std::string(argv[4]).find('.') == std::string::npos) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("sampled_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const std::uint64_t last = std::strtoull(argv[5], nullptr, 10);
    for (std::uint64_t seed = std::strtoull(argv[4], nullptr, 10); seed <= last; ++seed) try {
        look_at(std::to_string(seed), model_of(random_scene(seed), folder.string()), setting, totals);
      } catch (const ModelError&) {}
    std::filesystem::remove_all(folder);
  } else {
    for (int i = 4; i < argc; ++i) look_at(argv[i], read_model(argv[i], transformer_catalog()), setting, totals);
  }
  std::printf("%ld runs, %ld hang on the samples, %ld have samples beyond their extremes\n", totals.runs, totals.different, totals.beyond);
  return totals.different + totals.beyond == 0 ? 0 : 1;
}
