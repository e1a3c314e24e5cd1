// More machines that were tried from an empty file, as far as something was found on them: drives, units, friction
// groups.
#include "tests/machines/written.h"
#include "tests/physics/model_text.h"

#include "mbd/model/model_path.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

double number_in(const LoadedModel& loaded, const std::string& path) { return std::get<double>(value_of(loaded.model, path)); }

// A door on a hinge and a drawer on a rail, with one element on either.
std::string door_and_drawer(const std::string& more) {
  return "[simulation]\nend = 0.1\n" + body("door", "mass = 10.0; inertia = 1.0; position = [0.5, 0.0]") +
         body("drawer", "mass = 5.0; inertia = 0.1; position = [0.0, 1.0]") +
         element("revolute", "hinge", "a = { body = 'door', at = [0.0, 0.0] }") + element("prismatic", "rail", "a = 'drawer'") + more;
}

Answer checked(const std::string& text) {
  const Written model(text);
  return steplap_does({"check", model.file.string()});
}

} // namespace

// J ω' = M − |M| ω/n₀ from rest: ω = ±n₀ (1 − exp(−|M| t/(n₀ J))).
TEST_CASE("a motor in reverse comes to its no-load speed as it does forwards") {
  const double no_load = 100.0, effort = 5.0, inertia = 0.1, end = 5.0;
  const double expected = no_load * (1.0 - std::exp(-effort * end / (no_load * inertia)));
  const auto rotor = [](const std::string& effort_text) {
    return k_no_gravity + "[simulation]\nend = 5.0\ntolerance = 1e-10\n" + body("rotor", "mass = 1.0; inertia = 0.1") +
           element("revolute", "bearing", "a = 'rotor'") + signal_entry("constant", "back", "value = -5.0") +
           element("motor", "motor", "a = 'rotor'; no_load_speed = 100.0; " + effort_text);
  };
  for (const auto& [text, sign] :
       {std::pair("constant_effort = 5.0", 1.0), std::pair("constant_effort = -5.0", -1.0), std::pair("effort = 'back'", -1.0)}) {
    CAPTURE(text);
    const Written model(rotor(text));
    CHECK(std::abs(last(run_model(model.loaded()), "rotor.omega") - sign * expected) < 1e-8 * no_load); // a hundred tolerances
  }
  for (const std::string speed : {"0.0", "-100.0"}) {
    const Answer answer = checked(door_and_drawer(element("motor", "m", "a = 'door'; constant_effort = -5.0; no_load_speed = " + speed)));
    CHECK(answer.code == 3);
    CHECK(has(answer.err, "'no_load_speed' of motor 'm' must be greater than 0, got "));
  }
}

