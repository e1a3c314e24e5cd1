// Machines that were tried from an empty file, as far as something was found on them: against closed forms.
#include "tests/machines/written.h"
#include "tests/physics/model_text.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// A bed whose frame lies at its right end and whose centre of gravity in its middle; a crate on its right half.
std::string bed(bool is_fixed, const std::string& cg) {
  return "[simulation]\nend = 0.5\ntolerance = 1e-9\n" +
         body("bed", std::string(is_fixed ? "fixed = true; " : "mass = 1000.0; inertia = 3000.0; ") + "position = [3.0, 1.05]; cg = " + cg +
                         "; outline = [[-6.0, -0.05], [0.0, -0.05], [0.0, 0.05], [-6.0, 0.05]]") +
         body("crate",
              "mass = 500.0; inertia = 83.0; position = [2.0, 1.6]; outline = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]") +
         (is_fixed ? "" : element("weld", "held", "a = { body = 'bed', point = [0.0, 0.0] }; b = { body = 'ground', at = [3.0, 1.05] }")) +
         element("polygon_contact", "on bed", "a = 'crate'; b = 'bed'; stiffness = 5e7; dissipation = 1.0");
}

} // namespace

// Where the centre of gravity is says how a body moves, not where its outline is.
TEST_CASE("an outline lies in the body's frame, wherever the centre of gravity is") {
  // A face of 1 m on a bed: depth m g/(k w), with the share d/w of the closed form in polygon_contact_test.cpp left out.
  const double depth = 500.0 * k_g / 5e7;
  for (const bool is_fixed : {false, true})
    for (const std::string cg : {"[0.0, 0.0]", "[-3.0, 0.0]", "[-4.0, 0.02]"}) {
      CAPTURE(is_fixed);
      CAPTURE(cg);
      const Written model(bed(is_fixed, cg));
      const auto loaded = model.loaded();
      const Equilibrium rest = equilibrium_of(*loaded);
      CHECK(std::abs(at_rest(*loaded, rest, "crate.y") - (1.6 - depth)) < 2.0 * depth * depth); // d/w of the depth
      CHECK(std::abs(at_rest(*loaded, rest, "on bed.force") - 500.0 * k_g) < 1e-6 * 500.0 * k_g);
    }
  // Turned by a right angle a box stands on what was its side: frame at its corner, centre of gravity in its middle.
  const Written turned("[simulation]\nend = 0.1\n" +
                       body("box", "mass = 100.0; inertia = 10.0; position = [0.6, 0.0]; angle = 1.5707963267948966; cg = [0.5, 0.3]; "
                                   "outline = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.6], [0.0, 0.6]]") +
                       element("polygon_contact", "stand", "a = 'box'; stiffness = 1e8; static_friction = 0.5"));
  const Equilibrium rest = equilibrium_of(*turned.loaded());
  CHECK(std::abs(at_rest(*turned.loaded(), rest, "box.y") - (0.5 - 100.0 * k_g / (1e8 * 0.6))) < 1e-8);
  CHECK(std::abs(at_rest(*turned.loaded(), rest, "box.theta") - 1.5707963267948966) < 1e-9);
}

