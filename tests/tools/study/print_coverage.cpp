// How often intervals of 95 % hold the exact probability: limit states of known_cases.h, many seeds each.
//
//   print_coverage [--seeds 400] [--method importance_sampling] [--cov 0.2 0.1 0.05] [--case RP35] [--scratch /dev/shm]
//
// A row for each case: in how many of a hundred seeds the interval holds the exact value, and by what the mean of the
// estimates is off, at each coefficient of variation that was asked for. Studies run as they do for users, each with a
// store of its own, in as many processes as there are cases named.
#include "tests/tools/study/known_cases.h"
#include "tools/study/kinds.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <unistd.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

struct Options {
  long seeds = 400;
  std::string method = "importance_sampling", only, scratch = std::filesystem::temp_directory_path().string();
  std::vector<double> covs{0.2, 0.1, 0.05};
};

Options options_of(int count, char** words) {
  Options o;
  for (int i = 1; i + 1 < count; ++i) {
    const std::string word = words[i];
    if (word == "--seeds") o.seeds = std::atol(words[++i]);
    else if (word == "--method") o.method = words[++i];
    else if (word == "--case") o.only = words[++i];
    else if (word == "--scratch") o.scratch = words[++i];
    else if (word == "--cov") {
      o.covs.clear();
      while (i + 1 < count && words[i + 1][0] != '-') o.covs.push_back(std::atof(words[++i]));
    }
  }
  return o;
}

study::Finding estimate_of(const std::string& text, const std::string& method, const std::string& store_path) {
  const study::LoadedStudy loaded = study::parse_study(text, "case.toml");
  std::filesystem::remove(store_path);
  study::Store store(store_path, study::identity_of(loaded), study::StoreMode::run);
  std::vector<Diagnostic> problems;
  const study::JointLaw law(loaded.study, loaded.nominal, problems);
  static const study::Ranks ranks;
  study::Evaluator evaluator(loaded, store, ranks, 1, {});
  study::StudyRun run{loaded, law, evaluator};
  for (const study::StudyKind& kind : study::study_kinds()) {
    if (kind.name != "reliability") continue;
    for (const study::Finding& f : kind.run(run).findings)
      if (f.method == method && f.quantity == "probability") return f;
  }
  return {};
}

} // namespace

int main(int count, char** words) {
  const Options o = options_of(count, words);
  const std::string store = o.scratch + "/steplap_coverage_" + std::to_string(getpid()) + ".sqlite";
  std::printf("| %s, %ld seeds |", o.method.c_str(), o.seeds);
  for (const double cov : o.covs) std::printf(" cov %g | mean | samples |", cov);
  std::printf("\n");
  long held_in_all = 0, all = 0;
  for (const KnownCase& c : known_cases()) {
    if (!o.only.empty() && o.only != c.name) continue;
    std::printf("| %s |", c.name);
    for (const double cov : o.covs) {
      long held = 0;
      double sum = 0.0, samples = 0.0;
      for (long seed = 1; seed <= o.seeds; ++seed) {
        const std::string text =
            "seed = " + std::to_string(seed) + "\n" + text_of_case(c, {o.method}, "cov = " + std::to_string(cov) + "\n");
        const study::Finding f = estimate_of(text, o.method, store);
        held += f.low <= c.probability && c.probability <= f.high;
        sum += f.value / c.probability;
        samples += static_cast<double>(f.samples);
      }
      const double n = static_cast<double>(o.seeds);
      std::printf(" %.2f %% | %+.1f %% | %.0f |", 100.0 * static_cast<double>(held) / n, 100.0 * (sum / n - 1.0), samples / n);
      std::fflush(stdout);
      held_in_all += held;
      all += o.seeds;
    }
    std::printf("\n");
  }
  std::printf("mean of all: %.2f %%\n", 100.0 * static_cast<double>(held_in_all) / static_cast<double>(all));
  std::filesystem::remove(store);
  return 0;
}
