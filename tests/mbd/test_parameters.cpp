// [parameters]: values with units, formulas of them in fields, what is refused, and that a model whose parameters are set in memory
// is the model that is read anew with these values.
#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"
#include "mbd/simulation/simulation.h"
#include "mbd/system/instance.h"
#include "tests/random/random_number.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>

using namespace steplap;

namespace {

// A hollow box, which hangs by a spring and leans on a stop; every kind of field that takes numbers has a formula.
const char* k_scene = R"(
title = "box"
gravity = [0.0, "= -g"]
[parameters]
g = "9.81 m/s^2"
wall = { value = "12 mm", range = ["4 mm", "30 mm"], meaning = "thickness of the sheet" }
bore = "0.3 m"
width = "= 2*wall + bore"
mass = "= '7850 kg/m^3' * (width^2 - bore^2) * '1 m'"
natural = "2 Hz"
turns = 3
[simulation]
end = "= 0.2/{natural}"
tolerance = 1e-9
integrator = "dop853"
[output]
step = "= '1 s'/200"
[[body]]
name = "box"
mass = "= mass"
inertia = "= mass*(width^2 + bore^2)/6"
position = ["= width", "=-3*wall"]
outline = [[0.0, 0.0], ["= width", 0.0], ["= width", "= width"]]
[[signal]]
name = "shake"
kind = "harmonics"
amplitudes = ["= mass*g/10", 1.0]
frequencies = ["= natural", "= 3*natural"]
[[element]]
kind = "spring_damper"
name = "hanger"
a = { body = "box", point = ["= wall/2", 0.0] }
b = { body = "ground", at = [0.0, "= width + '1 m'"] }
stiffness = "= mass*(2*pi*natural)^2"
damping = "= mass*natural/turns"
[[element]]
kind = "load"
name = "wind"
at = "box"
force = ["= mass*g/20", 0.0]
force_x = "shake"
[[acceptance]]
name = "not too far"
channel = "box.x"
at_most = "= 3*width"
)";

Model given_of(const std::vector<std::string>& overrides = {}) {
  return parse_given_model(k_scene, "box.toml", transformer_catalog(), overrides);
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    static_cast<void>(parse_given_model(text, "m.toml", transformer_catalog(), overrides));
  } catch (const ModelError& error) {
    std::string all;
    for (const Diagnostic& d : error.diagnostics()) all += d.text() + "\n";
    return all;
  }
  return "";
}

std::string with(const std::string& part, const std::string& other) {
  std::string text = k_scene;
  const std::size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), other);
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("formulas give what is computed by hand") {
  const Model m = given_of();
  const double wall = 0.012, bore = 0.3, width = 2 * wall + bore, mass = 7850.0 * (width * width - bore * bore);
  const double natural = 2.0, turn = 2.0 * std::numbers::pi;
  const auto near = [](double x) { return doctest::Approx(x).epsilon(1e-14); }; // some roundings of products
  CHECK(number_of(m, "body.box.mass") == near(mass));
  CHECK(number_of(m, "body.box.inertia") == near(mass * (width * width + bore * bore) / 6));
  CHECK(number_of(m, "body.box.position.1") == near(-3 * wall));
  CHECK(number_of(m, "body.box.outline.2.1") == near(width));
  CHECK(number_of(m, "gravity.1") == -9.81);
  CHECK(number_of(m, "signal.shake.amplitudes.0") == near(mass * 9.81 / 10));
  CHECK(number_of(m, "signal.shake.frequencies.1") == near(3 * natural));
  CHECK(number_of(m, "element.hanger.stiffness") == near(mass * (turn * natural) * (turn * natural)));
  CHECK(number_of(m, "element.hanger.damping") == near(mass * natural / 3));
  CHECK(number_of(m, "marker.hanger.a.point.0") == near(wall / 2));
  CHECK(number_of(m, "marker.hanger.b.at.1") == near(width + 1));
  CHECK(number_of(m, "simulation.end") == near(0.1));
  CHECK(std::get<std::string>(value_of(m, "acceptance.not too far.at_most")) == "0.972 m");
  CHECK(m.parameters.uses.size() == 19);
}