TEST_CASE("numbers that hang on an element's coordinate take units, wherever the coordinate stands") {
  const Written model(door_and_drawer(
      element("motor", "turns",
              "a = 'door'; constant_effort = '0.2 kN m'; no_load_speed = '3000 rpm'; proportional = '1 N m/deg'; "
              "derivative = '2 kN m s'") +
      element("motor", "pulls", "constant_effort = '0.2 kN'; no_load_speed = '36 km/h'; a = 'drawer'; coordinate = 'x'") +
      element("limit", "swing", "a = 'door'; lower = '-30 deg'; upper = 0.5; stiffness = '3 kN m/rad'") +
      element("limit", "way", "lower = '-30 mm'; stiffness = '3 kN/m'; damping = '5 N s/m'; coordinate = 'x'; a = 'drawer'") +
      element("joint_friction", "packing", "a = 'door'; holds = '20 N m'; drags = '1.5 kgf m'") +
      element("joint_friction", "felt", "a = 'drawer'; holds = '2 kN'; coordinate = 'x'")));
  const auto loaded = model.loaded();
  const double degree = std::numbers::pi / 180.0;
  // Each is the unit's factor by definition; 1e-14: rounding of the conversions.
  for (const auto& [path, expected] :
       {std::pair("element.turns.constant_effort", 200.0), std::pair("element.turns.no_load_speed", 100.0 * std::numbers::pi),
        std::pair("element.turns.proportional", 1.0 / degree), std::pair("element.turns.derivative", 2000.0),
        std::pair("element.pulls.constant_effort", 200.0), std::pair("element.pulls.no_load_speed", 10.0),
        std::pair("element.swing.lower", -30.0 * degree), std::pair("element.swing.upper", 0.5),
        std::pair("element.swing.stiffness", 3000.0), std::pair("element.way.lower", -0.03), std::pair("element.way.stiffness", 3000.0),
        std::pair("element.way.damping", 5.0), std::pair("element.packing.holds", 20.0), std::pair("element.packing.drags", 1.5 * 9.80665),
        std::pair("element.felt.holds", 2000.0)}) {
    CAPTURE(path);
    CHECK(std::abs(number_in(*loaded, path) - expected) < 1e-14 * std::abs(expected));
  }
  CHECK(unit_of(loaded->model, "element.swing.lower") == "rad");
  CHECK(unit_of(loaded->model, "element.way.lower") == "m");
  CHECK(number_in(*model.loaded({"element.way.lower=-3 cm"}), "element.way.lower") == doctest::Approx(-0.03).epsilon(1e-14));
  for (const auto& [kind, fields, problem] :
       {std::tuple("limit", "a = 'drawer'; coordinate = 'x'; upper = '0.5 rad'; stiffness = 1e4",
                   "'0.5 rad' has the unit 'rad', but a unit like 'm' is needed"),
        std::tuple("limit", "a = 'door'; upper = '3 mm'; stiffness = 1e4", "'3 mm' has the unit 'mm', but a unit like 'rad' is needed"),
        std::tuple("joint_friction", "a = 'door'; holds = '20 N'", "'20 N' has the unit 'N', but a unit like 'N m' is needed"),
        std::tuple("motor", "a = 'door'; constant_effort = 1.0; no_load_speed = '50 Hz'",
                   "is a frequency, but an angular velocity is needed")}) {
    const Answer answer = checked(door_and_drawer(element(kind, "e", fields)));
    CAPTURE(answer.err);
    CHECK(answer.code == 3);
    CHECK(has(answer.err, problem));
  }
}

TEST_CASE("a signal whose values have a unit is taken for nothing else") {
  const std::string signals =
      signal_entry("haversine", "shove", "peak = '0.5 gravity'; duration = 0.1") +
      signal_entry("harmonics", "roll", "amplitudes = ['20 deg']; frequencies = [0.1]; phases = ['-90 deg']") +
      signal_entry("scaled", "later", "signal = 'shove'; delay = 0.02") +
      signal_entry("scaled", "as force", "signal = 'shove'; factor = 40e3") + signal_entry("sum", "both", "signals = ['shove', 'later']") +
      signal_entry("product", "mixed", "signals = ['shove', 'roll']") + signal_entry("constant", "plain", "value = 3.0");
  const auto answer_to = [&signals](const std::string& more) { return checked(door_and_drawer(signals + more)); };
  for (const auto& [kind, fields, problem] :
       {std::tuple("load", "at = 'door'; force_y = 'shove'",
                   "'force_y' of load 'e': its signal 'shove' (line 24): '0.5 gravity' has the unit 'gravity', but a "
                   "unit like 'N' is needed"),
        std::tuple("load", "at = 'door'; torque = 'later'", "'torque' of load 'e': its signal 'shove' (line 24): "),
        std::tuple("load", "at = 'door'; force_x = 'both'", "'force_x' of load 'e': its signal 'shove' (line 24): "),
        std::tuple("prescribed_motion", "a = 'drawer'; signal = 'roll'; as = 'position'",
                   "'20 deg' has the unit 'deg', but a unit like 'm' is needed"),
        std::tuple("prescribed_motion", "a = 'drawer'; signal = 'shove'; as = 'velocity'", "but a unit like 'm/s' is needed"),
        std::tuple("motor", "a = 'door'; effort = 'shove'", "but a unit like 'N m' is needed")}) {
    const Answer answer = answer_to(element(kind, "e", fields));
    CAPTURE(fields);
    CAPTURE(answer.err);
    CHECK(answer.code == 3);
    CHECK(has(answer.err, problem));
  }
  // What fits, and what nothing is known of.
  for (const auto& [kind, fields] :
       {std::pair("prescribed_motion", "a = 'drawer'; signal = 'both'"),
        std::pair("prescribed_motion", "a = 'door'; coordinate = 'angle'; signal = 'roll'; as = 'position'; zero = 'reference'"),
        std::pair("load", "at = 'door'; force_x = 'as force'"), std::pair("load", "at = 'door'; force_x = 'mixed'; torque = 'plain'"),
        std::pair("motor", "a = 'door'; target = 'roll'; proportional = 5.0")}) {
    const Answer answer = answer_to(element(kind, "e", fields));
    CAPTURE(fields);
    CAPTURE(answer.err);
    CHECK(answer.code == 0);
  }
}

