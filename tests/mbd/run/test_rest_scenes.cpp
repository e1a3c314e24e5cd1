// Scenes in which nothing moves, or friction holds what acts: neither rounding, nor what projection leaves of joints, nor what the
// tolerance leaves of a motion that is none may make such a run one that is not to be trusted.
#include "mbd/run/report.h"
#include "tests/mbd/run/rest_scenes.h"
#include "tests/sanitized.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>

using namespace steplap;
using namespace steplap::testing;

namespace {

#ifdef STEPLAP_TESTS_SANITIZED
constexpr std::uint64_t k_scenes = 20; // ten times as slow
#else
constexpr std::uint64_t k_scenes = 200;
#endif

bool has_doubt(const Report& report) {
  return std::any_of(report.judgement.criteria.begin(), report.judgement.criteria.end(),
                     [](const CriterionResult& c) { return !c.doubt.empty(); });
}

} // namespace

TEST_CASE("no random scene at rest is distrusted or open, whatever the method") {
  std::map<std::string, int> kinds, methods;
  int uncapped = 0;
  for (std::uint64_t seed = 1; seed <= k_scenes; ++seed) {
    const RestScene scene = random_rest_scene(seed);
    CAPTURE(seed);
    CAPTURE(scene.kind);
    CAPTURE(scene.method);
    CAPTURE(scene.load);
    RunOptions options;
    options.has_second_opinion = true;
    const Report report = judged_run(load_model_text(scene.text, "rest.toml"), options);
    CHECK_FALSE(report.run.failure.has_value());
    CHECK(report.judgement.distrust.empty());
    CHECK_FALSE(has_doubt(report));
    // An implausible value of a random scene, such as an unusual pressure, caps its verdict rightly.
    if (!report.judgement.caps.empty()) continue;
    ++uncapped;
    CHECK(report.judgement.verdict == Verdict::hold);
    ++kinds[scene.kind];
    ++methods[scene.method];
  }
  CHECK(10 * uncapped > 6 * static_cast<int>(k_scenes));
  if (k_scenes > 100) {
    CHECK(kinds.size() >= 6);
    CHECK(methods.size() == 6);
  }
}
