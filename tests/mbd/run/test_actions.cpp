// What a run with actions says of itself: where it was ended, what it released, and which actions can have no effect.
#include "mbd/run/overview.h"

#include "mbd/run/findings.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

using namespace steplap;

namespace {

// A brake of 4 N m on a disc of 2 kg m² that turns at 10 rad/s, and what else is given.
std::shared_ptr<const LoadedModel> disc(const std::string& more) {
  const auto file = std::filesystem::temp_directory_path() / "steplap_disc_with_a_brake.toml";
  std::ofstream(file) << R"(title = "disc"
gravity = [0.0, 0.0]
[simulation]
end = 5.0
[[body]]
name = "disc"
mass = 1.0
inertia = 2.0
angular_velocity = 10.0
[[element]]
kind = "revolute"
name = "bearing"
a = "disc"
[[element]]
kind = "joint_friction"
name = "brake"
a = "disc"
holds = 4.0
)" << more;
  return load_model(file.string());
}

std::string action(const std::string& name, const std::string& when, const std::string& step, const std::string& more = "") {
  return "[[action]]\nname = \"" + name + "\"\nwhen = \"" + when + "\"\ndo = [\"" + step + "\"]\n" + more;
}
std::string weld(const std::string& name) {
  return "[[element]]\nkind = \"weld\"\nname = \"" + name + "\"\na = \"disc\"\nactive = false\n";
}
const std::string k_bound = "[[acceptance]]\nname = \"speed\"\nchannel = \"disc.omega\"\nat_most = 11.0\n";

std::vector<std::string> codes_of(const std::vector<Finding>& findings, FindingLevel level) {
  std::vector<std::string> codes;
  for (const Finding& finding : findings)
    if (finding.level == level) codes.push_back(finding.code);
  return codes;
}

} // namespace

TEST_CASE("criteria that hold in a run which an action ends hold up to there, and the verdict says so") {
  const Overview ended = overview_of(judged_run(disc(k_bound + action("enough", "2 s", "stop"))));
  CHECK(ended.verdict == Verdict::hold);
  CHECK(ended.reason.starts_with("The one criterion is met up to 2 s, where action 'enough' ends the run"));
  CHECK(overview_of(judged_run(disc(k_bound))).reason.starts_with("The one criterion is met; nearest"));
}

TEST_CASE("a brake that is released slips no more") {
  const Overview overview = overview_of(judged_run(disc(action("off", "disc.omega < '6 rad/s'", "release brake"))));
  const auto slips =
      std::find_if(overview.story.begin(), overview.story.end(), [](const StoryEntry& entry) { return entry.what == StorySubject::slips; });
  REQUIRE(slips != overview.story.end());
  REQUIRE(slips->to.has_value());
  CHECK(*slips->to == doctest::Approx(2.0).epsilon(1e-9)); // 4 rad/s at 2 rad/s²
}

TEST_CASE("what of actions can have no effect is told, and forbids \"hold\"") {
  const auto loaded = disc(k_bound + weld("latch") + weld("caught") + action("catch", "disc.omega < '1 rad/s'", "hold caught") +
                           action("asleep", "1 s", "stop", "armed = false\n") + action("late", "5 s", "stop"));
  const std::vector<std::string> codes = codes_of(findings_of(*loaded), FindingLevel::warning);
  CHECK(codes == std::vector<std::string>{"never_acts", "never_armed", "late_action"});
  const Report report = judged_run(loaded);
  CHECK(report.judgement.verdict == Verdict::open);
  const auto notes = codes_of(findings_after(*loaded, report.run.result), FindingLevel::note);
  CHECK(notes == std::vector<std::string>{"action_waits"});
}

TEST_CASE("what all actions of a model do leaves nothing to be told") {
  const auto loaded = disc(k_bound + weld("latch") + action("catch", "disc.omega < '1 rad/s'", "hold latch", "armed = false\n") +
                           action("set", "1 s", "arm catch"));
  CHECK(findings_of(*loaded).empty());
  const Report report = judged_run(loaded);
  CHECK(report.judgement.verdict == Verdict::hold);
  CHECK(findings_after(*loaded, report.run.result).empty());
}

TEST_CASE("criteria may name events of actions, and of what begins to act") {
  const std::string late = "[[element]]\nkind = \"joint_friction\"\nname = \"late brake\"\na = \"disc\"\nholds = 8.0\nactive = false\n" +
                           action("on", "1 s", "hold late brake");
  const auto forbids = [&](const std::string& element, const std::string& event) {
    const Report report = judged_run(disc(late + "[[acceptance]]\nname = \"never\"\nelement = \"" + element + "\"\nevent = \"" + event +
                                          "\"\nconsequence = \"reject\"\n"));
    return report.judgement.verdict;
  };
  CHECK(forbids("on", "happens") == Verdict::reject);
  CHECK(forbids("late brake", "slips*") == Verdict::reject);
  CHECK_THROWS_WITH_AS(static_cast<void>(forbids("late brake", "opens")), doctest::Contains("no event of 'late brake' is called 'opens'"),
                       ModelError);
}

TEST_CASE("an action that waits for an event which its element cannot have is refused") {
  CHECK_THROWS_WITH_AS(static_cast<void>(disc(action("gone", "bearing opens", "release bearing"))),
                       doctest::Contains("action 'gone': 'when': nothing of 'bearing' has events"), ModelError);
  CHECK_THROWS_WITH_AS(static_cast<void>(disc(action("gone", "brake opens", "release bearing"))),
                       doctest::Contains("no event of 'brake' is called 'opens'"), ModelError);
  CHECK(disc(action("gone", "brake sticks", "stop")) != nullptr);
}

TEST_CASE("limits by which a run is judged cannot be set within it") {
  const auto file = std::filesystem::temp_directory_path() / "steplap_limit_set.toml";
  for (const char* const field : {"least_margin", "most_slide"}) {
    std::ofstream(file) << "extends = \"" STEPLAP_MODELS "/paper/no_interference.toml\"\n" +
                               action("lax", "0.1 s", "set front joint." + std::string(field) + " = 1");
    CHECK_THROWS_WITH_AS(static_cast<void>(load_model(file.string())), doctest::Contains("a run is judged by one limit"), ModelError);
  }
}
