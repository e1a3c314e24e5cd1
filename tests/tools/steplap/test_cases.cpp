// Load cases: their numbers are those of simulate, the matrix follows from statics, wrong input is refused with its place.
#include "tests/random/random_scene.h"
#include "tests/random/scene_writer.h"
#include "tests/tools/steplap/workbench.h"
#include "tools/steplap/text_layout.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

using namespace steplap;
using namespace steplap::testing;
using Json = nlohmann::ordered_json;

namespace {

Json cases_of(const std::string& file, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"cases", file, "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = steplap_does(arguments);
  CAPTURE(outcome.err);
  CHECK(outcome.code != 3);
  return Json::parse(outcome.out)["results"][0]["load_cases"];
}

// A mass of 100 kg at rest on a spring: whatever the stiffness, the spring carries m (g − pull).
constexpr double k_mass = 100.0, k_g = 9.81;
const std::string k_hanging = R"(format = 1
title = "a mass on a spring"
simulation = { end = 0.1, initial = "equilibrium" }
[[body]]
name = "mass"
mass = 100
inertia = 1
[[element]]
name = "guide"
kind = "prismatic"
a = "mass"
axis = [0, 1]
[[element]]
name = "spring"
kind = "spring_damper"
a = "mass"
b = "ground"
axis = [0, 1]
stiffness = "1 MN/m"
[[acceptance]]
name = "force"
channel = "spring.force"
within = 1500
consequence = "reject"
[[acceptance]]
name = "sag"
channel = "mass.y"
within = "10 mm"
)";

std::string load_case(const std::string& name, const std::string& fields) {
  return "[[case]]\nname = \"" + name + "\"\nsource = \"a test\"\n" + fields + "\n";
}

const std::string k_heaving = k_hanging + load_case("rest", "") + load_case("up", "pull = [0, 4.905]") +
                              load_case("down", "pull = [0, -9.81]\nplane = \"transverse\"");

// Cases of a random scene: other gravity, another end, another body twice as heavy.
struct RandomCases {
  std::string text;
  std::vector<std::vector<std::string>> overrides;
};

RandomCases random_cases(const steplap::random::Scene& scene) {
  RandomCases cases{scene.text("format = 1\n"), {}};
  std::string body;
  for (const auto& block : scene.blocks)
    if (block.table == "body" && body.empty()) body = block.name;
  const std::string end = steplap::random::number(0.5 * scene.end);
  cases.overrides = {{"gravity=[0.7, -8.5]"}, {"simulation.end=" + end}, {"body." + body + ".velocity=[0, 0]", "gravity=[0, -4]"}};
  cases.text += "[[acceptance]]\nname = \"far\"\nchannel = \"" + body + ".x\"\nwithin = 3\n";
  cases.text += "[[acceptance]]\nname = \"slip\"\nevent = \"slips*\"\nelement = \"*\"\n";
  for (std::size_t i = 0; i < cases.overrides.size(); ++i) {
    std::string set;
    for (const std::string& change : cases.overrides[i]) set += "\"" + change + "\", ";
    cases.text += load_case(std::to_string(i), "set = [" + set + "]\n");
  }
  return cases;
}

} // namespace

TEST_CASE("of random machines every number of a case is that of simulate with the same overrides") {
  const char* const asked = std::getenv("STEPLAP_CASE_SCENES"); // more than a test has time for
  const std::uint64_t scenes = asked ? std::stoul(asked) : 60;
  const Workbench bench;
  std::size_t judged = 0;
  for (std::uint64_t seed = 1; seed <= scenes; ++seed) {
    CAPTURE(seed);
    const steplap::random::Scene scene = steplap::random::random_scene(seed);
    RandomCases cases = random_cases(scene);
    for (const auto& [name, text] : scene.files) (void)bench.write(name, text);
    const std::string file = bench.write("scene.toml", cases.text);
    const Outcome outcome = steplap_does({"cases", file, "--json"});
    if (outcome.code == 3 && has(outcome.err, "event")) continue; // nothing in the scene can slip
    REQUIRE(outcome.code != 3);
    const Json found = Json::parse(outcome.out)["results"][0]["load_cases"];
    for (std::size_t i = 0; i < cases.overrides.size(); ++i) {
      CAPTURE(i);
      const std::string out = bench.at("out");
      std::vector<std::string> arguments{"simulate", file, "-q", "-f", "-o", out};
      for (const std::string& change : cases.overrides[i]) arguments.insert(arguments.end(), {"--set", change});
      fs::remove_all(out);
      const Outcome alone = steplap_does(arguments);
      const Json& one = found["cases"][i];
      CHECK((alone.code == 4) == one.contains("failure"));
      const fs::path summary = fs::path(out) / "scene" / (alone.code == 4 ? "partial_summary.json" : "summary.json");
      if (!fs::exists(summary)) continue; // the run could not even start
      const Json whole = Json::parse(text_of(summary));
      CHECK(one["judgement"].dump() == whole["judgement"].dump());
      CHECK(one["reason"] == whole["overview"]["reason"]);
      ++judged;
    }
  }
  CHECK(judged > scenes); // most of three runs a scene
}

