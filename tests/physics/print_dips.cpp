// Prints how many random events by a hair each method finds: print_dips CASES [FIRST SEED].
#include "mbd/model/method.h"
#include "tests/physics/dips.h"

#include <cstdio>
#include <cstdlib>
#include <map>

using namespace steplap;
using namespace steplap::testing;

int main(int argc, char** argv) {
  const int cases = argc > 1 ? std::atoi(argv[1]) : 100;
  const auto first = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 1);
  static const std::map<Hair, const char*> names = {
      {Hair::friction, "friction"}, {Hair::step_lap, "step-lap joint"}, {Hair::gap, "gap"}, {Hair::rope, "rope"}};
  const std::vector<double> tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11}, steps = {0.02, 0.01, 0.005},
                            long_steps = {0.2, 0.05, 0.02};
  int wrong_of_all = 0;
  for (const auto& [hair, name] : names)
    for (const Method& m : methods()) {
      if (m.is_time_stepping) continue;
      int runs = 0, wrong = 0, events = 0, missed = 0, early = 0, late = 0;
      for (int i = 0; i < cases; ++i) {
        const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
        const std::vector<double>& settings = !m.has_fixed_step                                  ? tolerances
                                              : hair == Hair::friction || hair == Hair::step_lap ? long_steps
                                                                                                 : steps;
        const double setting = settings[static_cast<std::size_t>(i) % settings.size()];
        const DipCase dip = random_dip(hair, seed, dip_depth(hair, seed, m.has_fixed_step ? 1e-5 : setting));
        const DipOutcome o = outcome(dip, m.name, setting);
        ++runs;
        events += o.wanted;
        if (o.is_right()) continue;
        ++wrong;
        if (!o.failure.empty()) std::printf("  %s %s %g seed %ld: %s\n", name, m.name, setting, static_cast<long>(seed), o.failure.c_str());
        else if (o.found < o.wanted) ++missed;
        else if (o.found > o.wanted) ++early;
        else ++late;
        if (wrong <= 5)
          std::printf("  %s %s %g seed %ld: wanted %d found %d worst %g\n", name, m.name, setting, static_cast<long>(seed), o.wanted,
                      o.found, o.worst);
      }
      wrong_of_all += wrong;
      std::printf("%-15s %-8s runs %d, events %d, wrong %d (missed %d, too many %d, at another time %d)\n", name, m.name, runs, events,
                  wrong, missed, early, late);
      std::fflush(stdout);
    }
  return wrong_of_all == 0 ? 0 : 5;
}
