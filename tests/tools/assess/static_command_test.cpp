// steplap assess --static: exit codes, files, and what is refused.
#include "tests/tools/steplap/workbench.h"

#include "mbd/base/diagnostics.h"
#include "tools/assess/static_preset.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

using namespace steplap::testing;

namespace {

const std::string k_paper = STEPLAP_MODELS "/paper/interference.toml";

struct Folder {
  fs::path path = fs::temp_directory_path() / ("steplap_static_" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
};

std::string own(double pull) {
  return "name = 'own'\nsource = 'a test'\n[[case]]\nname = 'forward'\npull = ['" + std::to_string(pull) + " gravity', 0]\n";
}

} // namespace

TEST_CASE("exit codes: proven, rejected, open") {
  const Folder folder;
  const std::string mild = folder.file("mild.toml", own(0.1)), hard = folder.file("hard.toml", own(5.0));
  CHECK(steplap_does({"assess", "--static", mild, "--directions", "0", k_paper}).code == 0);
  const Outcome rejected = steplap_does({"assess", "--static", hard, "--directions", "0", k_paper});
  CHECK(rejected.code == 5);
  CHECK(has(rejected.out, "reject"));
  const std::string up = folder.file("up.toml", "name = 'up'\nsource = 'a test'\n[[case]]\nname = 'up'\npull = [0, 9.81]\n");
  const Outcome open = steplap_does({"assess", "--static", up, "--directions", "0", STEPLAP_MODELS "/paper/no_interference.toml"});
  CHECK(open.code == 4);
  CHECK(has(open.out, "nothing holds"));
}

TEST_CASE("static.json has what the screen says, and is not overwritten unasked") {
  const Folder folder;
  const std::string out = (folder.path / "out").string();
  const Outcome first = steplap_does({"assess", "--static", "road", "--plane", "lengthwise", "--directions", "8", k_paper, "-o", out});
  CHECK(first.code != 3);
  CHECK(std::count(first.out.begin(), first.out.end(), '\n') <= 30);
  const auto proof = nlohmann::json::parse(text_of(folder.path / "out" / "static.json"))["static_proofs"][0];
  CHECK(proof["preset"] == "road");
  CHECK(proof["cases"].size() == 2);
  CHECK(proof["cases"][0]["ax"].get<double>() == doctest::Approx(0.8 * 9.81));
  CHECK(proof["cases"][0]["ay"].get<double>() == -9.81);
  CHECK(proof["cases"][1]["load"][0].get<double>() == doctest::Approx(-0.5 * 9.81));
  CHECK(proof["polar"].size() == 8);
  for (const auto& direction : proof["polar"])
    if (!direction["acceleration"].is_null()) {
      CHECK(direction["error"].get<double>() <= 1e-6 * direction["acceleration"].get<double>());
      CHECK_FALSE(direction["first"].get<std::string>().empty());
    }
  const Outcome second = steplap_does({"assess", "--static", "road", "--plane", "lengthwise", k_paper, "-o", out});
  CHECK(second.code == 2);
  CHECK(has(second.err, "exists"));
}

TEST_CASE("the same proof has the same bytes") {
  const std::vector<std::string> command = {"assess", "--static", "iec-1g", "--directions", "6", "--json", k_paper};
  CHECK(steplap_does(command).out == steplap_does(command).out);
}

TEST_CASE("what is wrong is said once, with place and remedy") {
  const Folder folder;
  const auto refused = [&](std::vector<std::string> arguments, int code, const std::string& part) {
    arguments.insert(arguments.begin(), "assess");
    const Outcome outcome = steplap_does(arguments);
    CHECK_MESSAGE(outcome.code == code, part, outcome.err);
    CHECK_MESSAGE(has(outcome.err, part), outcome.err);
    CHECK_MESSAGE(outcome.out.empty(), outcome.out);
    CHECK_MESSAGE(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1, outcome.err);
  };
  refused({"--static", "iec-2g", k_paper}, 2, "is no preset of static loads: take one of iec-1g, road, sea");
  refused({"--static", "road", k_paper}, 2, "say which one the models show, with --plane");
  refused({"--static", "road", "--plane", "sideways", k_paper}, 2, "give lengthwise or transverse");
  refused({"--static", "iec-1g", "--directions", "7.5", k_paper}, 2, "whole number");
  for (const std::string option :
       {"--second", "--voyage", "--shipment", "--accept", "--criteria", "--samples", "--seed", "--budget", "--pulse"})
    refused({"--static", "iec-1g", "--directions", "0", option, "1", k_paper}, 2, option + " is of no use with --static");
  refused({"--static", "iec-1g", "--directions", "-1", k_paper}, 2, "from 0 to 3600");
  refused({"--static", "iec-1g", "--largest", "nan", k_paper}, 2, "from 0.001 to");
  refused({"--static", (folder.path / "none.toml").string(), k_paper}, 3, "none.toml");
  const auto preset = [&](const std::string& text) { return folder.file("own.toml", text); };
  refused({"--static", preset("name = 'a'\nsource = 'b'\n"), k_paper}, 3, "there are no loads");
  refused({"--static", preset("name = 'a'\n[[case]]\nname = 'x'\npull = [1, 0]\n"), k_paper}, 3, "source");
  refused({"--static", preset("name = 'a'\nsource = 'b'\n[[case]]\nname = 'x'\npull = [1]\n"), k_paper}, 3, "own.toml:5");
  refused({"--static", preset("name = 'a'\nsource = 'b'\n[[case]]\nname = 'x'\npull = ['1 kN', 0]\n"), k_paper}, 3, "own.toml:5");
  for (const char* const pull : {"[1e6, 0]", "[0, nan]", "[-inf, 0]"})
    refused({"--static", preset("name = 'a'\nsource = 'b'\n[[case]]\nname = 'x'\npull = " + std::string(pull) + "\n"), k_paper}, 3,
            "own.toml:");
  refused({"--static", preset("name = 'a'\nsource = 'b'\n[[case]]\nname = 'x'\npull = [1, 0]\nplane = 'up'\n"), k_paper}, 3, "own.toml:6");
  refused(
      {"--static", preset("name = 'a'\nsource = 'b'\n[[case]]\nname = 'x'\npull = [1, 0]\n[[case]]\nname = 'x'\npull = [2, 0]\n"), k_paper},
      3, "two cases 'x'");
  refused({"--static", preset("name = 'a'\nsource = 'b'\n[[case]]\nname = 'x'\npul = [1, 0]\npull = [1, 0]\n"), k_paper}, 3, "'pul'");
  refused({"--static", preset("name = 'a'\nsource = 'b'\n[[case]]\nname = 'x'\npull = [1, 0]\nplane = 'transverse'\n"), "--plane",
           "lengthwise", k_paper},
          2, "has no load for a model");
}
