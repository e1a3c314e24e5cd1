// Prints how the runs of scaled models differ from those of the models themselves.
#include "tests/scales/alike.h"

#include <cstdio>
#include <cstdlib>

using namespace steplap::testing;

int main(int argc, char** argv) {
  if (argc < 6) {
    std::fprintf(stderr, "usage: print_scales LENGTH TIME MASS LONGEST MODEL... (LONGEST: so many seconds of each model are run)\n");
    return 2;
  }
  const Scaling by{std::strtod(argv[1], nullptr), std::strtod(argv[2], nullptr), std::strtod(argv[3], nullptr)};
  for (int i = 5; i < argc; ++i) {
    try {
      const Original original(argv[i], std::strtod(argv[4], nullptr));
      const Difference d = original.difference(by);
      std::printf("%-60s steps %6ld %6ld events %4ld %4ld (%.1e) value %.1e %-24s %s %s %s %.150s\n", argv[i], d.steps[0], d.steps[1],
                  d.events[0], d.events[1], d.event_time, d.value, d.channel.c_str(), d.verdict[0].c_str(),
                  d.verdict[0] == d.verdict[1] ? "" : d.verdict[1].c_str(), d.first_event.c_str(),
                  d.failure.empty() ? original.failure().c_str() : d.failure.c_str());
    } catch (const std::exception& failure) {
      std::printf("%-60s %.200s\n", argv[i], failure.what());
    }
    std::fflush(stdout);
  }
  return 0;
}
