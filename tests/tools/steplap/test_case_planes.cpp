// Load cases of two models of one machine: frictions that both planes share, against closed forms.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;
using Json = nlohmann::ordered_json;

namespace {

constexpr double k_g = 9.80665;

// A block of 20 t on two feet with friction 0.3.
const std::string k_block = R"(gravity = [0.0, -9.80665]
[simulation]
end = 1.0
initial = "equilibrium"
[[body]]
name = "unit"
mass = 20000
inertia = 1.5e4
position = [0.0, 0.6]
outline = [[-1.2, -0.6], [1.2, -0.6], [1.2, 0.6], [-1.2, 0.6]]
[[acceptance]]
name = "stays"
channel = "unit.x"
within = "5 mm"
)";

const std::string k_feet = R"([[element]]
kind = "unilateral_contact"
name = "front"
a = { body = "unit", at = [1.2, 0.0] }
b = { body = "ground", at = [1.2, 0.0] }
stiffness = "1 GN/m"
damping = "500 kN s/m"
[[element]]
kind = "unilateral_contact"
name = "rear"
a = { body = "unit", at = [-1.2, 0.0] }
b = { body = "ground", at = [-1.2, 0.0] }
stiffness = "1 GN/m"
damping = "500 kN s/m"
[[element]]
kind = "coulomb_stick"
name = "beams"
contacts = ["front", "rear"]
static_friction = 0.3
)";

const std::string k_outline = R"([[element]]
kind = "polygon_contact"
name = "beams"
a = "unit"
stiffness = "10 GN/m2"
dissipation = 1.0
static_friction = 0.3
)";

std::string load_case(const std::string& name, const std::string& plane, const std::string& fields) {
  return "[[case]]\nname = \"" + name + "\"\nsource = \"a test\"\n" + (plane.empty() ? "" : "plane = \"" + plane + "\"\n") + fields + "\n";
}

std::string pull(double x, double y = 0.0) { return "pull = [" + std::to_string(x * k_g) + ", " + std::to_string(y * k_g) + "]"; }

// The models of both planes, with the fields of a case "corner" in each.
struct Machine {
  Workbench bench;
  std::string along = k_block + k_feet, across = k_block + k_feet;

  [[nodiscard]] Outcome does(const std::string& one, const std::string& other, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"cases", bench.write("along.toml", along + load_case("corner", "lengthwise", one)),
                                       bench.write("across.toml", across + load_case("corner", "transverse", other))};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return steplap_does(arguments);
  }
  [[nodiscard]] Json found(const std::string& one, const std::string& other) const {
    const Outcome outcome = does(one, other, {"--json"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return Json::parse(outcome.out)["results"][0]["load_cases"];
  }
};

// The use of the shared friction, which both models have as their last limit.
double use_of(const Json& found) {
  const Json &one = found["cases"][0]["limits"].back(), &other = found["cases"][1]["limits"].back();
  CHECK(one["limit"] == "beams in both planes");
  CHECK(one.dump() == other.dump());
  return one["utilisation"].get<double>();
}

// The runs' own error: they estimate their forces to 3 N of 40 kN. The pull has 6 digits behind the point.
constexpr double k_at_rest = 1e-4;

} // namespace

TEST_CASE("0.25 g along and across at a friction of 0.3: each plane holds, both together use 1.179 and are open") {
  for (const std::string& contact : {k_feet, k_outline}) {
    Machine machine;
    machine.along = machine.across = k_block + contact;
    const Json found = machine.found(pull(0.25), pull(0.25));
    CHECK(use_of(found) == doctest::Approx(0.25 * std::sqrt(2.0) / 0.3).epsilon(k_at_rest));
    CHECK(found["verdict"] == "open");
    for (const char* name : {"corner (lengthwise)", "corner (transverse)"})
      CHECK(std::any_of(found["cases"].begin(), found["cases"].end(), [&](const Json& one) {
        return one["name"] == name && one["verdict"] == "open" && one["governing_limit"] == "beams in both planes";
      }));
    CHECK(has(found["reason"], "Both planes together ask for 117.9 % of the friction 'beams'"));
    CHECK(has(found["reason"], "how far they slide is not computed"));
    CHECK(machine.does(pull(0.25), pull(0.25), {"--require-hold"}).code == 5);
    // Each alone holds: it uses 0.833.
    CHECK(steplap_does({"cases", machine.bench.at("along.toml"), "--require-hold"}).code == 0);
    CHECK(steplap_does({"cases", machine.bench.at("across.toml"), "--require-hold"}).code == 0);
  }
}