TEST_CASE("a model whose parameters are set is the one that is read with these values") {
  // The parameters are free ones of different units; values far from round, so that a digit lost on either way shows.
  random::RandomNumber draw(7);
  Model set = given_of();
  for (int trial = 0; trial < 200; ++trial) {
    const double wall = draw.between(0.004, 0.03), bore = draw.between(0.1, 1.0), natural = draw.between(0.5, 5.0),
                 g = draw.between(1.0, 12.0);
    std::vector<std::string> overrides;
    const auto lay = [&](const std::string& name, double value, const std::string& unit) {
      char digits[64];
      std::snprintf(digits, sizeof digits, "%.17g", value);
      overrides.push_back("parameters." + name + "=" + digits + " " + unit);
      set_value(set, "parameters." + name, value);
    };
    lay("wall", wall, "m");
    lay("bore", bore, "m");
    lay("natural", natural, "Hz");
    lay("g", g, "m/s^2");
    const Model read = given_of(overrides);
    REQUIRE(read.parameters.uses.size() == set.parameters.uses.size());
    for (const ParameterUse& use : read.parameters.uses) {
      CAPTURE(use.path);
      CHECK(value_of(set, use.path) == value_of(read, use.path));
    }
  }
}

TEST_CASE("variants by parameters run as models that are read anew, to the bit") {
  const Model given = given_of();
  Variants variants(given, {"parameters.bore", "parameters.natural"});
  for (const auto& [bore, natural] :
       std::vector<std::pair<double, double>>{std::pair(0.3, 2.0), std::pair(0.41, 1.7), std::pair(0.2, 3.3)}) {
    const auto varied = variants.make({bore, natural});
    const auto direct = instantiate(given, {{"parameters.bore", bore}, {"parameters.natural", natural}});
    const Model& model = variants.model();
    const auto run = [&](const System& system) { return simulate(system, system.initial_state(), options_of(model)).final_state; };
    const State a = run(*varied), b = run(*direct);
    REQUIRE(a.q.size() == b.q.size());
    for (decltype(a.q.size()) i = 0; i < a.q.size(); ++i) CHECK(std::memcmp(&a.q[i], &b.q[i], sizeof(double)) == 0);
  }
}

TEST_CASE("criteria of variants follow parameters") {
  const Model given = parse_given_model(R"(
[parameters]
far = "1 m"
[[body]]
name = "box"
mass = 1.0
inertia = 1.0
[[acceptance]]
name = "not too far"
channel = "box.x"
at_most = "= 3*far"
)",
                                        "box.toml", transformer_catalog());
  Variants variants(given, {"parameters.far"});
  for (const char* const limit : {"1.5 m", "6 m"}) {
    static_cast<void>(variants.make({limit[0] == '6' ? 2.0 : 0.5}));
    REQUIRE(variants.model().criteria.size() == 1);
    CHECK(variants.model().criteria.front().at_most_text == limit);
  }
}

TEST_CASE("what makes no sense is refused with place and remedy") {
  struct Case {
    const char *part, *other, *message;
  };
  const Case cases[] = {
      {"wall + bore\"", "wal + bore\"",
       "m.toml:8:9: error: parameter 'width': formula: there is no parameter 'wal' (did you mean 'wall'?)"},
      {"\"= mass\"", "\"= mas\"", "there is no parameter 'mas' (did you mean 'mass'?)"},
      {"bore = \"0.3 m\"", "bore = \"= width - 2*wall\"", "parameters that need each other: bore -> width -> bore"},
      {"bore = \"0.3 m\"", "bore = \"= bore\"", "parameters that need each other: bore -> bore"},
      {"\"= mass\"", "\"= width\"", "the formula gives a value in m, but a unit like 'kg' is needed"},
      {"\"= mass\"", "\"= 5\"", "the formula gives a number without a unit, but a unit like 'kg' is needed"},
      {"2*wall + bore\"", "2*wall + turns\"", "one side has the unit m, the other no unit"},
      {"\"= mass\"", "\"= mass/(turns - 3)\"", "has no finite value"},
      {"bore = \"0.3 m\"", "bore = \"= '1 m'/(turns - 3)\"", "parameter 'bore': the formula has no finite value"},
      {"\"= mass\"", "\"= mass*\"", "ends where a value should be"},
      {"\"= mass\"", "\"= mass*t/'1 s'\"", "'t' is the time"},
      {"bore = \"0.3 m\"", "bore = \"0.3 furlongs per fortnight squared\"", "parameter 'bore'"},
      {"bore = \"0.3 m\"", "bore = \"3 mol\"", "has a unit that is not made of kg, m and s"},
      {"bore = \"0.3 m\"", "bore = true", "expected a number"},
      {"bore = \"0.3 m\"", "\"2b\" = 1.0", "a parameter's name has letters"},
      {"value = \"12 mm\"", "value = \"40 mm\"", "parameter 'wall' is 0.04 m, above its range, which ends at 0.03 m"},
      {"\"30 mm\"]", "\"30 ms\"]", "is a value in s, the parameter a value in m"},
      {"\"4 mm\", \"30 mm\"", "\"30 mm\", \"4 mm\"", "begins above its end"},
      {"natural = \"2 Hz\"", "natural = \"2 rad/s\"", "counts radians a second, but the field turns, 'Hz'"},
      {"turns = 3", "turns = 3\nspin = \"60 1/min\"\n[[body]]\nname = \"b\"\nmass = 1\ninertia = 1\nangular_velocity = \"= spin\"",
       "'spin' counts turns a second, but the field radians"},
      {"meaning =", "meanin =", "unknown key 'meanin' in parameter 'wall' (did you mean 'meaning'?)"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.message);
    const std::string text = refusal(with(c.part, c.other));
    CAPTURE(text);
    CHECK(has(text, c.message));
    CHECK(has(text, "m.toml:"));
  }
  CHECK(has(refusal(k_scene, {"parameters.wal=1 mm"}), "the model has no parameter 'wal' (did you mean 'wall'?)"));
  CHECK(has(refusal(k_scene, {"parameters.wall=50 mm"}), "above its range"));
  CHECK(has(refusal(k_scene, {"parameters.wall=14"}),
            "override parameters.wall=14: error: parameter 'wall' is a number without a unit, its range '4 mm' a value in m"));
  CHECK(refusal(k_scene, {"parameters.wall=14 mm", "parameters.width=0.4 m"}).empty());
}