TEST_CASE("the unit in the header of a record is that of its signal") {
  const auto answer_to = [](const std::string& column, const std::string& kind, const std::string& fields, const std::string& more = "") {
    const Written table("time [ms];a [g];v [km/h];f [kN];plain;p [bar]\n0;0;0;0;0;0\n100;0,1;5;2;1;3\n");
    return checked(door_and_drawer(signal_entry("record", "r", "file = '" + table.file.string() + "'; column = '" + column + "'" + more) +
                                   signal_entry("scaled", "delayed", "signal = 'r'; delay = 0.01") + element(kind, "e", fields)));
  };
  const std::string drive = "a = 'drawer'; signal = 'delayed'; as = ";
  const Answer answer = answer_to("v", "prescribed_motion", drive + "'acceleration'");
  CAPTURE(answer.err);
  CHECK(answer.code == 3);
  CHECK(has(answer.err, "its signal 'r' is in km/h by the header of its file: '1 km/h' has the unit 'km/h', but a unit like 'm/s^2'"));
  CHECK(has(answer_to("3", "prescribed_motion", drive + "'acceleration'").err, "is in km/h by the header"));
  CHECK(has(answer_to("a", "prescribed_motion", drive + "'velocity'").err, "is in gravity by the header"));
  CHECK(has(answer_to("f", "motor", "a = 'door'; effort = 'r'").err, "is in kN by the header"));
  CHECK(answer_to("v", "prescribed_motion", drive + "'velocity'").code == 0);
  CHECK(answer_to("a", "prescribed_motion", drive + "'acceleration'").code == 0);
  CHECK(answer_to("f", "load", "at = 'door'; force_x = 'r'").code == 0);
  CHECK(answer_to("plain", "load", "at = 'door'; force_x = 'r'").code == 0);

  const std::string brake = "a = 'door'; holds = 10.0; signal = 'r'"; // a factor
  CHECK(has(answer_to("p", "joint_friction", brake).err, "is in bar by the header of its file: '1 bar' has the unit 'bar'"));
  CHECK(has(answer_to("plain", "joint_friction", brake, "; unit = 'bar'").err, "has the unit 'bar', but the value has no dimension"));
  CHECK(answer_to("plain", "joint_friction", brake).code == 0);
}

