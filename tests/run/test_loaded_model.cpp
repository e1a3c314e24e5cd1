#include "mbd/acceptance/element_judgement.h"
#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "run/catalogue.h"
#include "run/report.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

using namespace steplap;

namespace {

constexpr const char* k_pendulum = R"([simulation]
end = 0.1

[[body]]
name = "bob"
mass = 1.0
inertia = 0.01
position = [1.0, 0.0]

[[element]]
kind = "stay"
name = "rod"
a = "bob"
)";

// A rod that is content with no run.
const ElementKind& stay_kind() {
  static const ElementKind kind = [] {
    ElementKind k = *program_catalogue().find_element("distance");
    k.name = "stay";
    k.judge = [](const Element& element, const Model&, const RunResult&) {
      CriterionResult never;
      never.name = element.name;
      never.consequence = never.outcome = Verdict::reject;
      return ElementJudgement{{never}, {}, ""};
    };
    return k;
  }();
  return kind;
}

} // namespace

// Its core's joints are not there yet: compiled as it is it would never slip.
TEST_CASE("a model as given is completed before it is compiled, or refused") {
  const std::string file = STEPLAP_MODELS "/layouts/three_limb.toml";
  const Model given = read_given_model(file, program_catalogue());
  CHECK_THROWS_WITH_AS(static_cast<void>(compile(given)), doctest::Contains("the model is as given"), ModelError);
  const auto loaded = load_given(given, "three_limb"), read = load_model(file);
  CHECK(loaded->system->channels.size() == read->system->channels.size());
  CHECK(judged_run(loaded).judgement.verdict == judged_run(read).judgement.verdict);
  CHECK_THROWS_AS(judged_run(loaded).write("nowhere"), FileError); // it has no text to be run again from
}

TEST_CASE("what is found after a run, and what was not looked for, forbids to call it hold") {
  const std::string file = STEPLAP_MODELS "/layouts/five_limb.toml";
  RunOptions quick;
  quick.estimating = Estimating::never;
  REQUIRE(judged_run(load_model(file), quick).judgement.verdict == Verdict::hold);
  // Feet 2.4 m from the middle of a tank that reaches 2.2 m.
  const Report beyond = judged_run(load_model(file, {"body.tank.outline=[[-2.2, -1.75], [2.2, -1.75], [2.2, 1.95], [-2.2, 1.95]]"}), quick);
  CHECK(beyond.judgement.verdict == Verdict::open);
  CHECK(std::count_if(beyond.findings.begin(), beyond.findings.end(), [](const Finding& f) { return f.code == "foot_beyond_edge"; }) == 2);
  quick.has_extremes = false;
  CHECK(judged_run(load_model(file), quick).judgement.verdict == Verdict::open);
}

TEST_CASE("a model with a kind of one's own is loaded by a catalogue that has it, and judged by the kind") {
  namespace fs = std::filesystem;
  const fs::path file = fs::temp_directory_path() / ("steplap_stay_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << k_pendulum;

  CHECK_THROWS_WITH_AS(static_cast<void>(load_model(file.string())), doctest::Contains("unknown kind 'stay'"), ModelError);

  std::shared_ptr<const LoadedModel> loaded;
  {
    Catalogue catalogue = program_catalogue();
    catalogue.elements.push_back(&stay_kind());
    loaded = load_model(file.string(), {"simulation.end=0.05"}, catalogue);
  } // the model refers to the kinds and not to the catalogue
  fs::remove(file);

  const Report report = judged_run(loaded);
  CHECK(report.run.result.final_state.t == 0.05);
  CHECK(report.judgement.verdict == Verdict::reject);
  REQUIRE(report.judgement.criteria.size() == 1);
  CHECK(report.judgement.criteria.front().name == "rod");
}