TEST_CASE("the matrix of a mass on a spring is that of statics") {
  const Workbench bench;
  const Json found = cases_of(bench.write("hanging.toml", k_heaving));
  const double pulls[] = {0.0, 0.5 * k_g, -k_g};
  double worst = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Json& one = found["cases"][static_cast<std::size_t>(i)];
    const double force = k_mass * (k_g - pulls[i]);
    const Json& limit = one["limits"][0];
    // The search for rest leaves forces of 1e-9 of the weight.
    CHECK(limit["utilisation"].get<double>() == doctest::Approx(force / 1500.0).epsilon(1e-8));
    CHECK(limit["margin"].get<double>() == doctest::Approx(1500.0 - force).epsilon(1e-8));
    CHECK(one["limits"][1]["utilisation"].get<double>() == doctest::Approx(force / 1e6 / 0.01).epsilon(1e-8));
    CHECK(one["governing_limit"] == "force");
    worst = std::max(worst, force);
  }
  CHECK(worst > 1500.0);
  CHECK(found["verdict"] == "reject");
  CHECK(found["limits"][0]["governing_case"] == "down");
  CHECK(found["limits"][1]["governing_case"] == "down");
  CHECK(found["cases"][2]["overrides"][0] == "gravity=[0, -19.62]");
  CHECK(found["cases"][2]["plane"] == "transverse");
}

TEST_CASE("a case of pull alone is loaded by it, and a case of nothing is not loaded where the signal is zero") {
  const std::string text = k_hanging + R"([[signal]]
name = "jolt"
kind = "half_sine"
peak = 0.0
duration = "50 ms"
[[element]]
name = "jolts"
kind = "load"
at = "mass"
force_y = "jolt"
)" + load_case("rest", "") +
                           load_case("heave", "pull = [0, 4.905]");
  const Workbench bench;
  const Json results = cases_of(bench.write("heaving.toml", text));
  CHECK(results["cases"][0]["verdict"] == "open");
  CHECK(results["cases"][0]["reason"].get<std::string>().find("nothing loads the machine") != std::string::npos);
  CHECK(results["cases"][1]["verdict"] == "hold");
}

TEST_CASE("criteria that do not apply to a case neither judge it nor stand in its column") {
  const Workbench bench;
  const std::string down = "pull = [0, \"-1 gravity\"]\n";
  const Json found =
      cases_of(bench.write("some.toml", k_hanging + load_case("all", down) + load_case("sag", down + "criteria = [\"s*\"]")));
  CHECK(found["cases"][0]["verdict"] == "reject");
  CHECK(found["cases"][1]["verdict"] == "hold"); // it sags by 1.96 mm of 10 mm
  CHECK(found["cases"][1]["limits"].size() == 1);
  CHECK(found["cases"][1]["limits"][0]["limit"] == "sag");
  // A criterion of no case is named.
  const Json one = cases_of(bench.write("one.toml", k_hanging + load_case("sag", down + "criteria = [\"s*\"]")));
  CHECK(has(one["reason"].get<std::string>(), "Judged in no case: 'force'."));
  CHECK_FALSE(has(found["reason"].get<std::string>(), "Judged in no case"));
}

TEST_CASE("exit codes are those of simulate") {
  const Workbench bench;
  const std::string file = bench.write("hanging.toml", k_heaving);
  CHECK(steplap_does({"cases", file}).code == 0);
  CHECK(steplap_does({"cases", file, "--require-hold"}).code == 5);
  CHECK(steplap_does({"cases", file, "--require-hold", "--set", "acceptance.force.within=3000"}).code == 0);
  const std::string falls = bench.write("falls.toml", k_hanging + load_case("falls", "set = [\"element.spring.active=false\"]"));
  const Outcome outcome = steplap_does({"cases", falls}); // no rest, so that the run cannot start
  CHECK(outcome.code == 4);
  CHECK(has(outcome.out, "OPEN"));
}

