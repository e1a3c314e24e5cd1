// Measures the cost of a step per body in other programs than steplap, for 10 bodies and more.
//
//   peer_scaling [largest number of bodies, default 10000]
#include "scaling.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>

using namespace steplap::peers;

namespace {

// Largest permitted difference between programs in the position of the last body, m. Their methods differ by terms of order h⁴ and rounding
// over about 1000 steps.
constexpr double k_agreement = 1e-6;

struct Table {
  double reference = std::numeric_limits<double>::quiet_NaN();
  bool agrees = true;

  void print(const char* scene, int bodies, const char* program, const ScalingResult& r) {
    std::printf("%-6s %7d  %-16s %10.3f %12.2f %14.4f\n", scene, bodies, program, r.step_us, r.evaluations, r.step_us / r.evaluations);
    std::fflush(stdout);
    if (std::isnan(reference)) reference = r.probe;
    if (!(std::abs(r.probe - reference) < k_agreement)) {
      std::fprintf(stderr, "%s of %d: %s has the last body at %.9f m, the first program at %.9f m\n", scene, bodies, program, r.probe,
                   reference);
      agrees = false;
    }
  }
};

void run_by_hand(Table& table, const char* scene, int bodies, ByHand& by_hand) {
  table.print(scene, bodies, "by hand, rk4", run_rk4(by_hand, bodies));
#ifdef STEPLAP_PEER_ARKODE
  table.print(scene, bodies, "by hand, ARKODE", run_arkode(by_hand, bodies));
#endif
}

} // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 10000;
  bool agrees = true;
  std::printf("per body, µs:  %-17s %10s %12s %14s\n", "program", "step", "evaluations", "an evaluation");
  try {
    for (int n = 10; n <= largest; n *= 10) {
      Table table;
      ChainByHand chain(n);
      run_by_hand(table, "chain", n, chain);
#ifdef STEPLAP_PEER_SIMBODY
      table.print("chain", n, "Simbody", run_chain_simbody(n));
#endif
      agrees = agrees && table.agrees;
    }
    for (int n = 10; n <= largest; n *= 10) {
      Table table;
      const int side = std::max(2, static_cast<int>(std::lround(std::sqrt(n))));
      GridByHand grid(side);
      run_by_hand(table, "grid", side * side, grid);
#ifdef STEPLAP_PEER_SIMBODY
      table.print("grid", side * side, "Simbody", run_grid_simbody(side));
#endif
      agrees = agrees && table.agrees;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
  return agrees ? 0 : 4;
}
