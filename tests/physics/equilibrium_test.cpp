// Rest found from far away: closed forms, all models that have a rest, friction's limits, and what is said where there
// is none.
#include "tests/physics/rest_scene.h"

#include <cmath>
#include <cstdio>
#include <doctest/doctest.h>
#include <numbers>
#include <utility>

using namespace steplap;
using namespace steplap::testing;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("all models that have a rest are found to have one") {
  for (const char* name : {"benchmarks/double_pendulum", "benchmarks/chain_10", "benchmarks/slider_crank", "benchmarks/robot_arm",
                           "benchmarks/rocking_block", "benchmarks/four_bar_2", "benchmarks/andrews", "layouts/rail_wagon_humping"}) {
    CAPTURE(std::string(name));
    const Model model = read_model(std::string(STEPLAP_MODELS) + "/" + name + ".toml", transformer_catalog());
    const Found found = settle(model);
    CHECK(found.rest.iterations < 100);
    // Forces are sums of terms k δ: springs of 1e10 N/m of andrews' order and parts of grams leave 1e-8 m/s² of rounding.
    CHECK(found.rest.residual < 1e-8);
    // Nowhere does the machine rest higher than it began.
    std::vector<Motion<double>> before, after;
    const State start = assemble(model, *found.system);
    place_bodies(start.q, start.v, before);
    place_bodies(found.rest.state.q, start.v, after);
    const double scale = std::abs(found.system->potential_energy(before.data()));
    if (std::string(name) != "benchmarks/andrews" && std::string(name) != "benchmarks/robot_arm") // loads and motors have no potential
      CHECK(found.system->potential_energy(after.data()) <= found.system->potential_energy(before.data()) + 1e-12 * scale);
  }
}

TEST_CASE("a double pendulum and a chain hang straight down, from the horizontal") {
  for (const char* name : {"double_pendulum", "chain_10"}) {
    const Model model = read_model(std::string(STEPLAP_MODELS) + "/benchmarks/" + name + ".toml", transformer_catalog());
    const Found found = settle(model);
    for (int i = 1; i < found.system->body_count(); ++i) { // Newton's last step leaves rounding of 10 m
      CHECK(std::abs(found.rest.state.q[3 * i]) < 1e-12);
      CHECK(std::abs(found.rest.state.q[3 * i + 1] + (i - 0.5)) < 1e-12);
    }
  }
}

// Rod i of n, each of weight w and length l, between supports at one height: the ends' forces are H along x and
// V_i = (i − (n − 1)/2) w across at its middle, so tan φ_i = V_i/H; H follows from the span Σ l cos φ_i.
TEST_CASE("a chain of n rods between two supports takes the catenary's shape") {
  for (const int n : {3, 8, 16})
    for (const bool is_arch : {false, true}) { // from its mirror image, which balances but does not hold
      CAPTURE(n);
      CAPTURE(is_arch);
      const double span = 0.7 * n, w = 2.0 * k_g;
      const auto width = [&](double h) {
        double sum = 0.0;
        for (int i = 0; i < n; ++i) sum += 1.0 / std::hypot(1.0, (i - 0.5 * (n - 1)) * w / h);
        return sum;
      };
      double low = 1e-3, high = 1e6;
      for (int i = 0; i < 200; ++i) (width(0.5 * (low + high)) < span ? low : high) = 0.5 * (low + high);
      std::vector<double> angle, x, y;
      double px = 0.0, py = 0.0;
      for (int i = 0; i < n; ++i) {
        angle.push_back(std::atan((i - 0.5 * (n - 1)) * w / low));
        x.push_back(px + 0.5 * std::cos(angle[i]));
        y.push_back(py + 0.5 * std::sin(angle[i]));
        px += std::cos(angle[i]);
        py += std::sin(angle[i]);
      }
      std::string text;
      // The other start: a roof, which does not balance.
      const double roof = std::acos(0.7);
      for (int i = 0; i < n; ++i) {
        const std::string name = "rod " + std::to_string(i);
        const double tilt = is_arch ? -angle[i] : (i < n / 2 ? roof : i >= n - n / 2 ? -roof : 0.0);
        const double cx = is_arch ? x[i] : 0.7 * (i + 0.5), cy = is_arch ? -y[i] : std::min(i + 0.5, n - i - 0.5) * std::sin(roof);
        text += body(name, "mass = 2; inertia = 0.16666666666666666; position = " + point(cx, cy) + "; angle = " + number(tilt)) +
                element("revolute", "pin " + std::to_string(i),
                        "a = { body = '" + name + "', point = [-0.5, 0.0] }; b = " +
                            (i == 0 ? "{ body = 'ground', point = [0.0, 0.0] }"
                                    : "{ body = 'rod " + std::to_string(i - 1) + "', point = [0.5, 0.0] }"));
      }
      text += element("revolute", "end",
                      "a = { body = 'rod " + std::to_string(n - 1) +
                          "', point = [0.5, 0.0] }; b = { body = 'ground', point = " + point(span, 0.0) + " }");
      for (char& c : text)
        if (c == '\'') c = '"';
      const Found found = settle(text);
      if (is_arch) CHECK_FALSE(found.rest.left.empty());
      for (int i = 0; i < n; ++i) { // rounding of 11 m, through n joints
        CHECK(std::abs(found.rest.state.q[3 * i + 3] - x[i]) < 1e-11);
        CHECK(std::abs(found.rest.state.q[3 * i + 4] - y[i]) < 1e-11);
        CHECK(std::abs(found.rest.state.q[3 * i + 5] - angle[i]) < 1e-11);
      }
    }
}

