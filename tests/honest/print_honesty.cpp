// Prints how honest estimated errors are: models × integrators × settings, the worst of each.
#include "tests/honest/honesty.h"

#include <cstdio>
#include <cstdlib>

using namespace steplap;
using namespace steplap::testing;

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: honesty LONGEST MODEL...\n");
    return 2;
  }
  const double longest = std::strtod(argv[1], nullptr);
  const std::vector<std::pair<std::string, double>> settings{
      {"dop853", 1e-4}, {"dop853", 1e-6}, {"dop853", 1e-8}, {"tsit5", 1e-4}, {"tsit5", 1e-6}, {"tsit5", 1e-8}, {"rodas5p", 1e-4},
      {"rodas5p", 1e-6}, {"auto", 1e-5}, {"auto", 1e-8}, {"rk4", 1e-3}, {"rk4", 2e-4}, {"moreau", 1e-3}, {"moreau", 2e-4}};
  for (int i = 2; i < argc; ++i) {
    const Truth truth(argv[i], longest);
    std::printf("%s %s\n", argv[i], truth.failure().c_str());
    if (!truth.failure().empty()) continue;
    for (const auto& [integrator, setting] : settings) {
      const Judged judged = truth.judged(integrator, setting);
      if (!judged.failure.empty()) std::printf("  %-8s %g: no estimate: %.60s\n", integrator.c_str(), setting, judged.failure.c_str());
      for (const Honesty& h : judged.kinds)
        std::printf("  %-8s %-6g %-18s worst %-9.3g error %-9.2g estimate %-9.2g (%.1e of range) n %ld, %ld unknown, %ld too small  %s\n", integrator.c_str(), setting,
                    h.kind.c_str(), h.worst, h.error, h.estimate, h.most_range, h.count, h.unknown, h.too_small, h.where.c_str());
    }
    std::fflush(stdout);
  }
  return 0;
}
