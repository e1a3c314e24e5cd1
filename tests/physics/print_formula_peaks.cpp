// Thousands of the peaks that formula_extremes_test.cpp tries hundreds of: `print_formula_peaks FIRST COUNT`.
#include "tests/physics/formula_peaks.h"

#include <cstdlib>
#include <iostream>

using namespace steplap;
using namespace steplap::testing;

int main(int argc, char** argv) {
  const std::size_t first = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1, count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 20;
  for (const Settings& settings : std::vector<Settings>{{"dop853", 1e-4, 1.0},
                                                        {"dop853", 1e-8, 1.0},
                                                        {"dop853", 1e-12, 1.0},
                                                        {"tsit5", 1e-5, 1.0},
                                                        {"tsit5", 1e-9, 1.0},
                                                        {"rodas5p", 1e-5, 1.0},
                                                        {"auto", 1e-6, 1.0},
                                                        {"rk4", 3e-3, 1.0},
                                                        {"moreau", 1e-3, 1.0}}) {
    PeakTally tally;
    for (std::size_t seed = first; seed < first + count; ++seed) tally.add(settings, seed);
    std::cout << settings.integrator << " " << settings.step_or_tolerance << ": " << tally.count << " extremes, " << tally.wrong.size()
              << " wrong, " << tally.unsure.size() << " not closed\n";
    for (std::size_t i = 0; i < std::min<std::size_t>(tally.wrong.size(), 3); ++i) std::cout << "  wrong: " << tally.wrong[i] << "\n";
    for (std::size_t i = 0; i < std::min<std::size_t>(tally.unsure.size(), 3); ++i)
      std::cout << "  not closed: " << tally.unsure[i] << "\n";
  }
}