// A boom on a servo K (θ₀ − θ) carries a load on a rod at its tip: K (θ₀ − θ) = (m_b L/2 + m L) g cos θ, and the load
// hangs below the tip.
TEST_CASE("a crane arm gives way to its load, which swings down from anywhere") {
  const double k = 4e4, boom = 300.0, load = 500.0, length = 3.0, start = 0.6;
  double theta = start;
  for (int i = 0; i < 100; ++i) {
    const double arm = (0.5 * boom + load) * length * k_g;
    theta -= (k * (theta - start) + arm * std::cos(theta)) / (k - arm * std::sin(theta));
  }
  for (const double swung : {0.0, 1.5, -3.0}) {
    CAPTURE(swung);
    const double tx = length * std::cos(start), ty = length * std::sin(start);
    const Found found =
        settle(body("boom", "mass = 300; inertia = 225; position = " + point(0.5 * tx, 0.5 * ty) + "; angle = " + number(start)) +
               body("load", "mass = 500; inertia = 40; position = " + point(tx + 2.0 * std::sin(swung), ty - 2.0 * std::cos(swung))) +
               element("revolute", "foot", "a = { body = \"boom\", point = [-1.5, 0.0] }") +
               element("motor", "servo", "a = \"boom\"; coordinate = \"angle\"; proportional = 4e4; derivative = 100.0") +
               element("distance", "hoist", "a = \"load\"; b = { body = \"boom\", point = [1.5, 0.0] }; length = 2.0"));
    CHECK(std::abs(found.rest.state.q[5] - theta) < 1e-12); // rounding of a radian
    CHECK(std::abs(found.rest.state.q[6] - length * std::cos(theta)) < 1e-11);
    CHECK(std::abs(found.rest.state.q[7] - length * std::sin(theta) + 2.0) < 1e-11);
    REQUIRE(found.rest.indifferent.size() == 1); // the load's angle: a rod at its centre does not hold it
    CHECK(found.rest.indifferent[0].body == 2);
    CHECK(found.rest.indifferent[0].coordinate == 2);
  }
}

// A tank on four springs, led sideways by a bushing, with a lid that hangs on a pin at its side. With the tank level but
// for small angles: 4 k δ = (M + m) g, and the lid hangs straight down.
TEST_CASE("a tank on four springs with a bushing and a hanging lid settles") {
  const double m_tank = 4000.0, m_lid = 200.0, k = 2e6;
  std::string text =
      body("tank", "mass = 4000; inertia = 3000; position = [0.0, 1.0]") + body("lid", "mass = 200; inertia = 20; position = [1.9, 1.7]") +
      element("revolute", "hinge", "a = { body = \"lid\", point = [-0.7, 0.0] }; b = { body = \"tank\", point = [1.2, 0.7] }") +
      element("bushing", "guide",
              "a = { body = \"tank\", point = [0.0, 0.0] }; b = { body = \"ground\", at = [0.0, 1.0] }; "
              "stiffness = [1e6, 0.0]; damping = [1e3, 0.0]; rotational_stiffness = 3e8");
  for (const double at : {-1.5, -0.5, 0.5, 1.5})
    text += element("spring_damper", "spring " + number(at),
                    "a = { body = \"tank\", point = [" + number(at) + ", -1.0] }; b = { body = \"ground\", at = [" + number(at) +
                        ", 0.0] }; axis = [0.0, 1.0]; stiffness = 2e6; damping = 1e4; free_length = 0.0");
  const Found found = settle(text);
  const double* tank = &found.rest.state.q[3];
  // The lid's weight turns the tank by m g x/(Σ k x² + K) about 7e-6 rad: its square and δ/L ≈ 3e-3 of it are left out.
  const double turn = -m_lid * k_g * 1.2 / (k * (2.0 * 2.25 + 2.0 * 0.25) + 3e8);
  CHECK(std::abs(tank[2] - turn) < 1e-2 * std::abs(turn));
  CHECK(std::abs(tank[1] - 1.0 + (m_tank + m_lid) * k_g / (4.0 * k)) < 1e-9);
  CHECK(std::abs(std::remainder(found.rest.state.q[8] + 0.5 * k_pi, 2.0 * k_pi)) < 1e-11);
}

