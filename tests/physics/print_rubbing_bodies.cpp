// Compares time stepping with the exact answer for random machines whose friction falls when it slides.
//   rubbing_bodies guides|crates|limbs FIRST LAST STEP
// A step of 0 prints the scenes instead.
#include "tests/physics/rubbing_check.h"

#include <cstdio>
#include <cstdlib>
#include <string>

using namespace steplap::testing;

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: rubbing_bodies guides|crates|limbs FIRST LAST STEP, a step of 0 to print the scenes\n");
    return 2;
  }
  const std::string family = argv[1];
  const auto make = family == "guides" ? rubbing_on_guides : family == "crates" ? stacked_crates : limbs_on_sliding_base;
  const double step = std::atof(argv[4]);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  int sound = 0, holding = 0, sliding = 0, wrong = 0;
  for (int seed = std::atoi(argv[2]); seed <= std::atoi(argv[3]); ++seed) {
    if (step == 0.0) {
      std::printf("%s", make(seed, {}).text.c_str());
      continue;
    }
    const RubbingTruth truth(make, seed);
    if (!truth.is_robust()) continue;
    ++sound;
    holding += truth.holding();
    sliding += truth.sliding();
    const std::string found = truth.differs(make, seed, step, {});
    if (found.empty()) continue;
    ++wrong;
    std::printf("%s %d: %s\n", family.c_str(), seed, found.c_str());
  }
  if (step == 0.0) return 0;
  std::printf("%d scenes whose slips do not hang by a hair, with %d frictions that hold and %d that slide: %d wrong\n", sound, holding,
              sliding, wrong);
  return wrong == 0 ? 0 : 1;
}
