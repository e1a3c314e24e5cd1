// An integration method, a kind of element, a kind of study and a sub-command each are a file pair and a line in one list: where else is one
// of them named? All sources are read. What names one by right stands here with its reason; a name anywhere else is a place
// that whoever adds another would have to find.
#include "elements/catalog.h"
#include "mbd/model/method.h"
#include "tools/steplap/commands.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using namespace steplap;

namespace {

// Text of all sources of the product but benchmarks, comments left out.
std::map<std::string, std::string> product_sources() {
  const fs::path root = STEPLAP_SOURCE;
  std::map<std::string, std::string> sources;
  for (const char* top : {"mbd", "elements", "transformer", "tools/pages", "tools/explore", "tools/study", "tools/assess", "tools/steplap"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
      if (entry.path().parent_path().filename() == "recorder") continue; // reads files of other makers, with words of theirs
      std::string& text = sources[fs::relative(entry.path(), root).generic_string()];
      std::ifstream lines(entry.path());
      for (std::string line; std::getline(lines, line);) text += line.substr(0, line.find("//")) + "\n";
    }
  return sources;
}

// Where the name stands in quotes.
std::set<std::string> places_of(const std::string& name, const std::map<std::string, std::string>& sources) {
  std::set<std::string> places;
  for (const auto& [path, text] : sources)
    if (text.find('"' + name + '"') != std::string::npos) places.insert(path);
  return places;
}

using Reasons = std::map<std::string, std::string>; ///< file → why it names one

void check_places(const std::string& name, const std::set<std::string>& own, const Reasons& reasons,
                  const std::map<std::string, std::string>& sources) {
  for (const std::string& place : places_of(name, sources))
    CHECK_MESSAGE((own.count(place) > 0 || reasons.count(place) > 0), place << " names '" << name << "'");
}

} // namespace

TEST_CASE("an integration method is a file and a line in methods.cpp") {
  const auto sources = product_sources();
  const Reasons by_right = {
      {"mbd/model/model.h", "what a file that names none has"},
      {"mbd/simulation/run_record.h", "what a program that names none has"},
      {"mbd/trust/accuracy_study.h", "the two that make references"},
      {"mbd/trust/reference_runs.cpp", "the method of references for fixed steps"},
      {"mbd/trust/cross_check.cpp", "the plan of a cross check, method by method"},
      {"mbd/trust/trust.cpp", "what to try instead"},
      {"mbd/run/second_opinion.cpp", "the two that share least: which one is asked hangs on which one ran"},
  };
  REQUIRE(methods().size() >= 6);
  for (const Method& m : methods()) {
    const std::string name = m.name;
    // "auto" is a word of others, too: of drawings.
    Reasons reasons = by_right;
    if (name == "auto")
      reasons.insert({{"mbd/model/model.cpp", "how an element is drawn"}, {"mbd/run/sketch.cpp", "how an element is drawn"}});
    check_places(name, {"mbd/integrators/methods.cpp", "mbd/integrators/" + (name == "auto" ? "automatic" : name) + ".cpp"}, reasons,
                 sources);
  }
}

TEST_CASE("a kind of element is a file pair and a line in the catalogue") {
  const auto sources = product_sources();
  const Reasons by_right = {{"elements/views/symbols.cpp", "symbols: a kind without one is drawn by diamonds at its markers"},
                            {"elements/step_lap/joint_view.cpp", "what bears beside a joint, for a remark"}};
  // Names that are words of others, too, or that somebody asks for all the same.
  const std::map<std::string, Reasons> besides = {
      {"weld", {{"mbd/model/model.cpp", "a way to draw"}, {"tools/study/needs.cpp", "what is made rigid is welded"}}},
      {"limit",
       {{"mbd/run/report_json.cpp", "of a criterion"},
        {"mbd/run/load_cases_json.cpp", "of a criterion"},
        {"tools/steplap/cases_screen.cpp", "of a criterion"},
        {"tools/steplap/run_screen.cpp", "of a criterion"},
        {"tools/assess/static_json.cpp", "of a criterion"}}},
      {"load", {{"tools/assess/static_json.cpp", "an acceleration of a proof"}}},
      {"buffer", {{"mbd/model/shunting_signal.cpp", "a field"}}},
      {"rope", {{"mbd/run/story.cpp", "what a rope does is told in words of its own: it goes slack"}}},
      {"distance",
       {{"elements/motor.cpp", "a coordinate"},
        {"elements/prescribed_motion.cpp", "a coordinate"},
        {"elements/limit.cpp", "a coordinate"},
        {"elements/joint_friction.cpp", "a coordinate"},
        {"elements/formula_force.cpp", "a coordinate"}}},
      {"step_lap_joint", {{"tools/study/sample_simulator.cpp", "channels that every verdict needs"}}},
      {"spring_damper", {{"mbd/model/model.h", "an example"}}},
  };
  int kinds = 0;
  for (const ElementKind* kind : element_catalog().elements) {
    CAPTURE(kind->name);
    if (kind->name == "force") continue; // what a channel of most elements is called: the word tells nothing
    Reasons reasons = by_right;
    if (const auto more = besides.find(kind->name); more != besides.end()) reasons.insert(more->second.begin(), more->second.end());
    std::set<std::string> own; // its own file: what is neither
    for (const std::string& place : places_of(kind->name, sources))
      if (place.starts_with("elements/") && reasons.count(place) == 0) own.insert(place);
    CHECK(own.size() == 1);
    check_places(kind->name, own, reasons, sources);
    ++kinds;
  }
  CHECK(kinds > 20);
}

TEST_CASE("a kind of study is a source and a line in kinds.h and in kinds.cpp") {
  const auto sources = product_sources();
  // What else is called so, and who reads a kind's settings besides the kind itself.
  const std::map<std::string, Reasons> besides = {
      {"sample",
       {{"tools/study/store.cpp", "a table of the store"},
        {"tools/study/program/show.cpp", "the head of a column"},
        {"tools/study/influence.cpp", "a word of a sentence"},
        {"tools/study/kriging.cpp", "a word of a sentence"}}},
      {"sweep", {{"tools/study/program/show.cpp", "its samples are its answer"}}},
      {"reliability",
       {{"tools/study/limit_function.h", "hands its settings to the methods of reliability"},
        {"tools/study/limit_function.cpp", "the same"},
        {"tools/study/evidence.cpp", "evidence goes with one of its methods, and with its limit states"},
        {"tools/study/design.h", "a design seeks a reliability: its settings are these and more"}}},
      {"design",
       {{"tools/study/sweep.cpp", "how samples are arranged"},
        {"tools/study/sample.cpp", "how samples are arranged"},
        {"tools/study/design_choice.cpp", "the part of a design that chooses by cost"}}},
  };
  const std::string& list = sources.at("tools/study/kinds.cpp");
  const std::regex entry("(\\w+)_kind\\(\\)"); // read from the source: builds without studies have this test, too
  int kinds = 0;
  for (std::sregex_iterator found(list.begin(), list.end(), entry), end; found != end; ++found, ++kinds) {
    const std::string name = (*found)[1].str(), file = "tools/study/" + name;
    CAPTURE(name);
    const std::set<std::string> own = {file + ".cpp", file + ".h"};
    const auto more = besides.find(name);
    const Reasons reasons = more == besides.end() ? Reasons{} : more->second;
    REQUIRE(sources.count(file + ".cpp") == 1);
    CHECK(sources.at(file + ".cpp").find("kind.name = \"" + name + '"') != std::string::npos);
    check_places(name, own, reasons, sources);
    const std::regex settings("\\b" + std::string(1, static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])))) +
                              name.substr(1) + "Settings\\b");
    const bool is_read_by_others = sources.count(file + ".h") > 0; // its settings stand in a header only then
    CHECK(std::regex_search(sources.at(file + (is_read_by_others ? ".h" : ".cpp")), settings));
    std::set<std::string> listed;
    for (const auto& [path, text] : sources) {
      if (text.find(name + "_kind()") != std::string::npos) listed.insert(path);
      if (text.find("Settings") != std::string::npos && std::regex_search(text, settings))
        CHECK_MESSAGE((own.count(path) > 0 || reasons.count(path) > 0), path << " names the settings of '" << name << "'");
    }
    CHECK(listed == std::set<std::string>{file + ".cpp", "tools/study/kinds.h", "tools/study/kinds.cpp"});
  }
  CHECK(kinds >= 8);
}

