// Prints how honest estimated errors are: models × integrators × settings, the worst of each; or, of random scenes, those
// whose estimate is more than three times too small.
#include "tests/honest/honesty.h"

#include "mbd/base/number_text.h"
#include "mbd/model/method.h"
#include "tests/random/random_scene.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <unistd.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_dishonest = 3.0; // errors follow tolerances within some factor, not exactly

// How tight estimates are: of all numbers together, whatever their kind.
void print_tightness(std::vector<double> values) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) { return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))]; };
  std::printf("  estimate over error of %zu numbers:", values.size());
  for (const double share : {0.0, 0.001, 0.01, 0.05, 0.5, 0.95}) std::printf("  %g %% below %.3g", 100.0 * share, at(share));
  const auto small = std::lower_bound(values.begin(), values.end(), 1.0) - values.begin();
  std::printf("  (%td below 1)\n", small);
}

// The first and last seed, the method and its setting.
int judge_random(std::uint64_t first, std::uint64_t last, const std::string& integrator, double setting) {
  const std::string folder = std::filesystem::temp_directory_path() / ("honesty_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  long runs = 0, dishonest = 0, unknown = 0, numbers = 0, numbers_unknown = 0;
  std::vector<double> tightness;
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
      tightness.insert(tightness.end(), h.tightness.begin(), h.tightness.end());
      numbers += h.count;
      numbers_unknown += h.unknown;
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
  std::printf("  %ld of %ld numbers unknown\n", numbers_unknown, numbers);
  print_tightness(tightness);
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  if (argc == 6 && argv[1] == std::string("random"))
    return judge_random(std::strtoull(argv[2], nullptr, 10), std::strtoull(argv[3], nullptr, 10), argv[4], std::strtod(argv[5], nullptr));
  if (argc < 3) {
    std::fprintf(stderr, "usage: honesty LONGEST MODEL...          all methods\n       honesty LONGEST INTEGRATOR SETTING MODEL...\n       "
                         "honesty random FIRST LAST INTEGRATOR SETTING\n");
    return 2;
  }
  const double longest = std::strtod(argv[1], nullptr);
  std::vector<std::pair<std::string, double>> settings{
      {"dop853", 1e-4},  {"dop853", 1e-6}, {"dop853", 1e-8}, {"tsit5", 1e-4}, {"tsit5", 1e-6}, {"tsit5", 1e-8},  {"rodas5p", 1e-4},
      {"rodas5p", 1e-6}, {"auto", 1e-5},   {"auto", 1e-8},   {"rk4", 1e-3},   {"rk4", 2e-4},   {"moreau", 1e-3}, {"moreau", 2e-4}};
  int first = 2;
  if (argc > 4 && std::ranges::count(method_names(), argv[2]) > 0) {
    settings = {{argv[2], std::strtod(argv[3], nullptr)}};
    first = 4;
  }
  for (int i = first; i < argc; ++i) {
    const Truth truth(argv[i], longest);
    std::printf("%s %s\n", argv[i], truth.failure().c_str());
    if (!truth.failure().empty()) continue;
    for (const auto& [integrator, setting] : settings) {
      const Judged judged = truth.judged(integrator, setting);
      if (!judged.failure.empty()) std::printf("  %-8s %g: no estimate: %.60s\n", integrator.c_str(), setting, judged.failure.c_str());
      std::vector<double> tightness;
      for (const Honesty& h : judged.kinds)
        if (h.kind != "times of extremes") tightness.insert(tightness.end(), h.tightness.begin(), h.tightness.end());
      for (const Honesty& h : judged.kinds)
        std::printf("  %-8s %-6g %-18s worst %-9.3g error %-9.2g estimate %-9.2g (%.1e of range) n %ld, %ld unknown, %ld too small  %s\n",
                    integrator.c_str(), setting, h.kind.c_str(), h.worst, h.error, h.estimate, h.most_range, h.count, h.unknown,
                    h.too_small, h.where.c_str());
      print_tightness(std::move(tightness));
    }
    std::fflush(stdout);
  }
  return 0;
}
