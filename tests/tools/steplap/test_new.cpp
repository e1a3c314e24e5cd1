// Models that `steplap new` writes: each is checked without a warning, runs, and comes to what its closed form says.
#include "tests/tools/steplap/workbench.h"

#include "mbd/base/number_text.h"
#include "mbd/formula/unit_dimension.h"
#include "mbd/io/reader.h"
#include "tools/steplap/new.h"
#include "transformer/program.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

using namespace steplap;
using namespace steplap::testing;

namespace {

using Json = nlohmann::json;
using Dimensions = std::map<std::string, double>; ///< of a template's parameters that have a range, SI

const ModelTemplate& called(const std::string& name) {
  const auto& all = model_templates();
  return *std::find_if(all.begin(), all.end(), [&name](const ModelTemplate& one) { return one.name == name; });
}

// A template's parameters as a model has them.
Parameters parameters_of(const ModelTemplate& one) {
  return parse_given_model(std::string(one.text), one.name + ".toml", program_catalogue()).parameters;
}

// Anywhere between the ends of its range; by orders of magnitude where these are far apart.
Dimensions drawn(const ModelTemplate& one, std::mt19937& random) {
  Dimensions dimensions;
  for (const Parameter& p : parameters_of(one).entries) {
    if (!p.least || !p.most) continue;
    const double share = std::uniform_real_distribution<>(0.001, 0.999)(random); // the ends themselves may be rounded beyond the range
    dimensions[p.name] = *p.least > 0.0 && *p.most > 20.0 * *p.least ? *p.least * std::pow(*p.most / *p.least, share)
                                                                     : *p.least + share * (*p.most - *p.least);
  }
  return dimensions;
}

std::vector<std::string> arguments_for(const ModelTemplate& one, const Dimensions& dimensions, const std::string& file) {
  std::vector<std::string> arguments{"new", one.name, "-o", file, "--force"};
  const Parameters parameters = parameters_of(one);
  for (const TemplateParameter& p : one.parameters()) {
    const auto given = dimensions.find(p.name);
    if (given == dimensions.end()) continue;
    const std::string unit = unit_text(parameters.entries[*parameters.find(p.name)].powers);
    arguments.push_back(p.option());
    arguments.push_back(number_text(given->second) + (unit.empty() || unit == "1" ? "" : " " + unit));
  }
  return arguments;
}

Json json_of(const Outcome& outcome, bool may_warn = false) {
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  CHECK_MESSAGE((may_warn || outcome.err.empty()), outcome.err);
  return Json::parse(outcome.out)["results"][0];
}

// The model written for these dimensions, which says nothing and is checked without a warning, and its run.
Json run_of(const Workbench& bench, const ModelTemplate& one, const Dimensions& dimensions, bool may_warn = false) {
  const std::string file = bench.at(one.name + ".toml");
  const Outcome written = steplap_does(arguments_for(one, dimensions, file));
  REQUIRE_MESSAGE(written.code == 0, written.err);
  CHECK_MESSAGE(written.err.empty(), written.err);
  const Outcome check = steplap_does({"check", file});
  CHECK_MESSAGE(check.code == 0, check.err);
  CHECK_MESSAGE(!has(check.out, "warning:"), check.out);
  return json_of(steplap_does({"simulate", file, "-o", bench.at("out"), "--force", "--no-estimate", "--json"}), may_warn)["summary"];
}

std::string verdict_of(const Json& summary) { return summary["overview"]["verdict"]; }

// How far a block slides on a bed that brakes by a trapezoid, by friction alone: it gains a - mu g on the bed while that is more than nothing,
// and loses mu g until it stands on it again.
double slide_of(const Dimensions& d) {
  const double mu_g = d.at("friction") * 9.81, a = d.at("deceleration"), rise = d.at("rise"), braking = d.at("braking");
  constexpr double dt = 1e-5; // s: the steps' error is below a thousandth of what the bound allows
  double rate = 0.0, slide = 0.0;
  for (double t = 0.0; t < braking + 1.5; t += dt) {
    const double share = std::max(0.0, std::min({1.0, t / rise, (braking - t) / rise}));
    rate = std::max(0.0, rate + dt * (a * share - mu_g));
    slide += dt * rate;
  }
  return slide;
}

} // namespace

TEST_CASE("a model as it stands holds, and every dimension of it has a meaning and a source") {
  const Workbench bench;
  for (const ModelTemplate& one : model_templates()) {
    CAPTURE(one.name);
    CHECK(verdict_of(run_of(bench, one, {})) == "hold");
    const std::vector<TemplateParameter> parameters = one.parameters();
    CHECK(parameters.size() >= 9);
    for (const TemplateParameter& p : parameters) {
      CAPTURE(p.name);
      CHECK_FALSE(p.meaning.empty());
      CHECK_FALSE(p.source.empty());
    }
    std::size_t ranged = 0;
    for (const Parameter& p : parameters_of(one).entries) ranged += p.least ? 1 : 0;
    CHECK(ranged == parameters.size());                     // the lines read by `new` are those that the reader reads
    CHECK(steplap_does({"new", one.name}).out == one.text); // to the standard output
  }
}