TEST_CASE("wrong cases are refused, each with file and line") {
  const Workbench bench;
  struct Wrong {
    std::string added, line, message;
  };
  const std::string no_limits = k_hanging.substr(0, k_hanging.find("[[acceptance]]"));
  const auto line_of = [](const std::string& text, const std::string& part) {
    return ":" + std::to_string(1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.rfind(part)), '\n')) + ":";
  };
  const Wrong all[] = {
      {k_hanging + load_case("a", "set = [\"element.sprung.stiffness=1\"]"), "set =", "did you mean 'spring'"},
      {k_hanging + load_case("a", "set = [\"element.spring.stifness=1\"]"), "set =", "stiffness"},
      {k_hanging + load_case("a", "set = [\"element.spring.stiffness=-1\"]"), "set =", "case 'a'"},
      {k_hanging + load_case("a", "set = [\"gravity\"]"), "set =", "path=value"},
      {k_hanging + load_case("a", "") + load_case("a", ""), "name = \"a\"", "exists already"},
      {k_hanging + load_case("a", "criteria = [\"farce\"]"), "criteria =", "did you mean 'force'"},
      {k_hanging + load_case("a", "criteria = []"), "criteria =", "nothing would be judged"},
      {k_hanging + load_case("a", "pull = [0, 1]\nset = [\"gravity.1=-1\"]"), "pull =", "give one of them"},
      {k_hanging + load_case("a", "set = [\"case.a.pull=[0, 1]\"]"), "set =", "changes a load case"},
      {k_hanging + "[[case]]\nname = \"a\"\n", "[[case]]", "needs 'source'"},
      {no_limits + load_case("a", ""), "[[case]]", "has no criteria"},
      {k_hanging, "", "has no load cases"},
  };
  for (const Wrong& wrong : all) {
    CAPTURE(wrong.message);
    const std::string file = bench.write("wrong.toml", wrong.added);
    const Outcome outcome = steplap_does({"cases", file});
    CAPTURE(outcome.err);
    CHECK(outcome.code == 3);
    CHECK(has(outcome.err, wrong.message));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK(has(outcome.err, "wrong.toml"));
    if (!wrong.line.empty()) CHECK(has(outcome.err, "wrong.toml" + line_of(wrong.added, wrong.line)));
  }
  const std::string own = bench.write("own.toml", k_hanging + load_case("a", "set = [\"element.spring.damping=3\"]"));
  const Outcome replaced = steplap_does({"cases", own, "--set", "element.spring.damping=2"});
  CHECK(replaced.code == 3);
  CHECK(has(replaced.err, "case 'a' sets 'element.spring.damping' itself"));
}

TEST_CASE("tables fit into 80 columns, however long the names and however many the cases") {
  const Workbench bench;
  std::string text = k_hanging;
  const std::string long_name = "the force in the spring, which nobody would call by so long a name as this: µ–ü ";
  text.replace(text.find("\"force\""), 7, "\"" + long_name + "\"");
  for (int i = 0; i < 14; ++i) text += load_case(long_name + std::to_string(i), "pull = [0, " + std::to_string(-i) + "]");
  const Outcome outcome = steplap_does({"cases", bench.write("long.toml", text)});
  CHECK(outcome.code == 0);
  // The lorry's tilt is a long number, -0.265 mrad of 17.45 mrad.
  const std::string tilt = "extends = \"" STEPLAP_MODELS "/cases/lorry.toml\"\n[[acceptance]]\nname = \"" + long_name +
                           "\"\nchannel = \"transformer.theta\"\nwithin = \"1 deg\"\n";
  std::istringstream lines(outcome.out + steplap_does({"cases", bench.write("tilt.toml", tilt)}).out);
  for (std::string line; std::getline(lines, line);) CHECK(width_of(line) <= 80);
  std::size_t blocks = 0;
  for (std::size_t at = 0; (at = outcome.out.find("used of limit, case", at)) != std::string::npos; ++at) ++blocks;
  CHECK(blocks == 3); // 6 + 6 + 2 cases
}

TEST_CASE("a case of a file that extends another is merged by its name") {
  const Workbench bench;
  (void)bench.write("base.toml", k_heaving);
  const Json found = cases_of(bench.write("over.toml", "extends = \"base.toml\"\n[[case]]\nname = \"down\"\npull = [0, -1]\n"));
  CHECK(found["cases"].size() == 3);
  CHECK(found["cases"][2]["overrides"][0] == "gravity=[0, -10.81]");
  CHECK(found["verdict"] == "hold");
}

TEST_CASE("the sheet holds the results as data, and markup in names stays text") {
  const Workbench bench;
  const std::string file = bench.write("sheet.toml", k_heaving + load_case("</script><b>bold", ""));
  const std::string sheet = bench.at("sheet.html");
  REQUIRE(steplap_does({"cases", file, "-o", sheet, "-q"}).code == 0);
  const std::string page = text_of(sheet);
  CHECK(has(page, "\"load_cases\""));
  CHECK(!has(page, "<b>bold"));
  CHECK(steplap_does({"cases", file, "-o", sheet}).code == 2); // it is there already
}

TEST_CASE("the lorry's chains carry what statics demands, and less than twice that") {
  const Json found = cases_of(STEPLAP_MODELS "/cases/lorry.toml");
  CHECK(found["verdict"] == "hold");
  CHECK(found["cases"].size() == 6);
  // Sliding balance of EN 12195-1 with friction μ and two chains of 1.5 m along, 1.6 m up and 0.7 m across: 2 T (1.5 + μ 1.6)/L = m (a − μ g).
  // The slide of some millimetres turns the chains by 1 %; a load that acts at once would double the force of a spring, and this acts slowly.
  const double mass = 25e3, friction = 0.3, length = std::sqrt(1.5 * 1.5 + 1.6 * 1.6 + 0.7 * 0.7);
  const double needed = mass * (0.8 * 9.80665 - friction * k_g) * length / (2.0 * (1.5 + friction * 1.6));
  const double force = found["cases"][0]["judgement"]["criteria"][0]["value"].get<double>();
  CHECK(force > 0.99 * needed);
  CHECK(force < 2.0 * needed);
  CHECK(found["limits"][0]["governing_case"] == "1 g forward");
}
