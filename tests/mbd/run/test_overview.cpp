// What summary.json and the screen begin with: verdict and reason, what happened, how near the limits.
#include "mbd/run/overview.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;

namespace {

Report run_of(const std::string& model, const std::vector<std::string>& overrides = {}) {
  return judged_run(load_model(std::string(STEPLAP_MODELS) + "/" + model + ".toml", overrides));
}

const StoryEntry* entry_of(const Overview& overview, const std::string& who, StorySubject what) {
  for (const StoryEntry& entry : overview.story)
    if (entry.what == what && std::find(entry.who.begin(), entry.who.end(), who) != entry.who.end()) return &entry;
  return nullptr;
}

} // namespace

TEST_CASE("a joint that slips is the reason, the first one, and the story tells of it with the events' own times") {
  const Report report = run_of("paper/weak_clamping");
  const Overview overview = overview_of(report);
  CHECK(overview.verdict == Verdict::inspect);
  CHECK(overview.reason.starts_with("Joint 'back joint' slips at 0.11 s and slides 0.855 mm."));
  const StoryEntry* slip = entry_of(overview, "back joint", StorySubject::slips);
  REQUIRE(slip != nullptr);
  std::vector<double> begins, ends;
  for (const Event& event : report.run.result.events) {
    if (event.element == "back joint" && is_slip(event.kind)) begins.push_back(event.t);
    if (event.element == "back joint" && event.kind == EventKind::sticks) ends.push_back(event.t);
  }
  CHECK(slip->count == begins.size());
  CHECK(slip->from == begins.front());
  CHECK(slip->to == std::optional(ends.back()));
  CHECK(std::find(overview.moved.begin(), overview.moved.end(), "back joint") != overview.moved.end());
  CHECK(entry_of(overview, "rear foot", StorySubject::lifts) != nullptr);
}

TEST_CASE("a joint that turns about its middle slips, and slides no way that is rounding") {
  const Overview overview = overview_of(run_of("benchmarks/hard/patch_rotation"));
  const StoryEntry* const slip = entry_of(overview, "joint", StorySubject::slips);
  REQUIRE(slip != nullptr);
  CHECK(slip->text == "Joint slips from 0.0517 s to the end.");
}

TEST_CASE("a wheel leaves its track as a foot its floor: it lifts") {
  const Overview overview = overview_of(judged_run(load_model(std::string(STEPLAP_TEST_DATA) + "/defects/wheelie.toml", {})));
  CHECK(entry_of(overview, "front tyre", StorySubject::lifts) != nullptr);
  CHECK(entry_of(overview, "front tyre", StorySubject::opens) == nullptr);
}

TEST_CASE("a crate tips against the deck on which it stands, not with it") {
  // The deck rolls by 20°. A cube stays on it; a crate of 0.2 m by 1 m tips at atan 0.2 = 11.3° of slope.
  const auto tip_of = [](const std::vector<std::string>& overrides) {
    std::vector<std::string> all{"simulation.end=12"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    const Overview overview = overview_of(judged_run(load_model(STEPLAP_MODELS "/../docs/cookbook/ship.toml", all)));
    const StoryEntry* const tip = entry_of(overview, "crate", StorySubject::tips);
    return tip ? tip->amount->value : 0.0;
  };
  CHECK(tip_of({}) == 0.0);
  const std::vector<std::string> slender{"body.crate.outline=[[-0.1, -0.5], [0.1, -0.5], [0.1, 0.5], [-0.1, 0.5]]"};
  CHECK(tip_of(slender) > 1.0); // it falls on its side
  std::vector<std::string> unsampled = slender;
  unsampled.push_back("output.channels=[\"crate.x\"]");
  CHECK(tip_of(unsampled) > 1.0 - 20.0 / 180.0 * 3.14159265358979); // at least the difference of both angles
}

TEST_CASE("utilisations are sorted, and those beyond their limits are the criteria that are not met") {
  for (const char* const model : {"paper/weak_clamping", "paper/no_interference", "layouts/three_limb_humping"}) {
    CAPTURE(model);
    const Report report = run_of(model);
    const Overview overview = overview_of(report);
    const auto& all = overview.utilisations;
    CHECK(std::is_sorted(all.begin(), all.end(), [](const Utilisation& a, const Utilisation& b) { return a.share > b.share; }));
    for (const CriterionResult& c : report.judgement.criteria) {
      if (!c.value || !c.limit) continue;
      const auto found = std::find_if(all.begin(), all.end(),
                                      [&](const Utilisation& u) { return u.criterion && u.channel == c.channel && u.limit == c.limit; });
      REQUIRE(found != all.end());
      CHECK(found->beyond == (c.outcome != Verdict::hold));
      if (c.reserve && *c.reserve > 0.0) CHECK(found->share < 1.0);
      if (c.reserve && *c.reserve < 0.0) CHECK(found->share > 1.0);
    }
  }
}

TEST_CASE("a force of half its limit has half a share, a margin of twice what is asked, too") {
  const Report report = run_of("paper/no_interference");
  for (const Utilisation& u : overview_of(report).utilisations) {
    if (u.name == "bottom arresting devices") CHECK(u.share == doctest::Approx(std::abs(*u.value) / 300e3).epsilon(1e-12)); // rounding
    if (u.name.starts_with("joint margin")) CHECK(u.share == doctest::Approx(1.2 / *u.value).epsilon(1e-12));
  }
}

TEST_CASE("a run that holds says what is nearest, a model without criteria that nothing was asked") {
  const Overview holds = overview_of(run_of("paper/no_interference"));
  CHECK(holds.verdict == Verdict::hold);
  CHECK(holds.reason == "All 14 criteria are met; nearest to its limit is 'bottom arresting devices', with 65 %.");
  CHECK(holds.trust.level == TrustLevel::good);
  const Overview asks_nothing = overview_of(run_of("machines/cradle"));
  CHECK(asks_nothing.verdict == Verdict::open);
  CHECK(asks_nothing.reason.starts_with("The model has no criteria"));
}

TEST_CASE("a run that breaks off has no trust and says where it stopped") {
  const Overview overview = overview_of(run_of("paper/no_interference", {"simulation.max_events=3"}));
  CHECK(overview.trust.level == TrustLevel::none);
  CHECK(overview.verdict == Verdict::open);
  CHECK(overview.reason.starts_with("The run stopped at "));
}

TEST_CASE("reactions that diverge have no error, and trust says so") {
  // Driven through the pose in which all links lie on one line, the pins bear forces without bound along it: 2 of each of 2 chains.
  const Report report = run_of("benchmarks/hard/singular_parallelogram");
  REQUIRE(report.estimate.errors.has_value());
  const Overview overview = overview_of(report);
  CHECK(overview.trust.level == TrustLevel::limited);
  CHECK(overview.trust.text.find("Those of 4 channels, such as 'pin of first.force_x', are not known.") != std::string::npos);
}

TEST_CASE("many elements that do the same are one entry") {
  const Overview overview = overview_of(run_of("machines/pile"));
  CHECK(overview.story.size() <= 8);
  const StoryEntry* slips = entry_of(overview, "stones.stone 1 on ground", StorySubject::slips);
  REQUIRE(slips != nullptr);
  CHECK(slips->who.size() > 5);
}