TEST_CASE("one wrong parameter is told once, not by all that need it") {
  const std::string text = refusal(with("bore = \"0.3 m\"", "bore = \"0.3 ells\""));
  CAPTURE(text);
  CHECK(std::count(text.begin(), text.end(), '\n') == 1);
}

TEST_CASE("values that follow from others cannot be set, nor values out of range") {
  Model m = given_of();
  CHECK_THROWS_AS(set_value(m, "parameters.width", 0.5), ModelError);
  CHECK_THROWS_AS(set_value(m, "parameters.wall", 0.05), ModelError);
  CHECK_THROWS_AS(set_value(m, "parameters.walls", 0.01), ModelError);
  CHECK(unit_of(m, "parameters.wall") == "m");
  CHECK(number_of(m, "parameters.width") == doctest::Approx(0.324).epsilon(1e-15)); // one rounding
}

TEST_CASE("a parameter that many formulas lead to is followed once") {
  // In 60 layers of two parameters, each of which uses both of the layer before, 2^60 paths lead from the last to the first.
  std::string layers = "bore = \"0.3 m\"\nleft0 = 1\nright0 = 1\n";
  for (int i = 1; i <= 60; ++i)
    for (const char* side : {"left", "right"})
      layers += side + std::to_string(i) + " = \"= left" + std::to_string(i - 1) + "/2 + right" + std::to_string(i - 1) + "/2\"\n";
  const std::string text = with("bore = \"0.3 m\"\n", layers);
  Model m = parse_given_model(text + "at_least = \"= -left60*'1 m'\"\n", "box.toml", transformer_catalog(), {});
  set_value(m, "parameters.right0", 3.0);
  CHECK(number_of(m, "parameters.left60") == 2.0); // the mean of both
}

TEST_CASE("a file that extends another changes values and keeps range and meaning") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "steplap_parameters";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "base.toml") << k_scene;
  std::ofstream(folder / "thick.toml") << "extends = \"base.toml\"\n[parameters]\nwall = \"20 mm\"\n";
  const Model m = read_given_model((folder / "thick.toml").string(), transformer_catalog());
  CHECK(number_of(m, "body.box.position.1") == doctest::Approx(-0.06).epsilon(1e-15)); // one rounding
  const Parameter& wall = m.parameters.entries[*m.parameters.find("wall")];
  CHECK(*wall.most == 0.03);
  CHECK(wall.meaning == "thickness of the sheet");
  std::filesystem::remove_all(folder);
}

TEST_CASE("the text that stands alone keeps parameters and formulas") {
  const std::string text =
      effective_model_text(std::string(STEPLAP_TEST_DATA) + "/parameters/box.toml", transformer_catalog(), {"parameters.wall=15 mm"});
  CHECK(has(text, "= 2*wall + bore"));
  const Model again = parse_given_model(text, "again.toml", transformer_catalog());
  CHECK(again.parameters.values[*again.parameters.find("wall")] == 0.015);
}
