// What channels are called and mean: every one that any kind of element or any model can make has a unit that formulas
// know, a meaning, and a sign or codes where its value has any; and formulas of channels.
#include "elements/catalog.h"
#include "mbd/formula/unit_dimension.h"
#include "mbd/io/kind_channels.h"
#include "mbd/io/units.h"
#include "mbd/model/completion.h"
#include "mbd/rest/start.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <numbers>
#include <set>

using namespace steplap;
using steplap::testing::scene;

namespace {

bool has_value_of_either_sign(const std::string& unit) {
  return !unit.empty() && unit != "J" && unit != "m^2" && unit != "Pa" && unit != "N/m";
}

void check_text(const std::string& name, const std::string& unit, const std::string& meaning, const std::string& sign,
                const std::string& codes) {
  CAPTURE(name);
  CHECK(meaning.size() >= 5);
  CHECK_MESSAGE(dimension_of(unit), unit);
  // A mode is told by codes; what is measured in a unit says which way it counts, or that it means no error at all.
  const bool is_code = name.ends_with("mode");
  CHECK(codes.empty() == !is_code);
  const bool tells = !sign.empty() || meaning.find("zero up to numerical error") != std::string::npos || name.ends_with("length") ||
                     name.starts_with("edge_force");
  if (has_value_of_either_sign(unit) && !is_code) CHECK_MESSAGE(tells, "no sign");
}

const char* const k_pendulum = R"(
[output]
also = ["*"]
[[body]]
name = "rod"
mass = 2.0
inertia = 0.3
position = [0.4, 0.0]
[[marker]]
name = "tip"
body = "rod"
point = [0.5, 0.1]
[[element]]
name = "pin"
kind = "revolute"
a = { body = "rod", at = [0.0, 0.0] }
b = "ground"
[simulation]
step = 1e-3
end = 0.5
)";

std::string message_of(const std::string& text) {
  try {
    (void)compile(scene(text));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

std::string with_formula(const std::string& expression, const std::string& more = "") {
  return std::string(k_pendulum) + "[[channel]]\nname = \"it\"\nexpression = \"" + expression + "\"\n" + more;
}

bool says(const std::string& message, const std::string& part) {
  INFO(message);
  CHECK(message.find("scene.toml:") != std::string::npos); // where
  return message.find(part) != std::string::npos;
}

// Value of the formula at the start of the pendulum's run.
double value_of(const std::string& expression, const std::string& more = "") {
  const auto run = testing::run(scene(with_formula(expression, more)), {"rk4", 1e-3, 1e-3});
  return run.series("it").front();
}

} // namespace

TEST_CASE("every channel of every kind of element has a meaning, a sign and a unit") {
  const Catalogue& catalogue = element_catalog();
  std::size_t count = 0, kinds = 0;
  for (const ElementKind* kind : catalogue.elements) {
    CAPTURE(kind->name);
    const std::vector<KindChannel> channels = channels_of_kind(catalogue, *kind);
    const bool has_none = kind->name == "step_lap_interface"; // its joint speaks for it
    CHECK(channels.empty() == has_none);
    CHECK_MESSAGE(example_text(*kind).find("kind = '" + kind->name + "'") != std::string::npos, "a kind needs an ElementKind::example");
    for (const KindChannel& c : channels)
      for (const std::string& unit : c.units) check_text(c.name, unit, c.meaning, c.sign, c.codes);
    count += channels.size();
    kinds += !channels.empty();
  }
  CHECK(kinds >= 22);
  CHECK(count > 100);
  for (const auto& list : {channels_of_bodies(catalogue), channels_of_markers(catalogue), channels_of_model(catalogue)}) {
    CHECK(list.size() >= 5);
    for (const KindChannel& c : list) check_text(c.name, c.units.front(), c.meaning, c.sign, c.codes);
  }
}

TEST_CASE("every channel of every model has a meaning, and is listed for its kind") {
  const Catalogue& catalogue = transformer_catalog();
  std::map<std::string, std::set<std::string>> listed;
  for (const ElementKind* kind : catalogue.elements)
    for (const KindChannel& c : channels_of_kind(catalogue, *kind)) listed[kind->name].insert(c.name);
  listed["state"] = {"value"}; // what `[[state]]` becomes is no kind that a file may name
  int models = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(STEPLAP_MODELS)) {
    if (entry.path().extension() != ".toml") continue;
    Model model;
    try {
      model = read_model(entry.path().string(), catalogue);
    } catch (const ModelError&) {
      continue; // a part that others extend
    }
    CAPTURE(entry.path().string());
    ++models;
    const std::unique_ptr<System> usual = compile(model);
    model.output.also = {"*"};
    const std::unique_ptr<System> system = compile(model);
    CHECK(system->channels.size() > usual->channels.size());
    CHECK(usual->integrands.empty()); // not asked for: nothing there
    std::set<std::string> names;
    for (const Channel& c : system->channels) {
      CHECK_MESSAGE(names.insert(c.name).second, c.name);
      CHECK_MESSAGE(c.doc.size() >= 5, c.name);
    }
    std::map<std::string, std::string> kind_of;
    for (std::size_t e = 0; e < system->element_names.size(); ++e) kind_of[system->element_names[e]] = system->element_kinds[e];
    for (const Channel& c : system->channels) {
      const std::size_t dot = c.name.rfind('.');
      const auto kind = kind_of.find(c.name.substr(0, dot));
      const std::string part = c.name.substr(dot + 1);
      if (kind == kind_of.end() || part.starts_with("edge_")) continue; // numbered
      if (names.size() > 0 && listed[kind->second].count(part) == 0 &&
          (part == "x" || part == "y" || part == "vx" || part == "vy" || part == "ax" || part == "ay"))
        continue; // a marker of that name
      CHECK_MESSAGE(listed[kind->second].count(part) == 1, kind->second << " makes " << part << ", which its list lacks");
    }
  }
  CHECK(models > 20);
}

