#pragma once

// Results of all compared programs: one row per setting.

#include <cstdio>
#include <string>
#include <vector>

namespace steplap::peers {

struct Rung {
  std::string problem;
  std::string program;
  std::string setting; // tolerance or step size
  double error = 0.0;
  double cpu_ms = 0.0; // CPU time of the integration alone, ms; minimum of several runs
  long steps = 0;
  long evaluations = 0;
  long events = 0;
};

// Returns the CPU time of this thread, s.
[[nodiscard]] double cpu_seconds();

// Returns the smallest CPU time, ms, of repeated runs; short runs are repeated more often.
template <class F> [[nodiscard]] double least_ms(F run, double budget_seconds = 0.2) {
  double least = 1e300;
  double spent = 0.0;
  for (int i = 0; i < 400 && (i == 0 || spent < budget_seconds || (i < 3 && spent < 1.0)); ++i) {
    const double start = cpu_seconds();
    run();
    const double elapsed = cpu_seconds() - start;
    spent += elapsed;
    if (elapsed < least) least = elapsed;
  }
  return 1e3 * least;
}

// Writes the columns problem,"program",setting,error,cpu_ms,steps,evaluations,events. A program's name may contain commas.
void write_csv(std::FILE* file, const std::vector<Rung>& rungs);

void print_table(const std::vector<Rung>& rungs);

// Returns the CPU time for a given error, ms, interpolated in the logarithms along the Pareto-optimal settings; negative if no setting
// reaches the error.
[[nodiscard]] double cpu_ms_at(const std::vector<Rung>& rungs, const std::string& problem, const std::string& program, double error);

// Prints one line per problem and program: CPU time at errors of 1e-3, 1e-6 and 1e-9.
void print_summary(const std::vector<Rung>& rungs);

} // namespace steplap::peers
