#include "mbd/acceptance/element_judgement.h"
#include "run/catalogue.h"
#include "run/report.h"

#include <doctest/doctest.h>
#include <unistd.h>

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
