// Two models, and two runs, compared.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace steplap::testing;

namespace {

using Json = nlohmann::json;

std::string put(std::string text, const std::string& old, const std::string& now) {
  REQUIRE(has(text, old));
  return text.replace(text.find(old), old.size(), now);
}

Json result_of(const Outcome& outcome) {
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  return Json::parse(outcome.out)["results"][0];
}

const Json* row_of(const Json& rows, const std::string& key, const std::string& value) {
  for (const Json& row : rows)
    if (row[key] == value) return &row;
  return nullptr;
}

} // namespace

TEST_CASE("models that say the same in other words are the same") {
  const Workbench bench;
  const std::string text = k_oscillator, first = bench.write("a.toml", text);
  // Another unit, a default written out, another order of entries, a file that extends another.
  const std::string second =
      bench.write("b.toml", put(put(text, "mass = \"2 kg\"", "mass = 2000e-3\nangle = 0.0"), "end = 0.1", "end = \"100 ms\""));
  const std::string third = bench.write("c.toml", "extends = \"a.toml\"\n");
  for (const std::string& other : {first, second, third}) {
    const Outcome same = steplap_does({"diff", first, other, "--require-same"});
    CHECK(same.code == 0);
    CHECK_MESSAGE(has(same.out, "The models are the same"), same.out);
  }
}

TEST_CASE("what differs between models is told by path, in SI, with what only one of them has") {
  const Workbench bench;
  const std::string text = k_oscillator, first = bench.write("a.toml", text);
  std::string other = put(put(text, "stiffness = 800", "stiffness = 1000\ndamping = 3"), "velocity = [0.1, 0]", "velocity = [0.1, 0.2]");
  other = put(other, "name = \"spare\"", "name = \"spare part\"");
  const std::string second = bench.write("b.toml", other);
  CHECK(steplap_does({"diff", first, second}).code == 0);
  CHECK(steplap_does({"diff", first, second, "--require-same"}).code == 5);
  CHECK(steplap_does({"diff", first, second, "--require-same", "-q"}).out.empty());
  const Json rows = result_of(steplap_does({"diff", first, second, "--json"}))["tables"]["values"];
  CHECK(rows.size() == 5);
  const Json* stiffness = row_of(rows, "path", "element.spring.stiffness");
  REQUIRE(stiffness);
  CHECK((*stiffness)["before"] == Json{{"value", 800.0}, {"unit", "N/m"}});
  CHECK((*stiffness)["after"]["value"] == 1000.0);
  CHECK((*stiffness)["change"]["value"].get<double>() == doctest::Approx(25.0));
  const Json* velocity = row_of(rows, "path", "body.mass.velocity.1"); // the component alone, as --set takes it
  REQUIRE(velocity);
  CHECK((*velocity)["after"]["value"] == 0.2);
  REQUIRE(row_of(rows, "path", "signal.spare"));
  CHECK((*row_of(rows, "path", "signal.spare"))["change"] == "removed");
  CHECK((*row_of(rows, "path", "signal.spare part"))["change"] == "added");
  for (const Json& row : rows) // the paths lead where they say
    if (row["before"].is_object()) CHECK(steplap_does({"check", first, "--set", row["path"].get<std::string>() + "=0.5", "-q"}).code == 0);
}

TEST_CASE("of a parameter that differs it is told what follows from it") {
  const Workbench bench;
  REQUIRE(steplap_does({"new", "block", "-o", bench.at("a.toml")}).code == 0);
  REQUIRE(steplap_does({"new", "block", "--mass", "20 t", "-o", bench.at("b.toml")}).code == 0);
  const Json rows = result_of(steplap_does({"diff", bench.at("a.toml"), bench.at("b.toml"), "--json"}))["tables"]["values"];
  CHECK(rows[0]["path"] == "parameters.mass");
  CHECK(rows[0]["why"] == "");
  CHECK(rows[0]["after"]["value"] == 20000.0);
  REQUIRE(rows.size() > 3);
  for (std::size_t i = 1; i < rows.size(); ++i) CHECK_MESSAGE(rows[i]["why"] == "follows from parameters", rows[i].dump());
  CHECK(row_of(rows, "path", "body.block.inertia"));
}