TEST_CASE("a sub-command is a source and a line in commands.h and in commands.cpp") {
  const auto sources = product_sources();
  for (const Command& command : all_commands()) {
    const std::string function = command.name + "_command()";
    std::set<std::string> places;
    for (const auto& [path, text] : sources) // a study has commands of its own
      if (path.starts_with("tools/steplap/") && text.find(function) != std::string::npos) places.insert(path);
    const std::string file = "tools/steplap/" + command.name;
    CHECK_MESSAGE((places == std::set<std::string>{file + ".cpp", "tools/steplap/commands.cpp", "tools/steplap/commands.h"}), command.name);
  }
}

TEST_CASE("two switches over measures") {
  // Values, tapes, derivatives and rest use that of row.h (mbd/system/row_gradient.h). That of turn_table.cpp says on which angles a
  // measure depends.
  std::vector<std::string> switches;
  for (const auto& [path, text] : product_sources())
    if (text.find("case MeasureKind::") != std::string::npos) switches.push_back(path);
  CHECK(switches == std::vector<std::string>{"mbd/system/row.h", "mbd/system/turn_table.cpp"});
}

namespace {

/// A line of the table "Each equation once" of docs/explanation/theory.md: what its second cell names.
struct EquationLine {
  std::string equation;
  std::vector<std::string> files, functions;
};

std::vector<EquationLine> equation_table() {
  std::vector<EquationLine> table;
  std::ifstream lines(std::string(STEPLAP_SOURCE) + "/docs/explanation/theory.md");
  bool is_inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("##")) is_inside = line == "### Each equation once";
    if (!is_inside || !line.starts_with("| ") || line.starts_with("| equation")) continue;
    const std::size_t begin = line.find(" | ") + 3, end = line.find(" | ", begin);
    EquationLine& made = table.emplace_back();
    made.equation = line.substr(2, begin - 5);
    const std::string cell = line.substr(begin, end - begin);
    const std::regex name("`([^`]+)`");
    for (std::sregex_iterator at(cell.begin(), cell.end(), name), none; at != none; ++at) {
      const std::string text = (*at)[1];
      (text.find('/') != std::string::npos ? made.files : made.functions).push_back(text);
    }
  }
  return table;
}

} // namespace