// A ladder at 60° between floor and wall of one friction: it holds from μ = tan(45° − 60°/2) on, since with forces at
// both borders tan 60° = (1 − μ²)/(2 μ); with more friction it uses that share of it.
TEST_CASE("a ladder holds from the friction of the closed form on, however it was loaded") {
  const double limit = std::tan(0.25 * k_pi - k_pi / 6.0), half = 2.0, x = half * 0.5, y = half * std::sin(k_pi / 3.0);
  const auto ladder = [&](double friction, const std::string& start) {
    std::string text = body("ladder", "mass = 20; inertia = 26.666666666666668; position = " + point(x, y));
    const auto end = [&](const std::string& name, double ex, double ey, const std::string& normal) {
      return element("unilateral_contact", name,
                     "a = { body = \"ladder\", point = " + point(ex, ey) + " }; normal = " + normal + "; stiffness = 1e7; damping = 2e3; " +
                         start) +
             element("coulomb_stick", name + " friction", "contacts = [\"" + name + "\"]; static_friction = " + number(friction));
    };
    return text + end("foot", x, -y, "[0.0, 1.0]") + end("top", -x, y, "[1.0, 0.0]");
  };
  for (const char* start : {"gap = 0.0", "preload = 50.0", "preload = 98.1"}) {
    CAPTURE(std::string(start));
    for (const double friction : {0.27, 0.3, 0.5, 1.0}) {
      CAPTURE(friction);
      const Found found = settle(ladder(friction, start));
      REQUIRE(found.rest.margins.size() == 2);
      for (const FrictionMargin& margin : found.rest.margins) {
        CHECK(margin.used <= 1.0);
        // The wall and the floor give way by 1e-5 m of 1 m, and preloads may leave the ladder where it uses less.
        if (std::string(start) == "gap = 0.0" && friction < 0.5) CHECK(std::abs(margin.used * friction / limit - 1.0) < 1e-3);
      }
      CHECK(found.rest.moved < 1e-3);
      if (friction != 0.3) continue;
      // A run from there stays there: nothing slips, and what is left of the balance, 1e-10 m/s², moves it by as much.
      const RunResult stays = simulate(*found.system, found.rest.state, options({"auto", 1e-8, 0.3}));
      CHECK(stays.events.empty());
      for (int k = 3; k < 6; ++k) CHECK(std::abs(stays.final_state.q[k] - found.rest.state.q[k]) < 1e-11);
    }
    for (const double friction : {0.2, 0.26}) {
      CAPTURE(friction);
      CHECK(has(reason(ladder(friction, start)), "friction' and what shares its load) would have to hold 1."));
    }
  }
}

TEST_CASE("a block on a slope that is too steep does not rest, and the share is told") {
  const std::string text = body("block", "mass = 100; inertia = 10; position = [0.0, 0.2]") +
                           element("unilateral_contact", "upper",
                                   "a = { body = \"block\", point = [-0.5, -0.2] }; stiffness = 1e6; damping = 1e3; preload = 490.0") +
                           element("unilateral_contact", "lower",
                                   "a = { body = \"block\", point = [0.5, -0.2] }; stiffness = 1e6; damping = 1e3; preload = 490.0") +
                           element("coulomb_stick", "friction", "contacts = [\"upper\", \"lower\"]; static_friction = 0.4") +
                           element("load", "tilt", "at = \"block\"; force = [588.6, 0.0]"); // 0.6 of the weight
  const std::string why = reason(text);
  CAPTURE(why);
  CHECK(has(why, "'friction'"));
  CHECK(has(why, "1.5 times what it can"));
  CHECK(has(why, "and 'block' slides"));
}

