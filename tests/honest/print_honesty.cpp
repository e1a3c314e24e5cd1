// Prints how honest estimated errors are: models × integrators × settings, the worst of each; or, of random scenes, those
// whose estimate is more than three times too small.
#include "tests/honest/honesty.h"

#include "mbd/base/number_text.h"
#include "tests/random/random_scene.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <unistd.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_dishonest = 3.0; // errors follow tolerances within some factor, not exactly

// The first and last seed, the method and its setting.
int judge_random(std::uint64_t first, std::uint64_t last, const std::string& integrator, double setting) {
  const std::string folder = std::filesystem::temp_directory_path() / ("honesty_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  long runs = 0, dishonest = 0, unknown = 0;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const std::string file = folder + "/scene.toml";
    random::write_scene(random::random_scene(seed), file);
    const Truth truth(file, 1e9);
    if (!truth.failure().empty()) continue;
    const Judged judged = truth.judged(integrator, setting);
    if (!judged.failure.empty()) {
      std::printf("%6llu: no estimate: %.100s\n", static_cast<unsigned long long>(seed), judged.failure.c_str());
      continue;
    }
    ++runs;
    bool is_bad = false, is_unknown = false;
    for (const Honesty& h : judged.kinds) {
      if (h.kind == "times of extremes") continue; // of two peaks as high within the error either may be named
      is_unknown |= h.unknown > h.count / 10;
      if (!(h.worst > k_dishonest)) continue;
      is_bad = true;
      std::printf("%6llu: %-18s worst %-9.3g error %-9.2g estimate %-9.2g (%.1e of range) %ld of %ld too small  %s\n",
                  static_cast<unsigned long long>(seed), h.kind.c_str(), h.worst, h.error, h.estimate, h.most_range, h.too_small, h.count,
                  h.where.c_str());
    }
    dishonest += is_bad ? 1 : 0;
    unknown += is_unknown ? 1 : 0;
    std::fflush(stdout);
  }
  std::filesystem::remove_all(folder);
  std::printf("%ld runs, %ld with an estimate more than %s times too small, %ld with a tenth or more unknown\n", runs, dishonest,
              number_text(k_dishonest).c_str(), unknown);
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  if (argc == 6 && argv[1] == std::string("random"))
    return judge_random(std::strtoull(argv[2], nullptr, 10), std::strtoull(argv[3], nullptr, 10), argv[4], std::strtod(argv[5], nullptr));
  if (argc < 3) {
    std::fprintf(stderr, "usage: honesty LONGEST MODEL...\n       honesty random FIRST LAST INTEGRATOR SETTING\n");
    return 2;
  }
  const double longest = std::strtod(argv[1], nullptr);
  const std::vector<std::pair<std::string, double>> settings{
      {"dop853", 1e-4},  {"dop853", 1e-6}, {"dop853", 1e-8}, {"tsit5", 1e-4}, {"tsit5", 1e-6}, {"tsit5", 1e-8},  {"rodas5p", 1e-4},
      {"rodas5p", 1e-6}, {"auto", 1e-5},   {"auto", 1e-8},   {"rk4", 1e-3},   {"rk4", 2e-4},   {"moreau", 1e-3}, {"moreau", 2e-4}};
  for (int i = 2; i < argc; ++i) {
    const Truth truth(argv[i], longest);
    std::printf("%s %s\n", argv[i], truth.failure().c_str());
    if (!truth.failure().empty()) continue;
    for (const auto& [integrator, setting] : settings) {
      const Judged judged = truth.judged(integrator, setting);
      if (!judged.failure.empty()) std::printf("  %-8s %g: no estimate: %.60s\n", integrator.c_str(), setting, judged.failure.c_str());
      for (const Honesty& h : judged.kinds)
        std::printf("  %-8s %-6g %-18s worst %-9.3g error %-9.2g estimate %-9.2g (%.1e of range) n %ld, %ld unknown, %ld too small  %s\n",
                    integrator.c_str(), setting, h.kind.c_str(), h.worst, h.error, h.estimate, h.most_range, h.count, h.unknown,
                    h.too_small, h.where.c_str());
    }
    std::fflush(stdout);
  }
  return 0;
}
