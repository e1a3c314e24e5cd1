// What runs cost a program of C++ that does what the module of Python does: docs/how-to/use_from_python.md.
//
// usage: print_run_times MODEL PATH RUNS SAMPLES [PATH=VALUE...]: CPU times of this thread, in s. One line of the least and the median of RUNS runs of
// the model, each judged and its columns taken; one of a sample of SAMPLES, in which PATH has another value each time.
#include "mbd/io/reader.h"
#include "mbd/model/model_path.h"
#include "mbd/run/report.h"
#include "mbd/system/instance.h"
#include "transformer/program.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

using namespace steplap;

namespace {

double cpu_time() {
  ::timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: print_run_times MODEL PATH RUNS SAMPLES [PATH=VALUE...]\n");
    return 2;
  }
  const std::string model = argv[1], path = argv[2];
  const std::vector<std::string> overrides(argv + 5, argv + argc);
  const int runs = std::atoi(argv[3]), samples = std::atoi(argv[4]);
  RunOptions options;
  options.estimating = Estimating::never;
  const auto loaded = load_model(model, overrides);
  std::vector<double> times;
  double sum = 0.0; // so that nothing is left out
  for (int i = 0; i < runs; ++i) {
    const double begin = cpu_time();
    const Report report = judged_run(loaded, options);
    sum += report.columns().values(0, 0);
    times.push_back(cpu_time() - begin);
  }
  std::sort(times.begin(), times.end());
  std::printf("run %.9f %.9f\n", times.front(), times[times.size() / 2]);
  const Model given = read_given_model(model, program_catalogue(), overrides);
  const double value = number_of(given, path);
  Variants variants(given, {path});
  const double begin = cpu_time();
  for (int i = 0; i < samples; ++i) {
    std::shared_ptr<const System> system = variants.make({value * (0.9 + 0.2 * i / samples)});
    const Report report = judged_run(load_completed(variants.model(), std::move(system), model), options);
    sum += report.ranges().front().high.value;
  }
  std::printf("sample %.9f\n", (cpu_time() - begin) / samples);
  return sum > 1e300 ? 1 : 0;
}
