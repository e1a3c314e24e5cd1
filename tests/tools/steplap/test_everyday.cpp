// help, a bare command, --json of every command that prints a table, and the version for programs.
#include "tests/tools/steplap/workbench.h"

#include "mbd/run/summary.h"
#include "tools/steplap/commands.h"
#include "tools/steplap/json_screen.h"
#include "transformer/program.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

using Json = nlohmann::json;

Json document_of(const std::vector<std::string>& arguments) {
  const Outcome outcome = steplap_does(arguments);
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  return Json::parse(outcome.out);
}

} // namespace

TEST_CASE("help COMMAND says what COMMAND --help says, of every command") {
  CHECK(steplap_does({"help"}).out == steplap_does({"--help"}).out);
  for (const Command& command : all_commands()) {
    if (command.name == "study") continue; // main() hands it over
    const Outcome help = steplap_does({"help", command.name});
    CHECK(help.code == 0);
    CHECK(help.out == steplap_does({command.name, "--help"}).out);
    CHECK_MESSAGE(has(help.out, command.summary.substr(0, 30)), help.out);
  }
  const Outcome wrong = steplap_does({"help", "simlate"});
  CHECK(wrong.code == 2);
  CHECK(has(wrong.err, "did you mean 'simulate'?"));
}

TEST_CASE("a bare command says what there is, and is still an error to scripts") {
  const Outcome bare = steplap_does({});
  CHECK(bare.code == 2);
  CHECK(bare.out.empty());
  for (const Command& command : all_commands()) CHECK_MESSAGE(has(bare.err, command.name), command.name);
  const Outcome check = steplap_does({"check"});
  CHECK(check.code == 2);
  CHECK(has(check.err, "MODEL is required"));
  CHECK(has(check.err, "--cross"));                                   // its options follow
  CHECK_FALSE(has(steplap_does({"check", "--cross"}).err, "--uses")); // who has typed more is told what is missing
}

TEST_CASE("the version for programs") {
  const Json version = document_of({"--version", "--json"});
  CHECK(version["program"] == "steplap");
  CHECK("steplap " + version["version"].get<std::string>() + "\n" == steplap_does({"--version"}).out);
}

TEST_CASE("every command that prints a table has --json, with the same numbers to the last digit") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_oscillator), bouncer = bench.write("b.toml", k_bouncer),
                    core = STEPLAP_MODELS "/layouts/three_limb.toml";
  REQUIRE(steplap_does({"simulate", bouncer, "-o", bench.at("ran"), "--end", "0.3"}).code == 0);
  // What to type, and a table that has to be there.
  const std::map<std::string, std::pair<std::vector<std::string>, std::string>> typed = {
      {"check", {{core}, "contacts"}},
      {"equilibrium", {{bouncer}, "poses"}},
      {"modes", {{model}, "modes"}},
      {"joint", {{core, "--wrench", "53 kN,-88 kN,0"}, "capacity"}},
      {"core", {{core}, "packets"}},
      {"accuracy", {{model, "--end", "0.05", "--setting", "rk4@1e-2", "-o", bench.at("acc")}, "settings"}},
      {"channels", {{model}, "channels"}},
      {"elements", {{"unilateral_contact"}, "fields"}},
      {"diff", {{model, bouncer}, "values"}},
      {"simulate", {{model, "-o", bench.at("out"), "--end", "0.05"}, ""}},
      {"show", {{bench.at("ran") + "/b"}, ""}},
      {"cases", {{STEPLAP_MODELS "/cases/lorry.toml"}, ""}},
      {"help", {{}, ""}}};
  // Of others: no table, or a document of their own.
  const std::map<std::string, std::string> others = {{"new", "a model"},        {"explore", "a page"},
                                                     {"report", "a page"},      {"plot", "an image"},
                                                     {"schema", "is JSON"},     {"study", "a program of its own"},
                                                     {"record", "record.json"}, {"assess", "assessment.json"}};
  for (const Command& command : all_commands()) {
    CAPTURE(command.name);
    CHECK(command.prints_tables == typed.contains(command.name));
    CHECK(command.prints_tables != others.contains(command.name));
    if (!command.prints_tables) continue;
    std::vector<std::string> arguments{command.name};
    const auto& [more, table] = typed.at(command.name);
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.push_back("--json");
    const Json document = document_of(arguments);
    CHECK(document["program"] == "steplap");
    if (command.name == "help") continue;
    CHECK(document["command"] == command.name);
    CHECK(document["exit_code"] == 0);
    bool is_there = table.empty();
    for (const Json& result : document["results"]) is_there |= result.contains("tables") && result["tables"].contains(table);
    CHECK_MESSAGE(is_there, document.dump(2));
  }
}

