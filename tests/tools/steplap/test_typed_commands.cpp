// What is typed wrong, where nothing can be written, and names that are unlike any. What pages tell to type is typed by tests/docs.
#include "tests/tools/steplap/workbench.h"

#include "tools/steplap/commands.h"

#include <doctest/doctest.h>

#include <sys/wait.h>

#include <algorithm>
#include <utility>

using namespace steplap::testing;

namespace {

int exit_code(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool is_there(const std::string& program) { return exit_code("command -v " + program + " >/dev/null 2>&1") == 0; }

} // namespace

TEST_CASE("what cannot be said is an error, of every command") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer), core = STEPLAP_MODELS "/layouts/three_limb.toml";
  const std::string quick = " --end 0.2 --no-estimate";
  REQUIRE(steplap_does({"simulate", model, "-o", bench.at("ran"), "--end", "0.2", "--no-estimate"}).code == 0);
  REQUIRE(steplap_does({"record", "--make", "endaq", bench.at("shock.csv")}).code == 0);
  const std::vector<std::pair<std::string, std::string>> all = {{"simulate", model + " -o " + bench.at("s") + quick},
                                                                {"explore", model + " --no-browser"},
                                                                {"show", bench.at("ran") + "/a"},
                                                                {"report", bench.at("ran") + "/a -o " + bench.at("r.html")},
                                                                {"plot", bench.at("ran") + "/a --channels ball.y -o " + bench.at("p.svg")},
                                                                {"assess", "--static iec-1g --directions 0 " + core},
                                                                {"cases", STEPLAP_MODELS "/cases/lorry.toml"},
                                                                {"check", model},
                                                                {"channels", model},
                                                                {"equilibrium", model},
                                                                {"modes", model},
                                                                {"joint", core},
                                                                {"core", core},
                                                                {"accuracy", model + " --end 0.2 --setting rk4@1e-2 -o " + bench.at("acc")},
                                                                {"record", bench.at("shock.csv")},
                                                                {"elements", ""},
                                                                {"new", "block"},
                                                                {"diff", model + " " + core},
                                                                {"help", "check"},
                                                                {"schema", ""},
                                                                {"--help", ""},
                                                                {"--version", ""}};
  const auto said = [&](const std::string& arguments) {
    return exit_code(std::string(STEPLAP_PROGRAM) + " " + arguments + " > /dev/full 2> " + bench.at("err"));
  };
  for (const auto& [name, arguments] : all) {
    if (name == "plot" && !is_there("gnuplot")) continue;
    CAPTURE(name);
    CHECK(said(name + " " + arguments) == 2);
    CHECK_MESSAGE(has(text_of(bench.at("err")), "cannot write to the standard output"), text_of(bench.at("err")));
  }
  for (const steplap::Command& command : steplap::all_commands()) // none is forgotten; study and assess are of a program of its own
    CHECK_MESSAGE((command.name == "study" || command.name == "assess" ||
                   std::any_of(all.begin(), all.end(), [&](const auto& entry) { return entry.first == command.name; })),
                  command.name);
  CHECK(exit_code(std::string(STEPLAP_PROGRAM) + " check " + model + " > /dev/null 2>&1") == 0);
}

TEST_CASE("a device or a folder is not replaced by a file") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_oscillator), pipe = bench.at("pipe.csv");
  REQUIRE(exit_code("mkfifo '" + pipe + "'") == 0);
  const Outcome outcome = steplap_does({"modes", model, "-o", pipe, "--force"});
  CHECK(outcome.code == 2);
  CHECK_MESSAGE(has(outcome.err, "it is there, but is no file"), outcome.err);
  CHECK(fs::is_fifo(pipe));
}

TEST_CASE("names that a terminal, a table or a folder would take for something else") {
  const Workbench bench;
  std::string text = k_oscillator;
  const auto put = [&text](const std::string& old, const std::string& now) {
    return text.substr(0, text.find(old)) + now + text.substr(text.find(old) + old.size());
  };
  const auto errors = [&](const std::string& model) {
    const Outcome outcome = steplap_does({"check", bench.write("n.toml", model)});
    CHECK(outcome.code == 3);
    for (const char c : outcome.err) CHECK((static_cast<unsigned char>(c) >= 0x20 || c == '\n'));
    return outcome.err;
  };
  CHECK(has(errors(put("name = \"spring\"", "name = \"a\\nb\"")), "'name', 'a\\nb', holds a control character"));
  CHECK(has(errors(put("name = \"spring\"", "name = \"\\u001b[31mred\"")), "'\\x1b[31mred', holds a control character"));
  CHECK(has(errors(put("title = \"a mass on a spring\"", "title = \"two\\tcolumns\"")), "n.toml:1:9: error: 'title', 'two\\tcolumns'"));
  CHECK(has(errors(put("stiffness = 800", "\"stiff\\u0007ness\" = 800")), "the key 'stiff\\x07ness' holds a control character"));
  const Outcome set = steplap_does({"check", bench.write("n.toml", text), "--set", "element.spring.name=\"a\\tb\""});
  CHECK(set.code == 3);
  CHECK(has(set.err, "holds a control character"));
  CHECK(has(steplap_does({"no\x1b[2Jcommand"}).err, "no\\x1b[2Jcommand"));
  CHECK(steplap_does({"check", bench.write("s.toml", "source = \"\"\"two\nlines\"\"\"\n" + text)}).code == 0); // where values come from

  // Folders: results of '..toml' would lie in out/., of '...toml' in out/..
  for (const char* name : {"..toml", "...toml", ".toml"}) {
    CAPTURE(name);
    CHECK(steplap_does({"simulate", bench.write(name, text), "-o", bench.at("deep/out"), "--no-estimate"}).code == 0);
  }
  CHECK(fs::exists(bench.at("deep/out/..toml/summary.json")));
  CHECK(fs::exists(bench.at("deep/out/...toml/summary.json")));
  CHECK(fs::exists(bench.at("deep/out/.toml/summary.json")));
  CHECK_FALSE(fs::exists(bench.at("deep/out/summary.json")));
  CHECK_FALSE(fs::exists(bench.at("deep/summary.json")));
  const Outcome outcome = steplap_does({"check", bench.write("a\nb.toml", text)});
  CHECK(outcome.code == 2);
  CHECK(has(outcome.err, "a\\nb.toml"));
}

TEST_CASE("what fails says where it stands in the file, in plain numbers") {
  const Workbench bench;
  // Two rods hold one point at places 3 m apart that are 2 m long together.
  const std::string rods = R"([simulation]
end = 1
step = 1e-3
[[body]]
name = "knot"
mass = 1
inertia = 1
[[element]]
name = "left"
kind = "distance"
a = "knot"
b = { body = "ground", point = [-1.5, 0] }
length = 1
[[element]]
name = "right"
kind = "distance"
a = "knot"
b = { body = "ground", point = [1.5, 0] }
length = 1
)";
  const Outcome apart = steplap_does({"simulate", bench.write("rods.toml", rods), "-o", bench.at("out")});
  CHECK(apart.code == 3);
  CHECK_MESSAGE(has(apart.err, "rods.toml:"), apart.err);
  // A body that nothing holds has no rest: the line is the body's.
  const Outcome falls = steplap_does({"equilibrium", bench.write("falls.toml", R"([simulation]
end = 1
step = 1e-3
[[body]]
name = "stone"
mass = 1
inertia = 1
)")});
  CHECK(falls.code == 4);
  CHECK_MESSAGE(has(falls.err, "('stone': "), falls.err);
  CHECK_MESSAGE(has(falls.err, "falls.toml:4)"), falls.err);
}
