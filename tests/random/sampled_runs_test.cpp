// A run does not hang on how often it is sampled: random scenes and every model of models/. What is sampled of random scenes lies within
// the extremes that are told.
#include "mbd/io/reader.h"
#include "mbd/rest/assembly.h"
#include "tests/random/random_scene.h"
#include "tests/random/sampled_runs.h"
#include "tests/sanitized.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <unistd.h>

using namespace steplap;
using namespace steplap::random;

namespace {

#ifdef STEPLAP_TESTS_SANITIZED
constexpr std::uint64_t k_scenes = 10; // ten times as slow
#else
constexpr std::uint64_t k_scenes = 60;
#endif
constexpr double k_longest = 0.1; // s, of models
constexpr int k_samples = 500;

// `has_motion`: nothing else than motion is sampled. At rest what a step leaves between its ends is as large as its tolerance allows, and
// may be all that a channel shows.
void check(const Model& model, const std::string& method, double tolerance, double end, bool has_motion) {
  const auto system = compile(model);
  const State start = assembled_start(*system, assemble(model, *system));
  SimulationOptions options = options_of(model);
  options.integrator = method;
  options.settings.tolerance = tolerance;
  options.end = end;
  const Sampled found = sampled(*system, start, options, k_samples);
  CHECK(found.difference == "");
  if (!has_motion) return;
  for (const Beyond& b : found.beyond) {
    CAPTURE(b.channel);
    CAPTURE(b.t);
    CHECK(b.excess <= b.allowed);
  }
}

} // namespace

TEST_CASE("random scenes do the same however often they are sampled, and no sample lies beyond their extremes") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("steplap_sampled_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const char* const methods[] = {"auto", "dop853", "rodas5p"};
  for (std::uint64_t seed = 1; seed <= k_scenes; ++seed) {
    CAPTURE(seed);
    try {
      const Scene scene = random_scene(seed);
      check(model_of(scene, folder.string()), methods[seed % 3], seed % 2 == 0 ? 1e-4 : 1e-7, scene.end, true);
    } catch (const ModelError&) { // a drive that does not begin where the body is
    }
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("every model does the same however often it is sampled") {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(STEPLAP_MODELS)) {
    const std::string file = entry.path().string();
    if (entry.path().extension() != ".toml" || entry.path().parent_path().filename() == "studies") continue;
    if (file.ends_with("brick_wall.toml") || file.ends_with("pile.toml")) continue; // stiff: half a minute
    if (steplap::testing::k_is_sanitized && ++count % 8 != 0) continue;
    CAPTURE(file);
    const Model model = read_model(file, transformer_catalog());
    check(model, "dop853", 1e-6, std::min(model.simulation.end, k_longest), false);
  }
}