TEST_CASE("units that formulas know are those of UDUNITS") {
  for (const std::string unit :
       {"m",     "mm",  "cm",  "s",      "ms",      "kg",      "t",         "N",     "kN",  "MN",  "J",       "kJ",
        "W",     "kW",  "Pa",  "kPa",    "MPa",     "GPa",     "bar",       "deg",   "min", "h",   "gravity", "km/h",
        "m/s^2", "N m", "N/m", "kN s/m", "N m/rad", "percent", "kg m2 s-2", "rad/s", "%",   "mrad"}) { // NOLINT
    CAPTURE(unit);
    const auto mine = dimension_of(unit);
    REQUIRE(mine);
    const Quantity theirs = parse_quantity("1 " + std::string(unit), "*", UnitSource::database);
    REQUIRE(theirs.problem.empty());
    CHECK(mine->factor == doctest::Approx(theirs.value).epsilon(1e-14)); // a few roundings
    // The dimension: UDUNITS converts to what the powers make, and only then.
    const std::string si = unit_text(mine->powers);
    CHECK(parse_quantity("1 " + std::string(unit), si, UnitSource::database).problem.empty());
  }
  // Amperes and kelvins count as numbers: the factors are UDUNITS', and circuits close, V A = W, V/A = ohm, V s/A = H, A s/V = F.
  for (const char* unit : {"A", "mA", "K", "C", "V", "kV", "ohm", "H", "mH", "uF", "Wb"}) {
    CAPTURE(unit);
    REQUIRE(dimension_of(unit));
    CHECK(dimension_of(unit)->factor ==
          doctest::Approx(parse_quantity("1 " + std::string(unit), "*", UnitSource::database).value).epsilon(1e-14));
  }
  for (const auto& [one, other] : {std::pair("V A", "W"), std::pair("V/A", "ohm"), std::pair("V s/A", "H"), std::pair("A s/V", "F"),
                                   std::pair("A s", "C"), std::pair("N m/A", "Wb")})
    CHECK(dimension_of(one)->powers == dimension_of(other)->powers);
  for (const char* unit : {"Hz", "rpm", "g", "stone", "m/", "/s", "m^", "kkg", "m//s", "furlong", "m^123", "k"})
    CHECK_MESSAGE(!dimension_of(unit), unit);
}