TEST_CASE("0.2 g along and across hold, in either order; the vertical pull counts once") {
  const Machine machine;
  const Json found = machine.found(pull(0.2), pull(0.2));
  CHECK(use_of(found) == doctest::Approx(0.2 * std::sqrt(2.0) / 0.3).epsilon(k_at_rest));
  CHECK(found["verdict"] == "hold");
  CHECK(std::abs(use_of(found) - 0.2 * std::sqrt(2.0) / 0.3) < found["cases"][0]["limits"].back()["utilisation_error"].get<double>());
  CHECK(found["other_planes"][0]["inputs"][0]["sha256"] != found["model"]["inputs"][0]["sha256"]);
  const Outcome turned = steplap_does({"cases", machine.bench.at("across.toml"), machine.bench.at("along.toml"), "--json"});
  CHECK(use_of(Json::parse(turned.out)["results"][0]["load_cases"]) == doctest::Approx(use_of(found)).epsilon(1e-12)); // the same runs
  // Twice would be 0.18 √2/(0.3 · 0.8) = 1.06.
  const Json lifted = machine.found(pull(0.18, 0.1), pull(0.18, 0.1));
  CHECK(use_of(lifted) == doctest::Approx(0.18 * std::sqrt(2.0) / (0.3 * 0.9)).epsilon(k_at_rest));
  CHECK(lifted["verdict"] == "hold");
}

TEST_CASE("on a slope whose azimuth turns the block uses tan/mu, and is open beyond tan = mu") {
  // Each model has the part of the slope in its plane; its gravity keeps its size.
  const Machine machine;
  const auto tilted = [](double sine) {
    return "set = [\"gravity=[" + std::to_string(k_g * sine) + ", " + std::to_string(-k_g * std::sqrt(1.0 - sine * sine)) + "]\"]";
  };
  for (const double tangent : {0.2, 0.32})
    for (const double azimuth : {0.5, 0.8, 1.1}) { // each part alone holds
      const double sine = std::sin(std::atan(tangent));
      const Json found = machine.found(tilted(sine * std::cos(azimuth)), tilted(sine * std::sin(azimuth)));
      CHECK(use_of(found) == doctest::Approx(tangent / 0.3).epsilon(k_at_rest));
      CHECK(found["verdict"] == (tangent < 0.3 ? "hold" : "open"));
    }
}

TEST_CASE("loads that come one after the other are not added") {
  Machine machine;
  const auto pushed = [](double start) {
    return "[[signal]]\nname = \"push\"\nkind = \"half_sine\"\npeak = " + std::to_string(0.25 * 20000 * k_g) +
           "\nstart = " + std::to_string(start) +
           "\nduration = 0.4\n[[element]]\nkind = \"load\"\nname = \"push\"\nat = { body = \"unit\", at = [0.0, 0.05] }\n"
           "force_x = \"push\"\n";
  };
  machine.along += pushed(0.05), machine.across += pushed(0.5);
  const Json one_after_the_other = machine.found("", "");
  // The feet spring at 50 Hz, which adds a little to the rigid block's 0.833.
  CHECK(use_of(one_after_the_other) == doctest::Approx(0.25 / 0.3).epsilon(0.01));
  CHECK(one_after_the_other["verdict"] == "hold");
  machine.across = machine.along;
  const Json at_once = machine.found("", "");
  CHECK(use_of(at_once) == doctest::Approx(0.25 * std::sqrt(2.0) / 0.3).epsilon(0.01));
  CHECK(at_once["verdict"] == "open");
}

