// "-" is the standard input and output, of every command that reads or writes a file; what cannot be, is said.
#include "tests/tools/steplap/workbench.h"

#include "tools/steplap/commands.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>

#include <algorithm>
#include <map>

using namespace steplap;
using namespace steplap::testing;

namespace {

// The standard input of this process comes from a file.
class Input {
public:
  explicit Input(const std::string& path) : kept_(::dup(STDIN_FILENO)) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    REQUIRE(file >= 0);
    ::dup2(file, STDIN_FILENO);
    ::close(file);
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;
  ~Input() {
    ::dup2(kept_, STDIN_FILENO);
    ::close(kept_);
  }

private:
  int kept_;
};

Outcome does_with(const std::string& input, const std::vector<std::string>& arguments) {
  const Input from(input);
  return steplap_does(arguments);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) text.replace(at, what.size(), by);
  return text;
}

bool is_model(const Option& option) { return option.names.starts_with("MODEL") || option.names == "BEFORE"; }

} // namespace

TEST_CASE("every command that reads a model reads it from the standard input and says the same") {
  const Workbench bench;
  // "stdin" is what its results are called; the file has that name so that both say the same.
  const std::string folder = STEPLAP_MODELS "/layouts/";
  const std::string model =
      bench.write("stdin.toml", replaced(text_of(folder + "three_limb.toml"), "\"trailer.toml\"", "\"" + folder + "trailer.toml\"") +
                                    "\n[[case]]\nname = \"short\"\nsource = \"a test\"\nset = [\"simulation.end=0.02\"]\n");
  const std::map<std::string, std::vector<std::string>> more = {
      {"simulate", {"--end", "0.02", "-f", "--no-estimate", "-o", bench.at("out")}},
      {"accuracy", {"--end", "0.02", "--setting", "rk4@1e-2", "-f", "-q", "-o", bench.at("acc")}},
      {"diff", {folder + "three_limb.toml"}}};
  int tried = 0;
  for (const Command& command : all_commands()) {
    if (std::none_of(command.options.begin(), command.options.end(), is_model)) continue;
    CAPTURE(command.name);
    if (command.name == "explore") { // serves until it is told to end, and watches files
      CHECK(does_with(model, {"explore", "-", "--no-browser"}).code == 2);
      continue;
    }
    const auto call = [&](const std::string& file) {
      std::vector<std::string> arguments{command.name, file};
      if (more.contains(command.name)) arguments.insert(arguments.end(), more.at(command.name).begin(), more.at(command.name).end());
      return arguments;
    };
    const Outcome by_name = steplap_does(call(model)), by_input = does_with(model, call("-"));
    CHECK_MESSAGE(by_name.code == 0, by_name.err);
    CHECK_MESSAGE(by_input.code == 0, by_input.err);
    CHECK(replaced(by_input.out, "<standard input>", model) == replaced(by_name.out, model + " →", "- →"));
    CHECK(replaced(by_input.err, "<standard input>", model) == by_name.err);
    ++tried;
  }
  CHECK(tried >= 9);
}

TEST_CASE("errors in a model from the standard input say where they are") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", "[[body]]\nname = \"a\"\ninertia = 1\n  mass = -1\n");
  for (const char* const name : {"-", "/dev/stdin", "/dev/fd/0"}) {
    const Outcome outcome = does_with(model, {"check", name});
    CHECK(outcome.code == 3);
    CHECK(outcome.out.empty());
    CHECK_MESSAGE(outcome.err.starts_with("<standard input>:4:10: error: 'mass' of body 'a'"), outcome.err);
  }
  const Outcome syntax = does_with(bench.write("b.toml", "x = = 1\n"), {"check", "-"});
  CHECK_MESSAGE(syntax.err.starts_with("<standard input>:1:5: error: not valid TOML"), syntax.err);
  CHECK(does_with("/dev/null", {"check", "-"}).code != 0); // nothing came
}

TEST_CASE("a file on the standard output is that file and nothing else") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer), core = STEPLAP_MODELS "/layouts/three_limb.toml";
  REQUIRE(steplap_does({"simulate", model, "-o", bench.at("out"), "--end", "0.3"}).code == 0);
  const std::string run = bench.at("out/a");
  // What to type before the option, the option, and the name of a file for it.
  const std::vector<std::tuple<std::vector<std::string>, std::string, std::string>> all = {
      {{"new", "block"}, "-o", "block.toml"},
      {{"modes", bench.write("o.toml", k_oscillator)}, "-o", "modes.csv"},
      {{"modes", bench.at("o.toml")}, "--report", "modes.html"},
      {{"channels", model}, "-o", "channels.csv"},
      {{"core", core}, "--svg", "core.svg"},
      {{"report", run}, "-o", "page.html"},
      {{"record", "--make", "endaq"}, "", "shock.csv"}};
  for (const auto& [typed, option, name] : all) {
    CAPTURE(typed.front());
    const auto call = [&, &typed = typed, &option = option](const std::string& file) {
      std::vector<std::string> arguments = typed;
      if (!option.empty()) arguments.push_back(option);
      arguments.push_back(file);
      return steplap_does(arguments);
    };
    REQUIRE(call(bench.at(name)).code == 0);
    const Outcome outcome = call("-");
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    CHECK(outcome.out == text_of(bench.at(name)));
    CHECK(!outcome.out.empty());
  }
  const Outcome trajectory = steplap_does({"simulate", model, "-o", "-", "--end", "0.3"});
  CHECK(trajectory.code == 0);
  CHECK(trajectory.out == text_of(run + "/trajectory.csv"));
  CHECK(has(trajectory.err, "the verdict is"));
}

TEST_CASE("what the standard input and output cannot be is said before anything is done") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_oscillator);
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& why) {
    const Outcome outcome = steplap_does(arguments);
    CHECK_MESSAGE(outcome.code == 2, arguments.front());
    CHECK_MESSAGE(has(outcome.err, why), outcome.err);
    CHECK(outcome.out.empty());
  };
  refused({"check", "-", "-"}, "can be read only once");
  refused({"diff", "-", "-"}, "can be read only once");
  refused({"simulate", model, model, "-o", "-"}, "of one model only");
  refused({"simulate", model, "-o", "-", "--report"}, "no folder that --report");
  refused({"simulate", model, "-o", "-", "--json"}, "one of them only");
  refused({"modes", model, "-o", "-", "--json"}, "one of them only");
  refused({"modes", model, "-o", "-", "--report", "-"}, "one file only");
  refused({"accuracy", model, "-o", "-"}, "-o -: what is written there is a folder of files");
  refused({"record", bench.at("x.csv"), "-o", "-"}, "-o -: what is written there is a folder of files");
  refused({"show", "-"}, "RESULT '-'");
  refused({"report", "-"}, "RESULT '-'");
  refused({"plot", "-", "--channels", "*", "-o", "-"}, "RESULT '-'");
  CHECK_FALSE(fs::exists("-"));
}