TEST_CASE("a block of any size slides as far as Coulomb's law says") {
  const Workbench bench;
  std::mt19937 random(1);
  int slid = 0;
  for (int k = 0; k < 16; ++k) {
    Dimensions d = drawn(called("block"), random);
    d["height"] = std::min(d["height"], 0.9 * d["length"]); // it does not tip: a < g < g length / height
    CAPTURE(k);
    const Json summary = run_of(bench, called("block"), d);
    const double slide = summary["extremes"]["bed friction.slide"]["max"], wanted = slide_of(d);
    // The feet give way by about the sink: the block rocks on them, and its bottom moves by height / length of that; and a thousandth.
    CHECK(std::abs(slide - wanted) < 4.0 * d["sink"] * std::max(1.0, d["height"] / d["length"]) + 1e-3 * wanted);
    if (std::abs(wanted - d["allowed_slide"]) > 0.02 * wanted + 4.0 * d["sink"])
      CHECK(verdict_of(summary) == (wanted > d["allowed_slide"] ? "reject" : "hold"));
    slid += wanted > 0.0 ? 1 : 0;
  }
  CHECK(slid > 3);
  CHECK(slid < 16);
}

// While it stands, its feet press by turns a little more and a little less: nothing that anyone would call an event.
TEST_CASE("a block that stands still has no events, and its errors are known") {
  const Workbench bench;
  const std::string file = bench.at("block.toml");
  REQUIRE(steplap_does({"new", "block", "-o", file}).code == 0);
  const Json summary = json_of(steplap_does({"simulate", file, "-o", bench.at("out"), "--json"}))["summary"];
  CHECK(summary["events"]["count"] == 0);
  CHECK(summary["overview"]["trust"]["level"] == "good");
}

TEST_CASE("a block that is slender tips over instead") {
  const Workbench bench;
  Dimensions d = {{"height", 6.0}, {"length", 1.0}, {"friction", 0.8}, {"deceleration", 0.5 * 9.80665}}; // beyond g length / height
  CHECK(verdict_of(run_of(bench, called("block"), d, true)) != "hold");                                  // its feet end beyond the vehicle
  d["height"] = 1.0;
  CHECK(verdict_of(run_of(bench, called("block"), d)) == "hold");
}

TEST_CASE("a machine on mounts goes up and down with the frequency that was asked for") {
  const Workbench bench;
  std::mt19937 random(2);
  for (int k = 0; k < 10; ++k) {
    CAPTURE(k);
    const Dimensions d = drawn(called("machine"), random);
    (void)run_of(bench, called("machine"), d);
    const Json modes = json_of(steplap_does({"modes", bench.at("machine.toml"), "--json"}))["tables"]["modes"];
    double nearest = 1e300;
    for (const Json& mode : modes)
      nearest = std::min(nearest, std::abs(mode["frequency"]["value"].get<double>() / d.at("frequency") - 1.0));
    CHECK(nearest < 1e-7); // symmetric mounts: up and down moves nothing else; what is left is rounding of the eigenvalues
  }
}

TEST_CASE("a transformer's joints have the margin that pressure and friction give them") {
  const Workbench bench;
  std::mt19937 random(3);
  for (int k = 0; k < 8; ++k) {
    CAPTURE(k);
    Dimensions d = drawn(called("transformer"), random);
    const auto between = [&random](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
    // What cores are like: `check` warns of others.
    d["pressure"] = between(0.05e6, 0.2e6);
    d["sheet_friction"] = between(0.1, 0.3);
    d["step_pitch"] = between(4e-3, 6e-3);
    d["limb_width"] = between(0.25, 0.85);
    d["stack_depth"] = d["limb_width"] * between(0.5, 1.5);
    d["window_height"] = d["limb_width"] * between(1.3, 4.0);
    const Json first = run_of(bench, called("transformer"), d);
    d["pressure"] *= 2.0;
    const Json second = run_of(bench, called("transformer"), d);
    for (const auto& [joint, before] : first["joints"].items()) {
      CAPTURE(joint);
      const double margin = before["smallest_margin"], after = second["joints"][joint]["smallest_margin"];
      if (margin > 1.0 && after > 1.0)
        CHECK(after == doctest::Approx(2.0 * margin).epsilon(1e-6)); // what a joint that sticks has to bear hangs on no pressure
    }
  }
}

TEST_CASE("what a model cannot be made of is told, and no file is written") {
  const Workbench bench;
  const std::string file = bench.at("a.toml");
  const auto refused = [&](const std::vector<std::string>& more, const std::string& words) {
    std::vector<std::string> arguments{"new"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.insert(arguments.end(), {"-o", file});
    const Outcome outcome = steplap_does(arguments);
    CHECK(outcome.code == 2);
    CHECK_MESSAGE(has(outcome.err, words), outcome.err);
    CHECK_FALSE(fs::exists(file));
  };
  refused({"blok"}, "did you mean 'block'?");
  refused({"block", "--windings", "3 t"}, "a block has no --windings");
  refused({"block", "--mass", "3 m"}, "--mass \"3 m\": give a value from 10 kg to 1000 t");
  refused({"block", "--mass", "5000 t"}, "give a value from 10 kg to 1000 t");
  refused({"block", "--mass", "= 2"}, "give a value from");
  refused({"block", "--mass", "1\"\nx = \"2"}, "give a value from");
  CHECK(steplap_does({"new", "block", "-o", file}).code == 0);
  CHECK(steplap_does({"new", "block", "-o", file}).code == 2); // it is there
  CHECK(steplap_does({"new", "block", "-o", file, "--force", "--mass", "3 t"}).code == 0);
  CHECK(has(text_of(file), "mass = { value = \"3 t\""));
}