// Let down on a belt of 2 m/s a box slides for v/(μ g). Then it rocks on its compliance, at first with the friction that it
// slid with and the couple of that, less and less from there: friction is never again at its bound, however often the place
// that it is reckoned to act at changes.
TEST_CASE("a box on a belt slides once, and holds while it rocks") {
  const Written model(
      "[simulation]\nend = 1.5\ntolerance = 1e-9\n" +
      body("belt", "mass = 100.0; inertia = 100.0; position = [0.0, -0.05]; outline = [[-10.0, -0.05], [10.0, -0.05], [10.0, 0.05], "
                   "[-10.0, 0.05]]") +
      body("box",
           "mass = 10.0; inertia = 0.15; position = [0.0, 0.15]; outline = [[-0.15, -0.15], [0.15, -0.15], [0.15, 0.15], [-0.15, 0.15]]") +
      signal_entry("constant", "speed", "value = 2.0") + element("prismatic", "guide", "a = 'belt'") +
      element("prescribed_motion", "drive", "a = 'belt'; coordinate = 'x'; signal = 'speed'; as = 'velocity'") +
      element("polygon_contact", "c", "a = 'box'; b = 'belt'; stiffness = 1e8; dissipation = 2.0; static_friction = 0.4"));
  const Run run = run_model(model.loaded());
  REQUIRE_FALSE(run.failure);
  CHECK(count(run, "c", EventKind::changes_foot) > 10); // it does rock
  CHECK(count(run, "c", EventKind::slips_forward) == 0);
  CHECK(count(run, "c", EventKind::slips_backward) == 1);
  REQUIRE(count(run, "c", EventKind::sticks) == 1);
  const auto sticks =
      std::find_if(run.result.events.begin(), run.result.events.end(), [](const Event& e) { return e.kind == EventKind::sticks; });
  // The normal force swings about the weight as the contact closes, and the face rocks: some 1e-4 of the way each.
  CHECK(std::abs(sticks->t - 2.0 / (0.4 * k_g)) < 1e-3 * sticks->t);
}

// A ball with speed v and backspin ω slides until μ g t (1 + m r²/J) = v + ω r and rolls on by itself from there: friction
// is zero, exactly, and what rounding makes of zero must not keep a time step from its end.
TEST_CASE("time stepping: a ball that rolls on by itself takes no friction, and rolls on") {
  const double v = 6.0, spin = 20.0, r = 0.11, mu = 0.12;
  const Written model(
      "[simulation]\nend = 3.0\nintegrator = \"moreau\"\nstep = 1e-3\n[output]\nstep = 0.1\n" +
      body("ball", "mass = 6.0; inertia = 0.02904; position = [0.0, 0.109994114]; velocity = [6.0, 0.0]; angular_velocity = 20.0") +
      element("segment_contact", "lane",
              "a = 'ball'; radius = 0.11; from = [-1.0, 0.0]; to = [30.0, 0.0]; stiffness = 1e7; damping = 5e3") +
      element("coulomb_stick", "friction", "contacts = ['lane']; static_friction = 0.12"));
  const double until = (v + spin * r) / (3.5 * mu * k_g), rolls = v - mu * k_g * until;
  for (const double step : {2e-3, 5e-4, 1.25e-4}) {
    CAPTURE(step);
    const Run run = run_model(model.loaded({"simulation.step=" + number(step)}));
    CHECK_FALSE(run.failure);
    CHECK(std::abs(last(run, "ball.vx") - rolls) < mu * k_g * step); // of the first order
    REQUIRE(count(run, "friction", EventKind::sticks) == 1);
  }
}

// The weight m g turns a pinion of radius r on its rack with m g r; there is no couple on it but that.
TEST_CASE("what runs away is told with what drives it: a pinion on a rack by its weight") {
  const Written model("[simulation]\nend = 1.0\n" + body("yoyo", "mass = 0.06; inertia = 3e-5; position = [0.004, 0.0]") +
                      element("rack", "string", "a = 'yoyo'; radius = 0.004; axis = [0.0, -1.0]"));
  const Answer answer = steplap_does({"equilibrium", model.file.string()});
  CHECK(answer.code == 4);
  CAPTURE(answer.err);
  CHECK(has(answer.err, "nothing holds it against the 0.002354 N m")); // 0.06 · 9.81 · 0.004
}

