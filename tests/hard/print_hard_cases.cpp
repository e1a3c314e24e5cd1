// Prints the hard cases as a table: case × integrator, error and cost; or how two of them converge.
#include "mbd/base/number_text.h"
#include "tests/hard/hard_cases.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace steplap;
using namespace steplap::hard;

namespace {

// A method that does not claim a case is marked.
std::string cell(const HardCase& hard_case, const std::string& integrator, const Outcome& o) {
  char text[64];
  if (!o.failure.empty()) return "stops";
  if (!o.is_finite) return "not a number";
  const bool is_unfit = bound_for(hard_case, integrator) == 0.0;
  std::snprintf(text, sizeof text, "%.1e, %.3g ms%s", o.error, 1e3 * o.statistics.cpu_seconds, is_unfit ? " †" : "");
  return text;
}

void print_head(std::string head, std::string rule, const std::vector<std::string>& columns) {
  for (const std::string& name : columns) {
    head += " " + name + " |";
    rule += "---|";
  }
  std::printf("%s\n%s\n", head.c_str(), rule.c_str());
}

void print_row(const std::string& row) {
  std::printf("%s\n", row.c_str());
  std::fflush(stdout);
}

void print_table(bool is_short) {
  print_head("| | case | error relative to |", "|---|---|---|", integrators());
  for (const HardCase& c : hard_cases()) {
    std::string row = "| " + std::to_string(c.number) + " | " + c.name + " | " + c.unit + " |";
    for (const std::string& name : integrators()) row += " " + cell(c, name, run(c, name, is_short)) + " |";
    print_row(row);
  }
}

const HardCase& case_of(const std::string& file, const std::string& unit) {
  return *std::find_if(hard_cases().begin(), hard_cases().end(), [&](const HardCase& c) { return c.file == file && c.unit == unit; });
}

// Of a foot that grazes: depth and time of contact against tolerance.
void print_graze() {
  const std::vector<std::string> methods = {"tsit5", "dop853", "rodas5p", "auto"};
  print_head("| tolerance |", "|---|", methods);
  for (const char* tolerance : {"1e-9", "1e-10", "1e-11", "1e-12", "1e-13"}) {
    std::string row = "| " + std::string(tolerance) + " |";
    for (const std::string& method : methods) {
      const std::vector<std::string> own = {"simulation.tolerance=" + std::string(tolerance)};
      const double depth = run(case_of("graze", "stroke"), method, true, own).error;
      const double time = run(case_of("graze", "time of contact"), method, true, own).error;
      char text[96];
      std::snprintf(text, sizeof text, " %.1e, %.1e |", depth, time);
      row += time < 1.0 ? text : " missed |";
    }
    print_row(row);
  }
}

// Relative change of the energy ½ v² + ½ 100 x² after 10, 100, 1e3 and 1e4 periods.
void print_energy() {
  print_head("| periods |", "|---|", integrators());
  std::vector<std::vector<double>> change;
  const std::vector<std::size_t> periods = {10, 100, 1000, 10000};
  for (const std::string& method : integrators()) {
    HardCase oscillator = case_of("long_oscillation", "amplitude");
    change.emplace_back();
    oscillator.error = [&](const Finished& finished) {
      const std::vector<double> x = finished.series("mass.x"), v = finished.series("mass.vx");
      for (const std::size_t p : periods) { // a sample every ten
        const double now = v[p / 10] * v[p / 10] + 100.0 * x[p / 10] * x[p / 10];
        change.back().push_back(now / (v[0] * v[0] + 100.0 * x[0] * x[0]) - 1.0);
      }
      return 0.0;
    };
    (void)run(oscillator, method, false);
  }
  for (std::size_t p = 0; p < periods.size(); ++p) {
    std::string row = "| " + std::to_string(periods[p]) + " |";
    for (const std::vector<double>& of_method : change) {
      char text[32];
      std::snprintf(text, sizeof text, " %+.1e |", of_method.at(p));
      row += text;
    }
    print_row(row);
  }
}

} // namespace

// "--short": long cases are cut as the tests do; "--graze", "--energy": how cases 2 and 10 converge.
int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "--graze") print_graze();
  else if (what == "--energy") print_energy();
  else print_table(what == "--short");
}