TEST_CASE("the table of equations names functions where they are") {
  const std::map<std::string, std::string> sources = product_sources();
  const std::vector<EquationLine> table = equation_table();
  CHECK(table.size() >= 7);
  for (const EquationLine& line : table) {
    CAPTURE(line.equation);
    CHECK(!line.files.empty());
    CHECK(!line.functions.empty());
    std::string text;
    for (const std::string& file : line.files) {
      CHECK_MESSAGE(sources.count(file) == 1, file << " is no source");
      if (sources.count(file) == 1) text += sources.at(file);
    }
    for (const std::string& function : line.functions) {
      const std::size_t scope = function.rfind("::");
      const std::string name = scope == std::string::npos ? function : function.substr(scope + 2);
      CHECK_MESSAGE(std::regex_search(text, std::regex("\\b" + name + "\\b")), function << " is in none of these files");
    }
  }
}

TEST_CASE("where kinds of rows are told apart") {
  // A kind of row is a MeasureKind, what it measures with its derivatives, and an element that makes rows of it.
  const Reasons by_right = {
      {"mbd/system/row.h", "what each measures"},
      {"mbd/system/measured_channel.h", "makes rows of measures"},
      {"mbd/dynamics/layout.cpp", "which have a shorter way, angles a constant gradient"},
      {"mbd/dynamics/mechanism_layout.cpp", "which joints a member of a mechanism may hang by"},
      {"mbd/dynamics/projection.cpp", "the unit of a message"},
      {"mbd/simulation/changeover.cpp", "the unit of a message"},
      {"mbd/dynamics/load_sharing.cpp", "the unit of a residual"},
      {"mbd/system/slight_force.h", "the unit of a force"},
      {"mbd/system/turn_table.cpp", "on which angles a measure depends"},
      {"mbd/trust/frozen_growth.cpp", "rows of rates, which leave places free"},
      {"mbd/system/motion_formula.cpp", "an angle is linear in itself"},
      {"mbd/system/requested_channels.cpp", "friction that slides along a face has a way"},
  };
  for (const auto& [path, text] : product_sources())
    if (path.starts_with("mbd/") && text.find("MeasureKind::") != std::string::npos)
      CHECK_MESSAGE(by_right.count(path) > 0, path << " tells kinds of rows apart");
}