// Downhill of the block a stop of 5 % of its weight per millimetre stands 0.3 m away: it rests there, but not as given.
TEST_CASE("a block that slides to a distant stop does not stand, and the way is told") {
  const auto block = [](const std::string& friction) {
    return body("block",
                "mass = 100; inertia = 10; position = [0.0, 0.2]; outline = [[-0.5, -0.2], [0.5, -0.2], [0.5, 0.2], [-0.5, 0.2]]") +
           element("polygon_contact", "deck", "a = \"block\"; stiffness = 1e7; dissipation = 1; static_friction = " + friction) +
           element("load", "tilt", "at = \"block\"; force = [294.3, 0.0]") + // 0.3 of the weight
           element("unilateral_contact", "stop",
                   "a = { body = \"block\", at = [0.5, 0.2] }; b = { body = \"ground\", at = [0.8, 0.2] }; "
                   "normal = [-1, 0]; stiffness = 5e4; damping = 1e3");
  };
  // Strongly damped it ends where the stop bears what friction leaves: 0.3 m and 98.1 N/(50 N/mm) or more.
  const std::string why = reason(block("0.2"));
  CAPTURE(why);
  CHECK(has(why, "'block' slides. It does not stand as given; released and strongly damped, it comes to rest after 0.30"));
  // Without friction it stands against nothing but the stop, which bears the whole load: 294.3 N/(50 N/mm).
  CHECK(std::abs(settle(block("0.0")).rest.state.q[3] - (0.3 + 294.3 / 5e4)) < 1e-6);
}

TEST_CASE("where nothing holds it is said what moves where") {
  CHECK(has(reason(body("stone", "mass = 2; inertia = 1")), "'stone' along -y moves without end: nothing holds it against the 19.62 N"));
  const std::string wheel = body("wheel", "mass = 2; inertia = 1") + element("revolute", "pin", "a = \"wheel\"");
  CHECK(has(reason(wheel + element("motor", "drive", "a = \"wheel\"; coordinate = \"angle\"; constant_effort = 3.0")),
            "'wheel' turning counter-clockwise moves without end: nothing holds it against the 3 N m"));
  const Found loose = settle(wheel);
  REQUIRE(loose.rest.indifferent.size() == 1);
  CHECK(loose.rest.indifferent[0].coordinate == 2);
}

TEST_CASE("a pose that balances without holding is left, and told") {
  const Found found = settle(body("bob", "mass = 2; inertia = 0.1; position = [0.0, 1.0]") +
                             element("revolute", "pin", "a = { body = \"bob\", at = [0.0, 0.0] }"));
  CHECK(found.rest.left.size() == 1);
  CHECK(std::abs(found.rest.state.q[4] + 1.0) < 1e-12);
}

// On a smooth hill a bead balances on the top, and nowhere else: that is a rest, if not one that stays, and what is
// said must not deny it. Beside the top there is none to speak of. In a valley beyond it would come to rest.
TEST_CASE("a bead on a smooth hill has an unstable rest, and that is said") {
  const auto bead = [](double x) {
    return body("bead",
                "mass = 1.0; inertia = 0.004; position = [" + std::to_string(x) + ", " + std::to_string(std::sqrt(1.21 - x * x)) + "]") +
           element("circle_contact", "hill", "a = \"bead\"; radius_a = 0.1; radius_b = 1.0; stiffness = 1e6");
  };
  const std::string on_top = reason(bead(0.0));
  CHECK(has(on_top, "no stable equilibrium: a pose on the way balances, but not stably: a nudge of 'bead' along +x leaves it"));
  CHECK(has(on_top, "downhill from there 'bead' along -y moves without end"));
  CHECK_FALSE(has(on_top, "no static equilibrium"));
  const std::string aside = reason(bead(0.05));
  CHECK(has(aside, "no static equilibrium: 'bead' along -y moves without end"));
  CHECK_FALSE(has(aside, "balances"));
  const Found caught = settle(
      bead(0.0) + element("circle_contact", "valley", "a = \"bead\"; radius_a = 0.1; radius_b = 3.0; inside = true; stiffness = 1e6"));
  CHECK(caught.rest.left.size() == 1);
  CHECK(std::abs(caught.rest.state.q[4] + 2.9) < 1e-4); // m g/k of 1e-5 deeper
}

