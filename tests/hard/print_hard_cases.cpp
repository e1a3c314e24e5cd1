// Prints the hard cases as a table: case × integrator, error and cost.
#include "mbd/number_text.h"
#include "tests/hard/hard_cases.h"

#include <cstdio>
#include <string>

using namespace steplap::hard;

namespace {

std::string cell(const Outcome& o) {
  char text[64];
  if (!o.failure.empty()) return "stops";
  std::snprintf(text, sizeof text, "%.1e, %.3g ms", o.error, 1e3 * o.statistics.cpu_seconds);
  return o.is_finite ? text : "not a number";
}

} // namespace

// "--short": long cases are cut as the tests do.
int main(int argc, char** argv) {
  const bool is_short = argc > 1 && std::string(argv[1]) == "--short";
  std::string head = "| | case | error relative to |", rule = "|---|---|---|";
  for (const std::string& name : integrators()) {
    head += " " + name + " |";
    rule += "---|";
  }
  std::printf("%s\n%s\n", head.c_str(), rule.c_str());
  for (const HardCase& c : hard_cases()) {
    std::string row = "| " + std::to_string(c.number) + " | " + c.name + " | " + c.unit + " |";
    for (const std::string& name : integrators())
      row += " " + cell(run(c, name, is_short)) + " |";
    std::printf("%s\n", row.c_str());
    std::fflush(stdout);
  }
}
