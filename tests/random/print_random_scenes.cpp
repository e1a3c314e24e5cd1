// Runs random scenes and prints what disagrees or stops, or writes their model files.
//
//   random_scenes run FIRST LAST [--shrink DIR] [--all] [--friction]   seeds FIRST to LAST
//   random_scenes write SEED FILE                                      the scene as a model file
#include "mbd/base/number_text.h"
#include "tests/random/random_scene.h"
#include "tests/random/scene_check.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <unistd.h>
#include <vector>

using namespace steplap;
using namespace steplap::random;

namespace {

struct Options {
  std::string shrink_to;
  bool is_all = false;
};

std::string cells_of(const Scene& scene) {
  std::string text;
  for (const std::string& cell : scene.cells) text += (text.empty() ? "" : ", ") + cell;
  return text;
}

std::string doubts_of(const SceneResult& result) {
  std::string text;
  for (const Disagreement& d : result.check.disagreements)
    text += std::string(text.empty() ? "" : "; ") + name_of(d.doubt) + " " + d.first + (d.second.empty() ? "" : "/" + d.second);
  return text;
}

void print_one(const Scene& scene, const SceneResult& result) {
  std::printf("%6llu | %s | %.2f s | %s | %s\n", static_cast<unsigned long long>(scene.seed), cells_of(scene).c_str(), result.seconds,
              result.text().c_str(), doubts_of(result).c_str());
  for (const CrossRun& run : result.check.runs)
    if (!run.failure.empty()) std::printf("       | %s stops: %s\n", run.setting.text().c_str(), run.failure.c_str());
  std::fflush(stdout);
}

void keep_shrunk(const Scene& scene, const SceneResult& result, const std::string& to, const std::string& folder) {
  if (!result.model_error.empty()) return;
  const Scene small = shrunk(scene, result, folder);
  const SceneResult again = check_scene(small, folder);
  std::string comment = "# seed " + std::to_string(scene.seed) + " (" + cells_of(scene) + "), made smaller\n";
  for (const Disagreement& d : again.check.disagreements)
    comment += std::string("# ") + name_of(d.doubt) + ": " + d.first + (d.second.empty() ? "" : " / " + d.second) + ", " + d.where +
               " at " + number_text(d.t) + " s, " + d.text + "; ratio " + number_text(d.ratio) + "\n";
  write_scene(small, to + "/seed_" + std::to_string(scene.seed) + ".toml", comment);
}

int run(std::uint64_t first, std::uint64_t last, const Options& options) {
  const std::string folder = std::filesystem::temp_directory_path() / ("random_scenes_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  long agreed = 0, vague = 0, bad = 0, stopped = 0;
  double seconds = 0.0, worst_agreed = 0.0;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const Scene scene = random_scene(seed);
    const SceneResult result = check_scene(scene, folder);
    seconds += result.seconds;
    const auto stops =
        std::count_if(result.check.runs.begin(), result.check.runs.end(), [](const CrossRun& r) { return !r.failure.empty(); });
    stopped += stops;
    if (result.is_bad()) ++bad;
    else if (result.check.outcome == CrossOutcome::vague) ++vague;
    else ++agreed;
    if (!result.is_bad()) worst_agreed = std::max(worst_agreed, result.check.worst_ratio);
    if (options.is_all || result.is_bad() || stops > 0) print_one(scene, result);
    if (result.is_bad() && !options.shrink_to.empty()) keep_shrunk(scene, result, options.shrink_to, folder);
  }
  std::filesystem::remove_all(folder);
  std::printf("%ld agree, %ld cannot be told apart to the end, %ld disagree; %ld runs stopped; worst ratio of those that "
              "agree %.2g; %.1f s of CPU time\n",
              agreed, vague, bad, stopped, worst_agreed, seconds);
  return bad > 0 ? 4 : 0;
}

int usage() {
  std::fprintf(stderr, "random_scenes run FIRST LAST [--shrink DIR] [--all]\nrandom_scenes write SEED FILE\n");
  return 2;
}

} // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 3) return usage();
  if (words[0] == "write") {
    write_scene(random_scene(std::strtoull(words[1].c_str(), nullptr, 10)), words[2]);
    return 0;
  }
  if (words[0] != "run") return usage();
  Options options;
  for (std::size_t i = 3; i < words.size(); ++i) {
    if (words[i] == "--all") options.is_all = true;
    else if (words[i] == "--shrink" && i + 1 < words.size()) options.shrink_to = words[++i];
    else return usage();
  }
  return run(std::strtoull(words[1].c_str(), nullptr, 10), std::strtoull(words[2].c_str(), nullptr, 10), options);
}
