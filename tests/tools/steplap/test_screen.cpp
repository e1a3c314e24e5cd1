// What a run shows on the terminal: one screen, whatever the model.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <regex>

using namespace steplap::testing;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::size_t characters(const std::string& line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

// Bars have as many signs as the shares in the summary say, and the percents are those.
void check_bars(const std::vector<std::string>& lines, const nlohmann::json& utilisations) {
  std::size_t bars = 0;
  for (const std::string& line : lines) {
    static const std::regex bar("\\[(#*)(-*)\\] +([0-9.]+)");
    std::smatch found;
    if (!std::regex_search(line, found, bar)) continue;
    REQUIRE(bars < utilisations.size());
    const double share = utilisations[bars++].at("share");
    CAPTURE(line);
    CHECK(found[1].length() == std::lround(std::min(share, 1.0) * 20.0));
    CHECK(std::stod(found[3]) == doctest::Approx(100.0 * share).epsilon(0.006).scale(100.0)); // whole percents
  }
  const auto used = std::count_if(utilisations.begin(), utilisations.end(), [](const nlohmann::json& u) { return u.at("share") >= 0.005; });
  CHECK(bars == std::min<std::size_t>(5, static_cast<std::size_t>(used))); // less than half a percent is no news
}

// Every time that the story begins or ends with is one of events.csv; what tips is told by an extreme.
void check_story(const nlohmann::json& story, const std::string& events) {
  std::vector<double> times;
  for (const std::string& line : lines_of(events)) times.push_back(std::strtod(line.c_str(), nullptr));
  const auto is_event = [&times](double t) { return std::find(times.begin(), times.end(), t) != times.end(); };
  for (const nlohmann::json& entry : story) {
    if (entry.at("what") == "tips" || entry.at("what") == "would slip") continue;
    CHECK(is_event(entry.at("from")));
    if (!entry.at("to").is_null()) CHECK(is_event(entry.at("to")));
  }
}

} // namespace

TEST_CASE("the screen of every model is at most 30 lines of 100 columns and begins with the verdict") {
  const Workbench bench;
  std::size_t count = 0;
  for (const char* const folder : {"paper", "layouts", "machines"})
    for (const auto& file : fs::directory_iterator(fs::path(STEPLAP_MODELS) / folder)) {
      if (file.path().extension() != ".toml") continue;
      ++count;
      const std::string name = file.path().stem().string();
      CAPTURE(name);
      const Outcome outcome = steplap_does({"simulate", file.path().string(), "-o", bench.at("out")});
      CHECK(outcome.code == 0);
      const std::vector<std::string> lines = lines_of(outcome.out);
      CHECK(lines.size() <= 30);
      for (const std::string& line : lines) CHECK_MESSAGE(characters(line) <= 100, line);
      const nlohmann::json overview = nlohmann::json::parse(text_of(bench.at("out/" + name + "/summary.json"))).at("overview");
      const std::string verdict = overview.at("is_judged") ? upper(overview.at("verdict")) : "NO CRITERIA";
      CHECK(lines.front().starts_with(verdict + "  "));
      CHECK_FALSE(std::regex_search(outcome.out, std::regex("[0-9]e[-+]?[0-9]")));
      CHECK_FALSE(has(outcome.out, "\x1b"));
      check_bars(lines, overview.at("utilisations"));
      check_story(overview.at("story"), text_of(bench.at("out/" + name + "/events.csv")));
    }
  CHECK(count >= 30);
}

TEST_CASE("-v shows the tables of all extremes") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  const Outcome brief = steplap_does({"simulate", model, "-o", bench.at("brief")}),
                tables = steplap_does({"simulate", model, "-v", "-o", bench.at("tables")});
  CHECK_FALSE(has(brief.out, "Accuracy and cost"));
  CHECK(has(tables.out, "Accuracy and cost"));
  CHECK(has(brief.out, "Floor touches "));
}

TEST_CASE("--digits sets how many digits the screen shows, up to all with their errors") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  const auto shown = [&](const char* digits) {
    const Outcome outcome = steplap_does({"simulate", model, "-o", bench.at(digits), "--digits", digits});
    CHECK(outcome.code == 0);
    return outcome.out;
  };
  // The first event's time, as the story tells it: its digits and what stands behind the last.
  const auto first_time = [](const std::string& screen) {
    std::smatch found;
    REQUIRE(std::regex_search(screen, found, std::regex("(from|at|between) ([0-9.]+)([^,]*)")));
    return found[2].str();
  };
  const std::string two = shown("2"), seven = shown("7"), full = shown("full");
  CHECK(first_time(two).size() < first_time(seven).size());
  CHECK(std::abs(std::stod(first_time(two)) - std::stod(first_time(seven))) <= 0.05 * std::stod(first_time(seven)));
  CHECK(has(full, " ± "));
  CHECK(first_time(full).size() > first_time(seven).size());
  // Files do not hang on it.
  CHECK(text_of(bench.at("2/a/summary.json")) == text_of(bench.at("full/a/summary.json")));
  for (const char* wrong : {"0", "16", "-3", "4.5", "all", ""}) {
    CAPTURE(wrong);
    const Outcome refused = steplap_does({"simulate", model, "-o", bench.at("no"), std::string("--digits=") + wrong});
    CHECK(refused.code == 2);
  }
}
