#include "ladder.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace steplap::peers {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void write_csv(std::FILE* file, const std::vector<Rung>& rungs) {
  std::fprintf(file, "problem,program,setting,error,cpu_ms,steps,evaluations,events\n");
  for (const Rung& r : rungs)
    std::fprintf(file, "%s,\"%s\",%s,%.6e,%.6f,%ld,%ld,%ld\n", r.problem.c_str(), r.program.c_str(), r.setting.c_str(), r.error, r.cpu_ms,
                 r.steps, r.evaluations, r.events);
}

void print_table(const std::vector<Rung>& rungs) {
  std::printf("%-22s %-22s %-10s %10s %12s %9s %11s %7s\n", "problem", "program", "setting", "error", "CPU ms", "steps", "evaluations",
              "events");
  for (const Rung& r : rungs)
    std::printf("%-22s %-22s %-10s %10.2e %12.4f %9ld %11ld %7ld\n", r.problem.c_str(), r.program.c_str(), r.setting.c_str(), r.error,
                r.cpu_ms, r.steps, r.evaluations, r.events);
}

double cpu_ms_at(const std::vector<Rung>& rungs, const std::string& problem, const std::string& program, double error) {
  std::vector<std::pair<double, double>> front; // Pareto-optimal pairs of error and time
  for (const Rung& r : rungs)
    if (r.problem == problem && r.program == program && std::isfinite(r.error)) front.emplace_back(std::max(r.error, 1e-16), r.cpu_ms);
  std::sort(front.begin(), front.end());
  double best = -1.0;
  for (const auto& [e, ms] : front)
    if (e <= error && (best < 0.0 || ms < best)) best = ms;
  // Interpolates between the neighbouring points on both sides of the error.
  for (std::size_t i = 0; i + 1 < front.size(); ++i) {
    const auto& low = front[i];
    const auto& high = front[i + 1];
    if (low.first > error || high.first <= error || high.second >= low.second) continue;
    const double share = std::log(error / low.first) / std::log(high.first / low.first);
    best = std::min(best, low.second * std::pow(high.second / low.second, share));
  }
  return best;
}

void print_summary(const std::vector<Rung>& rungs) {
  std::vector<std::pair<std::string, std::string>> seen;
  std::printf("\n%-22s %-22s %12s %12s %12s   (CPU ms at error)\n", "problem", "program", "1e-3", "1e-6", "1e-9");
  for (const Rung& r : rungs) {
    const std::pair<std::string, std::string> key{r.problem, r.program};
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) continue;
    seen.push_back(key);
    std::printf("%-22s %-22s", r.problem.c_str(), r.program.c_str());
    for (const double error : {1e-3, 1e-6, 1e-9}) {
      const double ms = cpu_ms_at(rungs, r.problem, r.program, error);
      if (ms < 0.0) std::printf(" %12s", "-");
      else std::printf(" %12.4f", ms);
    }
    std::printf("\n");
  }
}

} // namespace steplap::peers