TEST_CASE("what is known of one plane only leaves the case open") {
  Machine machine;
  machine.across.replace(machine.across.find("20000"), 5, "24000");
  const Json heavier = machine.found(pull(0.1), pull(0.1));
  CHECK(heavier["verdict"] == "open");
  CHECK(has(heavier["reason"], "carries"));
  Machine other_gravity;
  const Json less = other_gravity.found(pull(0.1), "set = [\"gravity=[0, -9.7]\"]");
  CHECK(less["verdict"] == "open");
  CHECK(has(less["reason"], "gravity is"));
}

TEST_CASE("a case of one plane is judged as it is without the other model") {
  const Machine machine;
  const std::string braking = load_case("braking", "lengthwise", pull(0.28));
  const std::string along = machine.bench.write("along.toml", machine.along + braking + load_case("corner", "lengthwise", pull(0.1)));
  const std::string across = machine.bench.write("across.toml", machine.across + load_case("corner", "transverse", pull(0.1)));
  const Json both = Json::parse(steplap_does({"cases", along, across, "--json"}).out)["results"][0]["load_cases"];
  const Json alone = Json::parse(steplap_does({"cases", along, "--json"}).out)["results"][0]["load_cases"];
  REQUIRE(both["cases"].size() == 3);
  CHECK(both["cases"][0].dump() == alone["cases"][0].dump());
  CHECK(both["verdict"] == "hold");
}

TEST_CASE("models that are not two planes of one machine are refused, with one error and its place") {
  const Workbench bench;
  const auto line = [](const std::string& text, const std::string& what) {
    const auto at = static_cast<std::ptrdiff_t>(text.find(what));
    return ":" + std::to_string(1 + std::count(text.begin(), text.begin() + at, '\n')) + ":";
  };
  const std::string along = bench.write("along.toml", k_block + k_feet + load_case("corner", "lengthwise", pull(0.1)));
  const std::string renamed = k_block + k_feet + load_case("Corner", "transverse", pull(0.1));
  std::string apart = k_block + k_feet + load_case("corner", "transverse", pull(0.1));
  apart.replace(apart.find("\"beams\""), 7, "\"rails\"");
  const std::string no_friction = k_block + load_case("corner", "transverse", pull(0.1));
  const std::string other = k_block + load_case("other", "transverse", pull(0.1)); // shares neither case nor friction
  const std::string same_plane = k_block + k_feet + load_case("corner", "lengthwise", pull(0.1));
  const std::string no_plane = k_block + k_feet + load_case("corner", "", pull(0.1));
  struct Wrong {
    std::string text, place, message;
  };
  for (const Wrong& wrong : {Wrong{renamed, "[[case]]", "no [[case]] has the name of one in"},
                             {apart, "[[element]]\nkind = \"coulomb_stick\"", "no friction has the name of one in"},
                             {no_friction, "[[case]]", "no friction has the name of one in"},
                             {other, "[[case]]", "no [[case]] has the name of one in"},
                             {same_plane, "plane = ", "has to be lengthwise in one of the models"},
                             {no_plane, "[[case]]", "has to be lengthwise in one of the models"},
                             {k_block + k_feet, "", "has no load cases"}}) {
    CAPTURE(wrong.message);
    const Outcome outcome = steplap_does({"cases", along, bench.write("wrong.toml", wrong.text)});
    CAPTURE(outcome.err);
    CHECK(outcome.code == 3);
    CHECK(has(outcome.err, wrong.message));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK(has(outcome.err, "wrong.toml" + (wrong.place.empty() ? "" : line(wrong.text, wrong.place))));
  }
  CHECK(steplap_does({"cases", along, along, along}).code == 2);
}

TEST_CASE("the sheet of two planes has both drawings and the digests of both models") {
  const Machine machine;
  const std::string sheet = machine.bench.at("sheet.html");
  REQUIRE(machine.does(pull(0.2), pull(0.2), {"-q", "-o", sheet}).code == 0);
  const std::string page = text_of(sheet);
  CHECK(has(page, "\"other_planes\""));
  CHECK(has(page, "along.toml"));
  CHECK(has(page, "across.toml"));
}