// Friction of M on the pin of a pendulum holds it where m g r |sin φ| ≤ M: from the horizontal it sinks to that border.
TEST_CASE("a pendulum with dry friction in its pin sinks to where that holds it") {
  const Found found = settle(body("bob", "mass = 2; inertia = 0.1; position = [1.0, 0.0]") +
                             element("revolute", "pin", "a = { body = \"bob\", at = [0.0, 0.0] }") +
                             element("joint_friction", "rust", "a = \"bob\"; coordinate = \"angle\"; holds = 8.0"));
  REQUIRE(found.rest.margins.size() == 1);
  // A millionth short of the border, so that it holds.
  CHECK(std::abs(found.rest.margins[0].used - 1.0) < 2e-6);
  CHECK(std::abs(found.rest.state.q[3] - 8.0 / (2.0 * k_g)) < 2e-6);
  CHECK(found.rest.slid.size() == 1);
}

TEST_CASE("a drive that moves is held for the search, and told") {
  const auto cart = [](const std::string& signal) {
    return signal + body("cart", "mass = 10; inertia = 1; position = [0.0, 0.0]") +
           body("bob", "mass = 2; inertia = 0.1; position = [1.0, 0.0]") + element("prismatic", "road", "a = \"cart\"; axis = [1.0, 0.0]") +
           element("prescribed_motion", "drive", "a = \"cart\"; coordinate = \"x\"; signal = \"go\"; as = \"acceleration\"") +
           element("revolute", "pin", "a = { body = \"bob\", point = [-1.0, 0.0] }; b = \"cart\"");
  };
  const Found moving = settle(cart(signal_entry("constant", "go", "value = 5.0")));
  CHECK(std::abs(moving.rest.state.q[6]) < 1e-12);
  CHECK(std::abs(moving.rest.state.q[7] + 1.0) < 1e-12);
  REQUIRE(moving.rest.moving_drives.size() == 1);
  CHECK(has(remarks_on(*moving.system, moving.rest).back(), "'drive' moves or accelerates"));
  CHECK(settle(cart(signal_entry("constant", "go", "value = 0.0"))).rest.moving_drives.empty());
}

// Boxes with corners of 1e7 N/m, dropped from metres above at any angle: they come to lie on a side, each corner of the
// lowest pressed in by its share of the weight.
TEST_CASE("boxes dropped at any angle come to lie, and stacks stand") {
  const auto box = [](const std::string& name, double height, double tilt) {
    return body(name, "mass = 10; inertia = 1.6666666666666667; position = " + point(0.01 * height, height) + "; angle = " + number(tilt));
  };
  for (const double tilt : {0.0, 0.3, 0.7, 1.2, 2.5, -0.6}) {
    CAPTURE(tilt);
    std::string text = box("box", 3.0, tilt);
    int i = 0;
    for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
      const std::string name = "corner " + std::to_string(i++);
      text += element("unilateral_contact", name, "a = { body = \"box\", point = " + point(x, y) + " }; stiffness = 1e7; damping = 1e3") +
              element("coulomb_stick", name + " friction", "contacts = [\"" + name + "\"]; static_friction = 0.4");
    }
    const Found found = settle(text);
    const double quarter = 0.5 * k_pi, angle = found.rest.state.q[5];
    // Friction on both corners holds what the last of the way left between them: up to its share of 1e-5 of the load.
    CHECK(std::abs(angle - quarter * std::round(angle / quarter)) < 1e-9);
    CHECK(std::abs(found.rest.state.q[4] - 0.5 + 10.0 * k_g / 2e7) < 1e-9);
    CHECK(found.rest.iterations < 1000);
  }
  std::string stack;
  for (int i = 0; i < 4; ++i) {
    const std::string name = "box " + std::to_string(i), left = "left " + std::to_string(i), right = "right " + std::to_string(i);
    const std::string on = i == 0 ? "\"ground\"" : "{ body = \"box " + std::to_string(i - 1) + "\", point = [0.0, 0.5] }";
    stack += box(name, 0.6 + 1.1 * i, i % 2 == 0 ? 0.04 : -0.03);
    for (const auto& [foot, x] : {std::pair{left, -0.5}, {right, 0.5}})
      stack += element("unilateral_contact", foot,
                       "a = { body = \"" + name + "\", point = " + point(x, -0.5) + " }; b = " + on + "; stiffness = 1e7; damping = 1e3");
    stack += element("coulomb_stick", "friction " + std::to_string(i),
                     "contacts = [\"" + left + "\", \"" + right + "\"]; static_friction = 0.4");
  }
  const Found found = settle(stack);
  double y = -0.5;
  for (int i = 0; i < 4; ++i) { // 2 k δ = weight of it and of what is above
    y += 1.0 - (4 - i) * 10.0 * k_g / 2e7;
    // Boxes stand off centre by a few centimetres: tilts of 1e-6, their square over a metre.
    CHECK(std::abs(found.rest.state.q[3 * i + 4] - y) < 1e-6);
    CHECK(std::abs(found.rest.state.q[3 * i + 5]) < 1e-5);
  }
}