TEST_CASE("formulas compute what the same by hand does") {
  // At rest at (0.4, 0): the tip is at (0.9, 0.1).
  CHECK(value_of("tip.x") == doctest::Approx(0.9).epsilon(1e-15));
  CHECK(value_of("2 * tip.x + {tip.y} - tip.y") == doctest::Approx(1.8).epsilon(1e-15));
  CHECK(value_of("{tip.x [m]} / '10 cm'") == doctest::Approx(9.0).epsilon(1e-15));
  CHECK(value_of("-tip.x^2") == doctest::Approx(-0.81).epsilon(1e-15)); // the power first
  CHECK(value_of("2^3^2") == 512.0);                                    // from the right
  CHECK(value_of("1 - 2 - 3") == -4.0);
  CHECK(value_of("8 / 4 / 2") == 1.0);
  CHECK(value_of("2^-1") == 0.5);
  CHECK(value_of("hypot(tip.x, tip.y)") == doctest::Approx(std::sqrt(0.82)).epsilon(1e-15));
  CHECK(value_of("sqrt(tip.x * tip.x)") == doctest::Approx(0.9).epsilon(1e-15));
  CHECK(value_of("min(tip.x, tip.y) + max(0, tip.x) + abs(-tip.y)") == doctest::Approx(1.1).epsilon(1e-15));
  CHECK(value_of("sin(pi/6) + cos(pi/3) + tan(pi/4)") == doctest::Approx(2.0).epsilon(1e-15));
  CHECK(value_of("asin(1) + acos(-1) + atan(1) + atan2(tip.x, tip.x)") == doctest::Approx(2.0 * std::numbers::pi).epsilon(1e-15));
  CHECK(value_of("ln(exp(2)) + log10(1000)") == doctest::Approx(5.0).epsilon(1e-14));
  CHECK(value_of("'-3/s' * t + pin.rate / '4 1/s' + '6'/2") == 3.0);
  CHECK(value_of("tip.x", "unit = \"mm\"\n") == doctest::Approx(900.0).epsilon(1e-15));
  CHECK(value_of("whole.kinetic / '1 kJ'") == 0.0);
  CHECK(value_of("pin.angle", "unit = \"deg\"\n") == 0.0);
}

TEST_CASE("formulas of formulas, and those without a value") {
  const std::string text = with_formula(
      "{half of it} * 2", "[[channel]]\nname = \"half of it\"\nexpression = \"tip.x / 2\"\nunit = \"mm\"\nmeaning = \"half\"\n");
  const auto run = testing::run(scene(text), {"rk4", 1e-3, 1e-2});
  CHECK(run.series("it").front() == doctest::Approx(0.9).epsilon(1e-15)); // of an operand in mm
  CHECK(run.system->find_channel("half of it")->doc == "half");
  CHECK(run.system->find_channel("it")->doc == "= {half of it} * 2");
  CHECK(run.system->find_channel("it")->unit == "m");
  CHECK(std::isnan(value_of("1 / (tip.x - tip.x) * '1 m'")));
  CHECK(std::isnan(value_of("sqrt(-1)")));
  CHECK(std::isnan(value_of("asin(2)")));
  CHECK(std::isnan(value_of("ln(0)"))); // infinite
  // Zero at the start only: told by the range.
  SimulationOptions options = testing::options({"rk4", 1e-3, 0.1});
  options.has_extremes = true;
  const auto system = compile(scene(with_formula("'1 m/s' / pin.rate")));
  const RunResult result = simulate(*system, system->initial_state(), options);
  for (const ChannelRange& range : result.ranges) CHECK(range.had_no_value == (range.channel->name == "it"));
}

