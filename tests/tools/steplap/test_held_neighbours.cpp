// Time stepping, alone, through a storm and as second opinion, of friction whose neighbour slides: what the neighbour no longer
// bears decides whether it holds.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <map>

using namespace steplap::testing;

namespace {

const std::string k_defects = STEPLAP_TEST_DATA "/defects/";

struct Judged {
  int code = 0;
  nlohmann::json summary;
  std::string events;
  std::map<std::string, double> last; ///< values of the last sample, by channel
};

Judged judged(const Workbench& bench, const std::string& model, const std::vector<std::string>& more) {
  std::vector<std::string> command = {"simulate", model, "-o", bench.at("out"), "--force"};
  command.insert(command.end(), more.begin(), more.end());
  Judged j;
  j.code = steplap_does(command).code;
  const fs::path folder = fs::path(bench.at("out")) / fs::path(model).stem();
  j.summary = nlohmann::json::parse(text_of(folder / "summary.json"));
  j.events = text_of(folder / "events.csv");
  std::istringstream table(text_of(folder / "trajectory.csv"));
  std::string names, line, last, name, value;
  while (std::getline(table, line))
    if (names.empty() && line.rfind("#", 0) != 0) names = line;
    else if (!line.empty()) last = line;
  std::istringstream heads(names), values(last);
  while (std::getline(heads, name, ',') && std::getline(values, value, ','))
    j.last[name.substr(0, name.find(" ["))] = std::atof(value.c_str()); // without the unit
  return j;
}

bool slides(const Judged& j, const std::string& element) { return has(j.events, "," + element + ",slips"); }

} // namespace

// The deck has 6 m/s³: the lower mass bears 2 a and slides from 12 N on, at 1 s and 3 m/s, with 6 N. Both masses then have 3 m/s², from
// 1.5 s on 2 m/s², and the upper bears 4 N of its 6.5 N.
constexpr double k_speed = 3.0 + 3.0 * 0.5 + 2.0 * 0.5;

TEST_CASE("a mass that holds on a sliding mass holds by time stepping, at every step size") {
  const Workbench bench;
  for (const double step : {1e-3, 1e-4, 1e-5}) {
    CAPTURE(step);
    const Judged j = judged(bench, k_defects + "upper_mass_holds.toml", {"--no-estimate", "--step", std::to_string(step)});
    CHECK(j.summary.at("judgement").at("verdict") == "hold");
    CHECK(slides(j, "f0"));
    CHECK_FALSE(slides(j, "f1"));
    // The onset comes up to a step and a half late, and the friction that falls by 6 N gives 3 m/s² so long.
    CHECK(std::abs(j.last.at("m0.vx") - k_speed) <= 4.5 * step);
    CHECK(std::abs(j.last.at("m1.vx") - k_speed) <= 4.5 * step);
    CHECK(j.last.at("f1.friction") == doctest::Approx(4.0).epsilon(1e-6)); // settled to 1e-6 of each
  }
}

TEST_CASE("a mass that holds on a sliding mass holds by the method of choice, and time stepping agrees") {
  const Workbench bench;
  const Judged j = judged(bench, k_defects + "upper_mass_holds.toml", {"--integrator", "auto", "--require-hold"});
  CHECK(j.code == 0);
  CHECK(j.summary.at("judgement").at("verdict") == "hold");
  CHECK(j.summary.at("second_opinion").at("agrees") == true);
  CHECK(std::abs(j.last.at("m1.vx") - k_speed) <= 1e-6); // the default tolerance
}

TEST_CASE("a mass that holds on a sliding mass holds through a storm of events") {
  const Workbench bench;
  const Judged j = judged(bench, k_defects + "upper_mass_holds_in_a_storm.toml", {});
  CHECK(j.summary.at("judgement").at("verdict") == "hold");
  CHECK_FALSE(slides(j, "f1"));
  // The friction of nothing changes in the storm: what is left are the tolerance and rounding.
  CHECK(std::abs(j.last.at("m0.vx") - k_speed) <= 1e-6);
  CHECK(std::abs(j.last.at("m1.vx") - k_speed) <= 1e-6);
}

TEST_CASE("a pushed crate holds on a sliding crate by time stepping") {
  const Workbench bench;
  // Both slide from 0.5 g on with 0.3 g; from 1 s on 160 N push 200 kg.
  constexpr double k_g = 9.81, k_slope = 14.0;
  const double onset = 0.5 * k_g / k_slope;
  const double speed = -0.5 * k_slope * onset * onset - 0.3 * k_g * (2.0 - onset) + 160.0 / 200.0;
  for (const double step : {1e-3, 1e-4}) {
    CAPTURE(step);
    const Judged j = judged(bench, k_defects + "upper_crate_holds.toml", {"--integrator", "moreau", "--step", std::to_string(step)});
    CHECK(slides(j, "friction 0"));
    CHECK_FALSE(slides(j, "friction 1"));
    // The onset is a step and a half off, with 0.2 g; the wind tilts the crates, whose feet and normal forces follow.
    for (const char* crate : {"crate 0.vx", "crate 1.vx"}) CHECK(std::abs(j.last.at(crate) - speed) <= 1.5 * step * 0.2 * k_g + 1e-4);
  }
}

TEST_CASE("joints of the paper's transformer hold by time stepping while its feet slide with less friction than they held") {
  const Workbench bench;
  const std::string model = bench.write("transformer.toml", "extends = \"" STEPLAP_MODELS "/paper/no_interference.toml\"\n"
                                                            "[[core]]\nname = \"core\"\npressure = \"34 kPa\"\nkinetic_friction = 0.1\n"
                                                            "[[element]]\nname = \"tank bottom\"\nkinetic_friction = 0.25\n");
  const Judged exact = judged(bench, model, {"--integrator", "rodas5p"});
  const Judged stepped = judged(bench, model, {"--integrator", "moreau", "--step", "1e-4"});
  for (const char* joint : {"front joint", "back joint"}) {
    CAPTURE(std::string(joint));
    CHECK_FALSE(slides(exact, joint));
    CHECK_FALSE(slides(stepped, joint));
    const auto margin = [&](const Judged& j) { return j.summary.at("joints").at(joint).at("smallest_margin").get<double>(); };
    CHECK(margin(exact) > 1.05);
    CHECK(margin(stepped) == doctest::Approx(margin(exact)).epsilon(0.01)); // first order: a step in the 10 ms that forces take to grow
  }
}