TEST_CASE("runs that differ by less than their errors agree, whatever their tolerance") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  const auto run = [&](const std::string& tolerance) {
    REQUIRE(steplap_does({"simulate", model, "-o", bench.at(tolerance), "--integrator", "dop853", "--tolerance", tolerance, "--set",
                          "simulation.step=unset", "--estimate-error", "-q"})
                .code == 0);
    return bench.at(tolerance + "/a");
  };
  const std::string coarse = run("1e-6"), fine = run("1e-10");
  CHECK(has(steplap_does({"diff", fine, fine}).out, "The models are the same"));
  const Outcome differ = steplap_does({"diff", coarse, fine});
  CHECK(differ.code == 0);
  CHECK_MESSAGE(has(differ.out, "simulation.tolerance"), differ.out);
  CHECK_MESSAGE(has(differ.out, "The runs agree"), differ.out);
}

TEST_CASE("what followed from another value is told with its size: verdict, events, extremes") {
  const Workbench bench;
  // A mass on a spring swings by v sqrt(m/k): four times the stiffness, half the way.
  const std::string text = put(std::string(k_oscillator), "end = 0.1", "end = 0.5") +
                           "\n[[acceptance]]\nname = \"way\"\nchannel = \"mass.x\"\nwithin = 0.004\nconsequence = \"reject\"\n";
  const std::string soft = bench.write("soft.toml", text),
                    stiff = bench.write("stiff.toml", put(text, "stiffness = 800", "stiffness = 3200"));
  for (const std::string& model : {soft, stiff})
    REQUIRE(steplap_does({"simulate", model, "-o", bench.at("out"), "--estimate-error", "-q"}).code == 0);
  const Outcome said = steplap_does({"diff", bench.at("out/soft"), bench.at("out/stiff")});
  CHECK_MESSAGE(has(said.out, "reject"), said.out);
  // Verdict, criterion and share of the limit stand before the value from which they follow.
  const std::size_t value = said.out.find("element.spring.stiffness");
  REQUIRE(value != std::string::npos);
  for (const char* first : {"verdict", "Criteria", "share of the limit", "125 %"}) CHECK_MESSAGE(said.out.find(first) < value, first);
  const Json result = result_of(steplap_does({"diff", bench.at("out/soft"), bench.at("out/stiff"), "--json"})), tables = result["tables"];
  CHECK(tables["values"].size() == 1);
  CHECK(*row_of(tables["outcome"], "what", "verdict") == Json{{"what", "verdict"}, {"before", "reject"}, {"after", "hold"}});
  CHECK(tables["criteria"][0]["before"]["value"].get<double>() ==
        doctest::Approx(0.005).epsilon(1e-6)); // v sqrt(m/k); the run's own error is less
  CHECK(tables["criteria"][0]["after"]["value"].get<double>() == doctest::Approx(0.0025).epsilon(1e-6));
  const Json* way = row_of(tables["extremes"], "channel", "mass.x");
  REQUIRE(way);
  CHECK((*way)["change"]["value"].get<double>() == doctest::Approx(-50.0).epsilon(1e-4));
  CHECK(row_of(tables["extremes"], "channel", "mass.vx") == nullptr); // m v^2 / 2 is the same: largest where it began
}

TEST_CASE("what was zero has no share by which it changed") {
  const Workbench bench;
  const std::string still = bench.write("still.toml", put(k_oscillator, "velocity = [0.1, 0]", "velocity = [0, 0.1]")),
                    moved = bench.write("moved.toml", k_oscillator);
  for (const std::string& model : {still, moved})
    REQUIRE(steplap_does({"simulate", model, "-o", bench.at("out"), "--estimate-error", "-q"}).code == 0);
  const Json rows = result_of(steplap_does({"diff", bench.at("out/still"), bench.at("out/moved"), "--json"}))["tables"]["extremes"];
  const Json* rate = row_of(rows, "channel", "mass.vx");
  REQUIRE(rate);
  CHECK((*rate)["change"] == "");
  CHECK((*rate)["after"]["value"].get<double>() == doctest::Approx(0.1).epsilon(1e-6));
}

TEST_CASE("what cannot be compared is one clear error") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_oscillator);
  const Outcome mixed = steplap_does({"diff", model, bench.at("")});
  CHECK(mixed.code == 2);
  CHECK_MESSAGE(has(mixed.err, "compare two models, or two folders of runs"), mixed.err);
  CHECK(steplap_does({"diff", model, bench.at("none.toml")}).code == 3);
  CHECK(steplap_does({"diff", bench.at(""), bench.at("")}).code == 2); // no results in there
}