// A frictionless ball between two planes of 45° and less lies where both touch it: its centre is r/sin(half angle) from
// the corner along the bisector. Falling from high above it must not pass through them.
TEST_CASE("a ball falls into a groove and stays in it, from however high") {
  for (const double height : {2.0, 40.0}) {
    CAPTURE(height);
    std::string text = body("ball", "mass = 5; inertia = 0.5; position = " + point(0.1, height));
    for (const auto& [name, ends] :
         {std::pair{"left", "from = [-3.0, 3.0]; to = [0.0, 0.0]"}, {"right", "from = [0.0, 0.0]; to = [3.0, 3.0]"}})
      text += element("segment_contact", name,
                      std::string("a = \"ball\"; b = \"ground\"; radius = 0.5; stiffness = 1e8; damping = 1e3; ") + ends);
    const Found found = settle(text);
    // 1e8 N/m gives way by 3.5e-7 m on each side.
    const double depth = 5.0 * k_g * std::sqrt(0.5) / 1e8;
    CHECK(std::abs(found.rest.state.q[3]) < 1e-9);
    CHECK(std::abs(found.rest.state.q[4] - (0.5 - depth) * std::sqrt(2.0)) < 1e-9);
  }
}

TEST_CASE("a forklift with too much on its fork tips over, and is said to") {
  const auto truck = [](double load) {
    std::string text = body("truck", "mass = 1000; inertia = 300; position = [0.0, 0.8]") +
                       body("load", "mass = " + number(load) + "; inertia = 20; position = [1.6, 0.8]") +
                       element("weld", "fork", "a = \"load\"; b = { body = \"truck\", at = [1.0, 0.8] }");
    for (const auto& [name, x] : {std::pair{"rear", -0.8}, {"front", 0.8}})
      text +=
          element("unilateral_contact", name, "a = { body = \"truck\", point = " + point(x, -0.8) + " }; stiffness = 1e7; damping = 1e4");
    return text + element("coulomb_stick", "tyres", "contacts = [\"rear\", \"front\"]; static_friction = 0.7");
  };
  // It stands while 0.8 m · 1000 kg of its own exceed 0.8 m of the load.
  CHECK(settle(truck(990.0)).rest.turned == 0.0);
  const Found tipped = settle(truck(1010.0));
  CHECK(std::abs(tipped.rest.turned) > 1.0);
  bool is_told = false;
  for (const std::string& remark : remarks_on(*tipped.system, tipped.rest)) is_told = is_told || has(remark, "does not stand as given");
  CHECK(is_told);
}

// A limb of weight W on an elastic joint of stiffness K and capacity F, with a plate of stiffness k beside it: it hangs at
// W/K while that is below F/K (the plate slack), else the joint bears F and the plate the rest.
TEST_CASE("a limb rests on its elastic joint, and beyond its bound on what stands beside it") {
  const double weight = 9000.0 * 9.81;
  const auto sunk = [](const std::vector<std::string>& overrides) {
    const Model model = read_model(STEPLAP_MODELS "/../docs/examples/ratcheting.toml", transformer_catalog(), overrides);
    const auto system = compile(model);
    const Equilibrium rest = find_equilibrium(*system, system->initial_state());
    return -rest.state.q[3 * 2 + 1];
  };
  const double stuck = weight / 2e9;
  CHECK(sunk({}) == doctest::Approx(stuck).epsilon(1e-9)); // the plate of 1 N/m bears 5e-10 of it
  // Half the pressure bears 60 kN: what the corner above loses of its overlap the one below wins. Radial returns come as
  // near as the searches between them, 1e-9 of the way.
  const double plate = 5e7, left = (weight - 60e3) / plate;
  CHECK(sunk({"element.tie plate.stiffness=5e7", "element.top corner.pressure=5e4", "element.bottom corner.pressure=5e4"}) ==
        doctest::Approx(left).epsilon(1e-6));
  // With as good as nothing beside it the limb falls.
  CHECK_THROWS_AS((void)sunk({"element.top corner.pressure=5e4", "element.bottom corner.pressure=5e4"}), NumericalFailure);
}