// What bears friction twice would bear twice as much; friction of lines at different heights has no common lever.
TEST_CASE("contacts that cannot share one friction are refused, or told") {
  const auto foot = [](const std::string& name, const std::string& at, const std::string& more = "") {
    return element("unilateral_contact", name,
                   "a = { body = 'box', at = " + at + " }; b = { body = 'ground', at = " + at + " }; stiffness = 1e6" + more);
  };
  const std::string box = "[simulation]\nend = 0.1\n" + body("box", "mass = 10.0; inertia = 1.0; position = [0.0, 0.5]") +
                          foot("rear", "[-0.4, 0.0]") + foot("front", "[0.4, 0.0]");
  const auto stick = [](const std::string& name, const std::string& contacts) {
    return element("coulomb_stick", name, "contacts = [" + contacts + "]; static_friction = 0.3");
  };
  Answer answer = checked(box + stick("both", "'rear', 'front'") + stick("again", "'front'"));
  CHECK(answer.code == 3);
  CHECK(has(answer.err, "coulomb_stick 'again': 'front' stands in 'contacts' here and in those of 'both'"));
  answer = checked(box + stick("both", "'rear', 'front', 'rear'"));
  CHECK(answer.code == 3);
  CHECK(has(answer.err, "'rear' stands in 'contacts' twice"));
  CHECK(checked(box + stick("one", "'rear'") + stick("other", "'front'")).code == 0);
  // A load on deck and gooseneck: 0.3 m between the two lines, 0.8 m from foot to foot.
  const auto warned = [&answer] { return has(answer.out, "touch on lines 0.3 m apart, but their friction acts on one of them"); };
  answer = checked(box + foot("neck", "[0.4, 0.3]") + stick("both", "'rear', 'neck'"));
  CHECK(warned());
  answer = checked(box + foot("neck", "[0.4, 0.3]", "; gap = 0.0") + stick("both", "'rear', 'neck'"));
  CHECK(warned());
  answer = checked(box + foot("neck", "[0.4, 0.3]") + stick("below", "'rear'") + stick("above", "'neck'"));
  CHECK_FALSE(has(answer.out, "touch on lines"));
  // Feet of one line of which one begins 4 mm above it do share.
  const std::string lifted = element("unilateral_contact", "lifted", "a = { body = 'box', at = [0.3, 0.004] }; stiffness = 1e6");
  CHECK_FALSE(has(checked(box + lifted + stick("both", "'rear', 'lifted'")).out, "touch on lines"));
}

TEST_CASE("what would turn or pull the wrong way is refused, what acts on nothing is said") {
  const auto rack = [](const std::string& axis) {
    return door_and_drawer(element("rack", "rack", "a = 'drawer'; b = { body = 'door', at = [0.5, 0.0] }; radius = 1.0; axis = " + axis));
  };
  CHECK(checked(rack("[1.0, 0.0]")).code == 0);
  Answer answer = checked(rack("[-1.0, 0.0]"));
  CHECK(answer.code == 3);
  CHECK(has(answer.err, "its pinion is on the right of 'axis'"));
  answer = checked(door_and_drawer(element("spring_damper", "s", "a = 'drawer'; stiffness = 10.0; free_length = -0.5")));
  CHECK(answer.code == 3);
  CHECK(has(answer.err, "'free_length' must not be negative from point to point"));
  CHECK(checked(door_and_drawer(element("spring_damper", "s", "a = 'drawer'; stiffness = 10.0; free_length = -0.5; axis = [1.0, 0.0]")))
            .code == 0);
  answer = checked(
      door_and_drawer(element("spring_damper", "s", "a = 'drawer'; b = { body = 'drawer', point = [0.1, 0.0] }; stiffness = 10.0")));
  CHECK(answer.code == 0);
  CHECK(has(answer.out, "warning: spring_damper 's' acts between two places of 'drawer': it moves nothing ("));
}