// Atwood's machine has no rest: the heavier weight pulls the lighter one up to its pulley, where the rope has no direction.
TEST_CASE("a weight that is pulled up to its pulley is no rest") {
  const Written model("[simulation]\nend = 1.0\n" + body("heavy", "mass = 3.0; inertia = 0.1; position = [-0.2, -1.0]") +
                      body("light", "mass = 2.0; inertia = 0.1; position = [0.2, -1.0]") +
                      table_text("marker", "", "name = 'left'; body = 'ground'; at = [-0.2, 0.0]") +
                      table_text("marker", "", "name = 'right'; body = 'ground'; at = [0.2, 0.0]") +
                      element("rope", "rope", "a = 'heavy'; b = 'light'; over = ['left', 'right']; stiffness = 1e6; damping = 1e3"));
  for (const char* command : {"equilibrium", "modes"}) {
    const Answer answer = steplap_does({command, model.file.string()});
    CHECK(answer.code == 4);
    CAPTURE(answer.err);
    CHECK(has(answer.err, "no static equilibrium found"));
    CHECK(has(answer.err, "the force on 'light' has no direction"));
  }
}

// At a corner where two segments end both are as far from a circle as the corner itself: two springs side by side.
TEST_CASE("check warns of a corner at which two segments press on one circle") {
  const auto road = [](const std::string& kerb_from, const std::string& path_from, const std::string& path_to = "[9.0, 0.05]") {
    const std::string more = "; a = 'wheel'; radius = 0.2; stiffness = 2e5";
    return "[simulation]\nend = 0.01\n" + body("wheel", "mass = 20.0; inertia = 0.4; position = [0.0, 0.2]; velocity = [1.0, 0.0]") +
           element("segment_contact", "road", "from = [-8.0, 0.0]; to = [1.0, 0.0]" + more) +
           element("segment_contact", "kerb", "from = " + kerb_from + "; to = [1.0, 0.05]" + more) +
           element("segment_contact", "path", "from = " + path_from + "; to = " + path_to + more);
  };
  const Written doubled(road("[1.0, 0.0]", "[1.0, 0.05]"));
  const Answer warned = steplap_does({"check", doubled.file.string()});
  CAPTURE(warned.out);
  CHECK(has(warned.out, "segment_contacts 'kerb' and 'path' end at "));
  CHECK(has(warned.out, "20 mm for a depth of 1 mm")); // sqrt(2 · 0.2 m · 1 mm)
  CHECK_FALSE(has(warned.out, "'road' and 'kerb'"));   // in an inner corner a circle touches two sides
  const Written apart(road("[1.0, 0.0]", "[1.05, 0.05]"));
  CHECK_FALSE(has(steplap_does({"check", apart.file.string()}).out, "end at the same point"));
  const Written straight(road("[0.9, -0.3]", "[1.0, 0.0]", "[9.0, 0.0]")); // and where they lie in line with each other
  CHECK(has(steplap_does({"check", straight.file.string()}).out, "'road' and 'path'"));
}

// A trolley that is driven with 0.5 m/s² from the start: where it rests with its drive held the drive takes nothing.
TEST_CASE("at rest a drive is held, and takes what holding takes") {
  const auto crane = [](const std::string& slope) {
    return "[simulation]\nend = 1.0\n" + body("trolley", "mass = 500.0; inertia = 50.0; position = [0.0, 8.0]") +
           body("load", "mass = 2000.0; inertia = 500.0; position = [0.0, 3.0]") +
           element("prismatic", "rail", "a = 'trolley'; axis = " + slope) +
           signal_entry("rectangle", "pulse", "peak = 0.5; duration = 2.0") +
           element("prescribed_motion", "travel", "a = 'trolley'; coordinate = 'x'; signal = 'pulse'") +
           element("distance", "hoist", "a = 'load'; b = 'trolley'");
  };
  const Written level(crane("[1.0, 0.0]"));
  Answer answer = steplap_does({"equilibrium", level.file.string()});
  CAPTURE(answer.out);
  CHECK(answer.code == 0);
  const auto reaction = [&answer] {
    const std::size_t at = answer.out.find("travel.reaction");
    return answer.out.substr(at + 15, answer.out.find('\n', at) - at - 15);
  };
  CHECK(has(reaction(), " 0 N"));
  // On a rail at 45° the drive's x takes all that would go down it: (m + M) g.
  const Written steep(crane("[1.0, 1.0]"));
  answer = steplap_does({"equilibrium", steep.file.string()});
  CHECK(has(reaction(), " 24.525 kN"));
}

