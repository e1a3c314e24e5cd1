// Measures the cost of stiffness: the paper's transformer with springs and dampers of its feet multiplied by 1, 100 and 10 000, with
// explicit and implicit methods at equal error. The joints are monitors, which never slip, so that the three scenes differ in stiffness
// only.
//
// The error is the larger one of two: of the active part's pitch, and of the bottom arresting force, over 1 kHz samples and relative to
// their ranges. The reference is dop853 at 1e-12, with which rodas5p at 1e-10 must agree. The cost is the CPU time of this thread, minimum
// of several runs, and the number of evaluations, both interpolated between tolerances at the required errors.
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace steplap;

namespace {

constexpr int k_repeats = 5;

struct SolverCost {
  double tolerance, error, milliseconds, evaluations, steps;
};

RunResult run(const System& system, const Model& model, const std::string& method, double tolerance, bool is_sampled) {
  SimulationOptions options = options_of(model);
  options.has_extremes = false; // not needed, and would double the time
  options.integrator = method;
  options.settings.tolerance = tolerance;
  options.output_step = is_sampled ? 1e-3 : 0.0;
  options.channels = {"active part.theta", "bottom arresting.force"};
  return simulate(system, system.initial_state(), options);
}

double difference(const RunResult& a, const RunResult& b) {
  double worst = 0.0;
  for (const char* channel : {"active part.theta", "bottom arresting.force"}) {
    const std::vector<double> x = a.trajectory->series(channel), y = b.trajectory->series(channel);
    const auto [low, high] = std::minmax_element(y.begin(), y.end());
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) worst = std::max(worst, std::abs(x[i] - y[i]) / (*high - *low));
  }
  return worst;
}

SolverCost measure(const System& system, const Model& model, const std::string& method, double tolerance, const RunResult& reference) {
  SolverCost entry{tolerance, difference(run(system, model, method, tolerance, true), reference), 1e300, 0.0, 0.0};
  for (int i = 0; i < k_repeats; ++i) {
    const RunStatistics s = run(system, model, method, tolerance, false).statistics;
    entry.milliseconds = std::min(entry.milliseconds, 1e3 * s.cpu_seconds);
    entry.evaluations = static_cast<double>(s.evaluations);
    entry.steps = static_cast<double>(s.steps);
  }
  return entry;
}

// Returns the smallest cost for this error, by power-law interpolation between neighbouring tolerances; NaN if no tolerance reaches it.
double cost_at(const std::vector<SolverCost>& ladder, double error, double SolverCost::*cost) {
  double least = std::nan("");
  for (std::size_t i = 0; i < ladder.size(); ++i) {
    double here = std::nan("");
    if (ladder[i].error <= error) here = ladder[i].*cost;
    if (i > 0 && ladder[i - 1].error > error && ladder[i].error <= error) {
      const double share = std::log(error / ladder[i].error) / std::log(ladder[i - 1].error / ladder[i].error);
      here = ladder[i].*cost * std::pow(ladder[i - 1].*cost / (ladder[i].*cost), share);
    }
    if (!(least <= here) && !std::isnan(here)) least = here;
  }
  return least;
}

} // namespace

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::printf("%8s %8s %9s %10s %8s %12s %8s\n", "stiffer", "method", "tolerance", "error", "steps", "evaluations", "CPU/ms");
  for (const double scale : {1.0, 1e2, 1e4}) {
    std::vector<std::string> overrides;
    for (const std::string foot : {"front foot", "rear foot"}) {
      overrides.push_back("element." + foot + ".stiffness=" + std::to_string(1.6e9 * scale));
      overrides.push_back("element." + foot + ".damping=" + std::to_string(1.5e5 * scale));
    }
    for (const std::string joint : {"front joint", "back joint"}) overrides.push_back("element." + joint + ".mode=\"monitor\"");
    const Model model = read_model(STEPLAP_MODELS "/paper/no_interference.toml", transformer_catalog(), overrides);
    const auto system = compile(model);
    const RunResult reference = run(*system, model, "dop853", 1e-12, true);
    const double agreement = difference(run(*system, model, "rodas5p", 1e-10, true), reference);
    for (const std::string method : {"dop853", "rodas5p"}) {
      std::vector<SolverCost> ladder;
      for (double tolerance = 1e-2; tolerance > 0.9e-9; tolerance *= 0.1) {
        try {
          ladder.push_back(measure(*system, model, method, tolerance, reference));
        } catch (const NumericalFailure& failure) {
          std::printf("%8.0e %8s %9.0e fails: %s\n", scale, method.c_str(), tolerance, failure.what());
          continue;
        }
        const SolverCost& e = ladder.back();
        std::printf("%8.0e %8s %9.0e %10.1e %8.0f %12.0f %8.3f\n", scale, method.c_str(), tolerance, e.error, e.steps, e.evaluations,
                    e.milliseconds);
      }
      for (const double error : {1e-3, 1e-4, 1e-5, 1e-6})
        std::printf("%8.0e %8s  at error %.0e: %10.0f evaluations, %8.3f ms\n", scale, method.c_str(), error,
                    cost_at(ladder, error, &SolverCost::evaluations), cost_at(ladder, error, &SolverCost::milliseconds));
    }
    std::printf("%8.0e the two references differ by %.1e\n", scale, agreement);
  }
}
