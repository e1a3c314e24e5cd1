// Measures the overhead of a study of the paper's transformer. A hand-written loop runs the same samples, in three steps from the bare
// integration (dop853, with event location) to all that the study does with each sample.
//
//   steplap study export STORE > samples.csv      of models/studies/slip_probability.toml
//   bench_study samples.csv
#include "mbd/io/csv.h"
#include "mbd/io/reader.h"
#include "mbd/model/model_path.h"
#include "mbd/rest/start.h"
#include "mbd/simulation/simulation.h"
#include "mbd/system/instance.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

using namespace steplap;

namespace {

struct Samples {
  std::vector<std::vector<double>> values; ///< per sample: floor friction, joint friction, pressure, shock
};

// Parses the columns number, status, reason, error, evaluations and the four variables. Some columns contain words, so the CSV reader for
// numbers cannot be used.
Samples read_samples(const char* file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  Samples samples;
  while (std::getline(stream, line)) {
    std::istringstream row(line);
    std::string field;
    std::vector<double> values;
    for (int c = 0; std::getline(row, field, ','); ++c)
      if (c >= 5 && c < 9) values.push_back(std::stod(field));
    samples.values.push_back(values);
  }
  return samples;
}

double run(const Model& model, System& system, bool has_extremes) {
  SimulationOptions options = options_of(model);
  options.output_step = 0.0;
  options.has_extremes = has_extremes;
  const RunResult result = simulate(system, start_of(model, system), options);
  double margin = 1e300;
  for (const ChannelRange& range : result.ranges)
    if (range.channel->name.ends_with("joint.margin")) margin = std::min(margin, range.low.value);
  return margin;
}

template <class Work> void measure(const char* what, const Samples& samples, const Work& work) {
  const double begin = thread_cpu_seconds();
  double least = 1e300;
  for (const auto& values : samples.values) least = std::min(least, work(values));
  const double count = static_cast<double>(samples.values.size()), took = thread_cpu_seconds() - begin;
  std::printf("%-55s %8.3f ms a run, %6.0f runs a second and core, least margin %.6g\n", what, 1e3 * took / count, count / took, least);
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "bench_study samples.csv\n"), 2;
  const Samples samples = read_samples(argv[1]);
  const Model given = read_given_model(STEPLAP_MODELS "/studies/transformer.toml", transformer_catalog());
  const std::vector<std::string> paths{"element.tank bottom.static_friction", "core.core.static_friction", "core.core.pressure",
                                       "signal.braking.peak"};
  const double peak = number_of(given, paths[3]);
  const auto scaled = [&](std::vector<double> v) {
    v[3] *= peak;
    return v;
  };
  const std::vector<std::string> none, margins{"front joint.margin", "back joint.margin"};
  Variants bare(given, paths, &none), looked_at(given, paths, &margins);
  const auto once = bare.make(scaled(samples.values.front()));
  measure("one system, integration and events", samples, [&](const std::vector<double>&) { return run(bare.model(), *once, false); });
  measure("a system each, integration and events", samples, [&](const std::vector<double>& v) {
    const auto system = bare.make(scaled(v));
    return run(bare.model(), *system, false);
  });
  measure("a system each, integration, events, margins' extremes", samples, [&](const std::vector<double>& v) {
    const auto system = looked_at.make(scaled(v));
    return run(looked_at.model(), *system, true);
  });
}