TEST_CASE("numbers of --json are whole, with their unit") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_oscillator);
  const Json modes = document_of({"modes", model, "--json"})["results"][0];
  CHECK(modes["about"] == model);
  const double frequency = std::sqrt(800.0 / 2.0) / (2.0 * std::numbers::pi);
  bool is_found = false;
  for (const Json& mode : modes["tables"]["modes"])
    is_found |= mode["frequency"]["unit"] == "Hz" &&
                std::abs(mode["frequency"]["value"].get<double>() / frequency - 1.0) < 1e-10; // rounding of an eigenvalue
  CHECK(is_found);
  // Two models, two results; what people read is there, too.
  const Json check = document_of({"check", model, bench.write("b.toml", k_bouncer), "--json", "-q"})["results"];
  REQUIRE(check.size() == 2);
  CHECK(check[1]["about"] == bench.at("b.toml"));
  CHECK(check[1]["text"][0] == bench.at("b.toml") + ": fine");
  CHECK(check[1]["tables"]["model"]["coordinates"] == 3);
  // A run: its summary and all events.
  const Json run = document_of({"simulate", bench.at("b.toml"), "-o", bench.at("out"), "--json"})["results"][0];
  CHECK(run["summary"]["program"]["name"] == "steplap");
  CHECK(run["summary"]["events"]["count"] == run["events"].size());
  CHECK(run["folder"] == bench.at("out/b"));
  const Json shown = document_of({"show", bench.at("out/b"), "--json"})["results"][0];
  CHECK(shown["events"] == run["events"]);
  CHECK(shown["summary"]["extremes"] == run["summary"]["extremes"]);
}

TEST_CASE("an error of a model leaves the standard output empty, with --json as well") {
  const Workbench bench;
  const Outcome outcome = steplap_does({"check", bench.write("a.toml", std::string(k_oscillator) + "stifness = 3\n"), "--json"});
  CHECK(outcome.code == 3);
  CHECK(outcome.out.empty());
  CHECK(has(outcome.err, "did you mean 'stiffness'?"));
}

TEST_CASE("cells without a number are text or null, tables without a head are one object") {
  JsonScreen screen;
  std::ostream& out = screen;
  TextTable pairs({TextTable::Align::left, TextTable::Align::right});
  pairs.set_name("pairs");
  pairs.add_row({"length", Cell("3 mm", 0.003, "m", 1e-6)});
  pairs.add_row({"nothing", Cell("–", std::nan(""), "m")});
  TextTable rows({TextTable::Align::left, TextTable::Align::right});
  rows.set_head("rows", {"", "steps"}, {"name", "steps"});
  rows.add_row({"rk4", count_cell(7)});
  out << "first\n" << pairs << "\n  second\n" << About{"other"} << rows;
  const Json results = Json::parse(screen.document("p", "c", 4))["results"];
  CHECK(results[0]["text"] == Json{"first", "second"});
  CHECK(results[0]["tables"]["pairs"]["length"] == Json{{"value", 0.003}, {"unit", "m"}, {"error", 1e-6}});
  CHECK(results[0]["tables"]["pairs"]["nothing"]["value"].is_null());
  CHECK(results[1]["tables"]["rows"] == Json::array({Json{{"name", "rk4"}, {"steps", 7}}}));
  CHECK_THROWS_AS(out << rows, std::logic_error); // a name that is taken
}

// A block of 1 t on a slope: 5 kN pull it down. Friction of 0.3 bears 2.9 kN, and a spring the rest after it has slid; with 0.6 friction bears
// all of it.
TEST_CASE("a rest that depends on the way says so at its numbers") {
  const Workbench bench;
  const auto rest_with = [&bench](const std::string& friction) {
    std::string model = "gravity = [5.0, -9.81]\n[[body]]\nname = 'block'\nmass = 1000\ninertia = 400\nposition = [0, 0.5]\n";
    for (const std::string& place : {std::string("-0.8"), std::string("0.8")})
      model += "[[element]]\nkind = 'unilateral_contact'\nname = 'foot " + place + "'\na = { body = 'block', at = [" + place +
               ", 0] }\nb = { body = 'ground', at = [0, 0] }\nnormal = [0, 1]\nstiffness = 1e9\ndamping = 1e6\n";
    model += "[[element]]\nkind = 'coulomb_stick'\nname = 'slope'\ncontacts = ['foot -0.8', 'foot 0.8']\nstatic_friction = " + friction +
             "\n[[element]]\nkind = 'spring_damper'\nname = 'spring'\na = { body = 'block', at = [0, 0] }\nb = { body = 'ground', at = [0, "
             "0] }\n"
             "axis = [1, 0]\nstiffness = 1e6\ndamping = 1e3\n";
    return steplap_does({"equilibrium", bench.write("slope.toml", model)});
  };
  const Outcome slid = rest_with("0.3"), held = rest_with("0.6");
  CHECK(slid.code == 0);
  CHECK(held.code == 0);
  CHECK_MESSAGE(has(slid.out, "Reactions at this rest, which is one of many: they depend on the path"), slid.out);
  CHECK(has(slid.out, "Distance from slipping at this rest, which is one of many"));
  CHECK_MESSAGE(has(held.out, "Reactions\n"), held.out);
  CHECK_FALSE(has(held.out, "one of many"));
}

// The file is written piece by piece, without a tree of all extremes.
TEST_CASE("summary.json has the entries of the document, then the files and the checksum, laid out as the library for JSON lays them out") {
  const Report report =
      judged_run(load_model_text("simulation.end = 0.1\n[[body]]\nname = 'round \"ball\"'\nmass = 1.0\ninertia = 0.1\n", "ball.toml", {}));
  const std::string text = report.json();
  OrderedJson file = OrderedJson::parse(text);
  CHECK(file.dump(2) + "\n" == text);
  CHECK(file.erase("files") == 1);
  CHECK(file.erase("checksum") == 1);
  CHECK(file.at("extremes").size() == report.ranges().size());
  CHECK(file.dump() == summary_document(report).dump());
}