// A signal made of another one has no values of its own before it is built.
TEST_CASE("check: a machine at rest that a signal made of others is to move") {
  for (const std::string& kind : {std::string("scaled"), std::string("sum"), std::string("product")}) {
    const std::string parts = kind == "scaled" ? "signal = 'pull'; factor = -1.0" : "signals = ['pull', 'pull']";
    const Written model("gravity = [0.0, 0.0]\n[simulation]\nend = 1.0\n" + body("drum", "mass = 30.0; inertia = 0.6") +
                        element("revolute", "axle", "a = 'drum'") +
                        signal_entry("trapezoid", "pull", "peak = 1500.0; start = 0.2; duration = 10.0; rise = 0.2; fall = 0.2") +
                        signal_entry(kind, "push", parts) + element("load", "cam", "at = 'drum'; torque = 'push'"));
    const Answer answer = steplap_does({"check", model.file.string()});
    CHECK(answer.code == 0);
    CHECK_FALSE(has(answer.out, "not in equilibrium"));
  }
}

// An arm on a pin, given at one of its stops at whatever angle: digits of sines and cosines leave its angle on either
// side of the stop. Its weight presses it on, and nothing has been reached; or it leads away from there, and it leaves
// its stop.
TEST_CASE("what is given at its stop begins in touch with it, whatever its last digits") {
  for (int i = 0; i < 24; ++i) {
    const double angle = -1.4 + 0.117 * i, x = 0.5 * std::cos(angle),
                 y = 0.5 * std::sin(angle); // to the right of its pin: it turns clockwise
    for (const bool is_pressed : {true, false}) {
      CAPTURE(angle);
      CAPTURE(is_pressed);
      const Written model(
          "[simulation]\nend = 0.05\n[output]\nstep = 0.01\n" +
          body("arm", "mass = 2.0; inertia = 0.2; position = [" + number(x) + ", " + number(y) + "]; angle = " + number(angle)) +
          element("revolute", "pin", "a = { body = 'arm', point = [-0.5, 0.0] }; b = { body = 'ground', at = [0.0, 0.0] }") +
          element("limit", "stop",
                  "a = 'arm'; stiffness = 1e6; damping = 100.0; " + std::string(is_pressed ? "lower = 0.0" : "upper = 0.0")));
      const Run run = run_model(model.loaded());
      REQUIRE_FALSE(run.failure);
      CHECK(count(run, "stop", EventKind::reaches_lower_stop) == 0);
      CHECK(count(run, "stop", EventKind::reaches_upper_stop) == 0);
      CHECK(count(run, "stop", EventKind::leaves_stop) == (is_pressed ? 0 : 1));
      // The angle that it is moved by, 4e-12, and the couple of that.
      if (is_pressed) CHECK(last(run, "stop.couple") > 0.0);
      else CHECK(last(run, "stop.couple") == 0.0);
    }
  }
  // A load that hangs with its slack just taken up by a stop of its distance, typed to twelve digits; and one that is
  // not there yet.
  for (const std::string upper : {"1.11803398875", "1.2"}) {
    const Written model("[simulation]\nend = 0.05\n[output]\nstep = 0.01\n" +
                        body("load", "mass = 2.0; inertia = 0.2; position = [0.5, -1.0]") +
                        element("limit", "stop", "a = 'load'; coordinate = 'distance'; stiffness = 1e6; upper = " + upper));
    const Run run = run_model(model.loaded());
    REQUIRE_FALSE(run.failure);
    CHECK(count(run, "stop", EventKind::reaches_upper_stop) == 0);
    CHECK((last(run, "stop.force") < 0.0) == (upper != "1.2"));
  }
}