// On inclines of 40° and 25°, mu = 0.15, 30 kg pull 20 kg over the peak with 0.92 m/s²: there is no rest, whatever is
// tried on the way.
TEST_CASE("two sleds over a peak: no rest, and which one goes on") {
  const double left = 40.0 * std::numbers::pi / 180.0, right = 25.0 * std::numbers::pi / 180.0, mu = 0.15;
  std::string text = "[simulation]\nend = 1.0\ntolerance = 1e-9\n[output]\nstep = 0.1\n";
  const auto sled = [&text](const std::string& name, double mass, double angle, double side, double down) {
    const double x = side * (down * std::cos(angle) + 0.1 * std::sin(angle)), y = -down * std::sin(angle) + 0.1 * std::cos(angle);
    text += body(name, "mass = " + number(mass) + "; inertia = 1.0; position = [" + number(x) + ", " + number(y) +
                           "]; angle = " + number(-side * angle));
    for (const double foot : {-0.3, 0.3})
      text += element("unilateral_contact", name + (foot < 0.0 ? " rear" : " front"),
                      "a = { body = '" + name + "', point = [" + number(foot) + ", -0.1] }; normal = [" + number(side * std::sin(angle)) +
                          ", " + number(std::cos(angle)) +
                          "]; stiffness = 1e8; damping = 1e4; preload = " + number(0.5 * mass * k_g * std::cos(angle)));
    text += element("coulomb_stick", name + " friction", "contacts = ['" + name + " rear', '" + name + " front']; static_friction = 0.15");
    text += table_text("marker", "",
                       "name = '" + name + " sheave'; body = 'ground'; at = [" + number(side * 0.1 * std::sin(angle)) + ", " +
                           number(0.1 * std::cos(angle)) + "]");
  };
  sled("left", 30.0, left, -1.0, 2.0);
  sled("right", 20.0, right, 1.0, 3.0);
  const Written model(text +
                      element("rope", "rope", "a = 'left'; b = 'right'; over = ['left sheave', 'right sheave']; inextensible = true"));
  const Answer answer = steplap_does({"equilibrium", model.file.string()});
  CHECK(answer.code == 4);
  CAPTURE(answer.err);
  CHECK(has(answer.err, "no static equilibrium"));
  CHECK_FALSE(has(answer.err, "cannot be met"));
  const double a = k_g * (30.0 * std::sin(left) - 20.0 * std::sin(right) - mu * (30.0 * std::cos(left) + 20.0 * std::cos(right))) / 50.0;
  const Run run = run_model(model.loaded());
  CHECK(std::abs(last(run, "left.x") + (2.0 + 0.5 * a) * std::cos(left) + 0.1 * std::sin(left)) <
        1e-7); // 1e-9 a step, and the contacts' rounding
  CHECK(std::abs(last(run, "rope.tension") - 30.0 * (k_g * std::sin(left) - mu * k_g * std::cos(left) - a)) < 1e-4);
}

// The lever is pinned by its middle, given 0.1 m beside the pin: the heavy pan has to follow, turning by some 0.2 rad.
TEST_CASE("a light lever under a heavy pan is assembled, whatever their masses") {
  for (const double lighter : {1.0, 1e-2, 1e-3, 1e-5}) {
    CAPTURE(lighter);
    const std::string light = "mass = " + number(lighter) + "; inertia = " + number(lighter);
    const Written model("[simulation]\nend = 0.1\n" + body("lever", light) +
                        body("pan", "mass = 100.0; inertia = 1.0; position = [0.0, -0.5]") +
                        element("revolute", "fulcrum", "a = 'lever'; b = { body = 'ground', at = [0.1, 0.0] }") +
                        element("revolute", "hook", "a = { body = 'pan', at = [0.0, 0.0] }; b = { body = 'lever', at = [0.0, 0.0] }"));
    const auto loaded = model.loaded();
    const std::vector<double>& q = loaded->assembled.q; // three of the ground, of the lever, of the pan
    CHECK(std::abs(q[3] - 0.1) < 1e-11);
    CHECK(std::abs(q[6] - 0.5 * std::sin(q[8]) - 0.1) < 1e-11);
    CHECK(std::abs(q[7] + 0.5 * std::cos(q[8])) < 1e-11);
  }
}

// At rest methods differ by rounding, which is not to be measured by the range of rounding.
TEST_CASE("check --cross: methods agree on a box that stands") {
  const Written model("gravity = ['0.3 gravity', '-1 gravity']\n[simulation]\nend = 0.2\ninitial = \"equilibrium\"\n" +
                      body("cabinet", "mass = 300.0; inertia = 100.0; position = [0.0, 1.0]; "
                                      "outline = [[-0.4, -1.0], [0.4, -1.0], [0.4, 1.0], [-0.4, 1.0]]") +
                      element("polygon_contact", "floor", "a = 'cabinet'; stiffness = 1e9; static_friction = 0.5; dissipation = 1.0"));
  const Answer answer = steplap_does({"check", "--cross", model.file.string()});
  CAPTURE(answer.out);
  CHECK(answer.code == 0);
  CHECK(has(answer.out, "all agree"));
}