TEST_CASE("what no formula can be is refused where it stands") {
  CHECK(says(message_of(with_formula("tipp.x")), "no channel 'tipp.x' (did you mean 'tip.x'?)"));
  CHECK(says(message_of(with_formula("tip.x + tip.vx")), "one side has the unit m, the other the unit m/s"));
  CHECK(says(message_of(with_formula("tip.x + 3")), "'3 m'"));
  CHECK(says(message_of(with_formula("sin(tip.x)")), "takes what has no unit"));
  CHECK(says(message_of(with_formula("2 ^ tip.x")), "the exponent has the unit m"));
  CHECK(says(message_of(with_formula("tip.x ^ pin.angle")), "takes a number as its exponent"));
  CHECK(says(message_of(with_formula("squrt(tip.x)")), "(did you mean 'sqrt'?)"));
  CHECK(says(message_of(with_formula("hypot(tip.x)")), "too few values"));
  CHECK(says(message_of(with_formula("tip.x +")), "ends where a value should be"));
  CHECK(says(message_of(with_formula("(tip.x")), "lacks a ')'"));
  CHECK(says(message_of(with_formula("tip.x)")), "where an operator or its end should be"));
  CHECK(says(message_of(with_formula("{tip.x")), "lacks a '}'"));
  CHECK(says(message_of(with_formula("'3 Hz' * 1")), "do not know"));
  CHECK(says(message_of(with_formula("'3 m")), "second '"));
  CHECK(says(message_of(with_formula(" ")), "is empty"));
  CHECK(says(message_of(with_formula("{ }")), "no name"));
  CHECK(says(message_of(with_formula("{tip.x [N]}")), "is in 'm', not in 'N'"));
  CHECK(says(message_of(with_formula("tip.x", "unit = \"N\"\n")), "which is none of 'N'"));
  CHECK(says(message_of(with_formula("tip.x", "unit = \"elbow\"\n")), "not known"));
  CHECK(says(message_of(with_formula("tip.x * pin.force_x")), "energy or torque?"));
  CHECK(message_of(with_formula("tip.x * pin.force_x", "unit = \"N m\"\n")).empty());
  CHECK(says(message_of(with_formula("{it} + 1")), "leads back to itself"));
  CHECK(says(message_of(with_formula("{that}", "[[channel]]\nname = \"that\"\nexpression = \"{it}\"\n")), "leads back to itself"));
  // Formulas that name each other grow without bound: 800 in two columns, and a chain that is read from its end.
  std::string grid, chain;
  const auto channel = [](const std::string& name, const std::string& formula) {
    return "[[channel]]\nname = \"" + name + "\"\nexpression = \"" + formula + "\"\n";
  };
  for (int i = 1; i <= 400; ++i) {
    const std::string now = std::to_string(i), before = std::to_string(i - 1);
    const std::string operands[] = {i == 1 ? "tip.x" : "a" + before, i == 1 ? "tip.x" : "b" + before};
    grid += channel("a" + now, operands[0] + " + " + operands[1]) + channel("b" + now, operands[0] + " - 2*" + operands[1]);
  }
  for (int i = 0; i < 20000; ++i) chain += channel("c" + std::to_string(i), "c" + std::to_string(i + 1));
  CHECK(says(message_of(with_formula("tip.x", grid)), "more than 500000 operations"));
  CHECK(says(message_of(with_formula("c0", chain)), "name each other in a row"));
  CHECK(says(message_of(with_formula("tip.x", "[[channel]]\nname = \"it\"\nexpression = \"1\"\n")), "exists already"));
  CHECK(
      says(message_of(std::string(k_pendulum) + "[[channel]]\nname = \"tip.x\"\nexpression = \"1\"\n"), "two channels are called 'tip.x'"));
  // Thirty thousand brackets end in words, not in a crash.
  CHECK(says(message_of(with_formula(std::string(30000, '(') + "1")), "too deep"));
  CHECK(says(message_of(with_formula(std::string(30000, '-') + "1")), "too deep"));
  CHECK(says(message_of(with_formula("1e999")), "cannot be read"));
  CHECK(says(message_of(with_formula("tip.x · 2")), "has '·' where")); // whole, not its first byte
}

TEST_CASE("what [output] asks for must be there, and only that is made") {
  std::string text = k_pendulum;
  const auto asks = [&](const std::string& list) {
    std::string changed = text;
    return changed.replace(changed.find("\"*\""), 3, list);
  };
  CHECK(says(message_of(asks("\"tipp.*\"")), "no channel matches 'tipp.*'"));
  CHECK(says(message_of(asks("\"tip.xx\"")), "did you mean 'tip.x'?"));
  const auto system = compile(scene(asks("\"tip.a?\", \"pin.power\"")));
  int requested = 0;
  for (const Channel& c : system->channels) requested += c.is_on_request;
  CHECK(requested == 3);
  CHECK(system->find_channel("tip.ax"));
  CHECK(!system->find_channel("tip.x"));
  CHECK(system->integrands.empty());
  // A formula's operands are no channels for that.
  const auto formula = compile(scene(asks("") + "[[channel]]\nname = \"it\"\nexpression = \"tip.x\"\n"));
  CHECK(formula->find_channel("it"));
  CHECK(!formula->find_channel("tip.x"));
  // Named outright, as a study does: the same channels, whatever the file asks for.
  const std::vector<std::string> wanted{"it", "pin.angle"};
  const auto few = compile(scene(asks("\"tip.*\"") + "[[channel]]\nname = \"it\"\nexpression = \"rod.x\"\n"), &wanted);
  REQUIRE(few->channels.size() == 2);
  CHECK(few->find_channel("it"));
  CHECK(few->find_channel("pin.angle"));
}
