// Actions against closed forms: what is released, held, set and stopped, when, and what becomes of the energy.
//
// Tolerances: runs at 1e-12 over some hundred steps leave 1e-10 of values near 1, and the instant of an event is as exact as the
// motion there.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include "mbd/rest/start.h"
#include "mbd/system/element_failure.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81, k_tolerance = 1e-9;
constexpr const char* k_exact_methods[] = {"dop853", "rodas5p", "tsit5", "auto"};

std::string action(const std::string& name, const std::string& fields) { return table_text("action", "name = \"" + name + "\"\n", fields); }
std::string also(const std::string& names) { return "[output]\nalso = [" + names + "]\n"; }

double balance(const Run& r) {
  return r.last("whole.kinetic") + r.last("whole.potential") + r.last("whole.dissipated") - r.last("whole.work");
}
constexpr const char* k_energies = "\"whole.*\"";

// A jib's head of 3 kg on a spring of 300 N/m, with 2 kg hanging from it, both at rest: the spring is drawn out by 5 g/300.
std::string crane(const std::string& hanger, const std::string& rest) {
  return body("head", "mass = 3; inertia = 1; position = [0, 0]") + body("load", "mass = 2; inertia = 1; position = [0, -1]") +
         element("prismatic", "rail", "a = \"head\"; axis = [0, 1]") +
         element("spring_damper", "jib", "a = \"head\"; b = { body = \"ground\", at = [0, 4] }; stiffness = 300; preload = -49.05") +
         hanger + rest;
}

// Around its new rest, from where it is: y = A (1 − cos ω t), A = m g / k.
void check_crane(const Run& r, double released, double end) {
  const double omega = std::sqrt(300.0 / 3.0), fallen = end - released;
  CHECK(std::abs(r.last("head.y") - 2.0 * k_g / 300.0 * (1.0 - std::cos(omega * fallen))) < k_tolerance);
  CHECK(std::abs(r.last("load.y") - (-1.0 - 0.5 * k_g * fallen * fallen)) < k_tolerance);
}

// Two discs on their shaft, at 10 and 4 rad/s.
constexpr double k_i1 = 2.0, k_i2 = 3.0, k_w1 = 10.0, k_w2 = 4.0;
std::string discs() {
  return k_no_gravity + body("one", "mass = 1; inertia = 2; angular_velocity = 10") +
         body("other", "mass = 1; inertia = 3; angular_velocity = 4") + element("revolute", "bearing", "a = \"one\"") +
         element("revolute", "other bearing", "a = \"other\"; b = \"one\"");
}

} // namespace

TEST_CASE("a condition that a blow makes true happens in the same instant") {
  const std::string text = k_no_gravity + body("one", "mass = 1; inertia = 1; velocity = [1.0, 0.0]") +
                           body("other", "mass = 1; inertia = 1; position = [2.0, 0.0]") +
                           element("weld", "lock", "a = \"one\"; b = \"other\"; active = false") +
                           "[[action]]\nname = \"caught\"\nwhen = \"0.5 s\"\ndo = [\"hold lock\"]\n"
                           "[[action]]\nname = \"end\"\nwhen = \"one.vx < '0.75 m/s'\"\ndo = [\"stop\"]\n"; // together they go at 0.5 m/s
  for (const char* method : {"dop853", "tsit5", "rodas5p"}) {
    CAPTURE(std::string(method));
    const Run r = run(text, {method, 1e-10, 1.0, 0.1});
    REQUIRE(r.event_times("end").size() == 1);
    CHECK(r.event_times("end")[0] == 0.5);
  }
}

TEST_CASE("a condition that a signal's jump makes true happens at the jump") {
  const std::string text = k_no_gravity + body("block", "mass = 1; inertia = 1; velocity = [1.0, 0.0]") +
                           "[[signal]]\nkind = \"rectangle\"\nname = \"drive\"\npeak = 1.0\nstart = 0.3\nduration = 0.4\n"
                           "[[action]]\nname = \"end\"\nwhen = \"drive > 0.5 && block.x > '0.1 m'\"\ndo = [\"stop\"]\n";
  for (const char* method : {"dop853", "tsit5", "rodas5p"}) {
    CAPTURE(std::string(method));
    const Run r = run(text, {method, 1e-10, 1.0, 0.1});
    REQUIRE(r.event_times("end").size() == 1);
    CHECK(r.event_times("end")[0] == 0.3); // a breakpoint, which is no time found
  }
}

TEST_CASE("a crane that drops its load swings about its new rest, whatever the load hung from") {
  const std::string hangers[] = {element("distance", "rope", "a = \"load\"; b = \"head\""),
                                 element("rope", "rope", "a = \"load\"; b = \"head\"; inextensible = true"),
                                 element("weld", "rope", "a = \"load\"; b = \"head\"")};
  for (const std::string& hanger : hangers)
    for (const char* method : k_exact_methods) {
      CAPTURE(hanger);
      CAPTURE(std::string(method));
      const Run r =
          run(crane(hanger, action("drop", "when = \"0.3 s\"; do = [\"release rope\"]") + also(k_energies)), {method, 1e-12, 1.0, 0.05});
      check_crane(r, 0.3, 1.0);
      REQUIRE(r.event_times("drop", "happens").size() == 1);
      CHECK(r.event_times("drop").at(0) == 0.3);
      CHECK(std::abs(r.last("whole.dissipated")) < k_tolerance); // a rope that lets go loses nothing
      CHECK(r.result.statistics.energy_residual < 1e-8);
      CHECK(r.result.ended_by.empty());
    }
}

TEST_CASE("channels of what is released are zero from there on, and their extremes are those of the whole run") {
  const Run r =
      run(crane(element("distance", "rope", "a = \"load\"; b = \"head\""), action("drop", "when = \"0.3 s\"; do = [\"release rope\"]")),
          {"dop853", 1e-12, 1.0, 0.05});
  const std::vector<double> force = r.series("rope.force");
  for (std::size_t i = 0; i < force.size(); ++i)
    CHECK(std::abs(force[i] - (r.times()[i] < 0.31 ? -2.0 * k_g : 0.0)) < 1e-7); // at the instant it is what was before
  SimulationOptions o = options({"dop853", 1e-12, 1.0});
  o.has_extremes = true;
  const RunResult result = simulate(*r.system, r.system->initial_state(), o);
  for (const ChannelRange& range : result.ranges) {
    if (range.channel->name == "rope.force") {
      CHECK(std::abs(range.low.value + 2.0 * k_g) < 1e-7);
      CHECK(range.high.value == 0.0);
      CHECK(range.final == 0.0);
    }
    if (range.channel->name != "head.y") continue;
    CHECK(std::abs(range.high.value - 4.0 * k_g / 300.0) < 1e-6); // its swing
    CHECK(std::abs(range.low.value) < 1e-9);
  }
}

// A block slides on two feet, in line with its centre of gravity; its friction is released, then the feet, and it falls freely.
TEST_CASE("where a released element's bodies are is told on, and what only the element knows has no value") {
  const auto foot = [](const std::string& name, const std::string& x) {
    return element("unilateral_contact", name, "a = { body = \"block\", point = [" + x + ", 0.0] }; stiffness = 1e5; preload = 4.905");
  };
  const std::string text =
      body("block", "mass = 1; inertia = 0.1; velocity = [1.0, 0.0]") + foot("rear", "-0.5") + foot("front", "0.5") +
      element("coulomb_stick", "soles", "contacts = [\"rear\", \"front\"]; static_friction = 0.1") +
      element("tie", "cord",
              "a = \"block\"; b = { body = \"ground\", at = [0.0, 1.0] }; stiffness = 1; acts = \"compression\"; slack = 9") +
      action("wet", "when = \"0.5 s\"; do = [\"release soles\", \"release cord\"]") +
      action("hole", "when = \"0.8 s\"; do = [\"release rear\", \"release front\"]");
  SimulationOptions o = options({"dop853", 1e-12, 1.0});
  o.has_extremes = true;
  Run r;
  r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
  r.result = simulate(*r.system, r.system->initial_state(), o);
  const double v = 1.0 - 0.1 * k_g * 0.5, x = 0.5 * (1.0 + v) * 0.5 + 0.5 * v, y = -0.5 * k_g * 0.04;
  CHECK(std::abs(r.last("soles.slide") - x) < k_tolerance);
  CHECK(std::abs(r.last("rear.gap") - (y - 4.905e-5)) < k_tolerance);
  CHECK(std::abs(r.last("front.rate") + k_g * 0.2) < k_tolerance);
  CHECK(std::abs(r.last("cord.elongation") - (std::hypot(x, 1.0 - y) - 1.0)) < k_tolerance);
  CHECK(std::isnan(r.last("soles.slip_rate"))); // where it would act is the element's own choice
  for (const char* name : {"soles.friction", "soles.normal", "soles.mode", "rear.force", "cord.force"}) CHECK(r.last(name) == 0.0);
  for (const ChannelRange& range : r.result.ranges) {
    CAPTURE(range.channel->name);
    CHECK(range.had_no_value == (range.channel->name == "soles.slip_rate"));
  }
}

TEST_CASE("a clutch that closes at once makes two discs one, and loses what the closed form says") {
  const double together = (k_i1 * k_w1 + k_i2 * k_w2) / (k_i1 + k_i2),
               lost = 0.5 * k_i1 * k_i2 / (k_i1 + k_i2) * (k_w1 - k_w2) * (k_w1 - k_w2);
  for (const char* method : k_exact_methods)
    for (const Coordinates coordinates : {Coordinates::absolute, Coordinates::joint}) {
      CAPTURE(std::string(method));
      Run r;
      r.system =
          compile(scene(discs() + element("weld", "clutch", "a = \"other\"; b = \"one\"; active = false") +
                        action("engage", "when = \"0.5 s\"; do = [\"hold clutch\"]") + also(k_energies) + "[simulation]\nstep = 1e-3\n"));
      SimulationOptions o = options({method, 1e-12, 1.0});
      o.coordinates = coordinates;
      r.result = simulate(*r.system, r.system->initial_state(), o);
      CHECK(std::abs(r.last("one.omega") - together) < k_tolerance);
      CHECK(std::abs(r.last("other.omega") - together) < k_tolerance);
      CHECK(std::abs(r.last("one.theta") - (0.5 * k_w1 + 0.5 * together)) < k_tolerance);
      CHECK(std::abs(r.last("whole.dissipated") - lost) < k_tolerance);
      CHECK(std::abs(r.last("whole.kinetic") - 0.5 * (k_i1 + k_i2) * together * together) < k_tolerance);
    }
}

TEST_CASE("two bodies that dock go on with their momenta together") {
  // 1 kg, 2 kg m² at the origin with (1, 0) m/s; 3 kg, 1 kg m² at (2, 1) with (-1, 0.5) m/s and 2 rad/s. At 0.5 s they are at (0.5, 0) and (1.5, 1.25).
  const Vec2 centre = (Vec2(0.5, 0.0) + 3.0 * Vec2(1.5, 1.25)) / 4.0, v = (Vec2(1.0, 0.0) + 3.0 * Vec2(-1.0, 0.5)) / 4.0;
  const Vec2 r1 = Vec2(0.5, 0.0) - centre, r2 = Vec2(1.5, 1.25) - centre, v1 = Vec2(1.0, 0.0), v2 = Vec2(-1.0, 0.5);
  const double inertia = 2.0 + 1.0 + r1.squaredNorm() + 3.0 * r2.squaredNorm();
  const double omega = (2.0 + r1.x() * v1.y() - r1.y() * v1.x() + 3.0 * (r2.x() * v2.y() - r2.y() * v2.x())) /
                       inertia; // 1 kg m² · 2 rad/s, and of the masses
  const double before = 0.5 + 1.5 * 1.25 + 2.0, after = 2.0 * v.squaredNorm() + 0.5 * inertia * omega * omega;
  for (const char* method : k_exact_methods)
    for (const char* joint : {"weld", "prismatic"}) {
      CAPTURE(std::string(method));
      const Run r = run(k_no_gravity + body("one", "mass = 1; inertia = 2; velocity = [1, 0]") +
                            body("other", "mass = 3; inertia = 1; position = [2, 1]; velocity = [-1, 0.5]; angular_velocity = 2") +
                            element(joint, "latch", "a = \"one\"; b = \"other\"; active = false") +
                            action("dock", "when = \"0.5 s\"; do = [\"hold latch\"]") + also(k_energies),
                        {method, 1e-12, 1.5});
      const Vec2 momentum = Vec2(r.last("one.vx"), r.last("one.vy")) + 3.0 * Vec2(r.last("other.vx"), r.last("other.vy"));
      CHECK((momentum - 4.0 * v).norm() < k_tolerance);
      CHECK(std::abs(r.last("one.omega") - r.last("other.omega")) < k_tolerance);
      CHECK(std::abs(r.last("other.theta") - r.last("one.theta") - 1.0) < k_tolerance); // as it was found
      CHECK(std::abs(balance(r) - before) < k_tolerance);
      if (std::string(joint) == "prismatic") continue;
      CHECK(std::abs(r.last("one.omega") - omega) < k_tolerance);
      CHECK(std::abs(r.last("whole.dissipated") - (before - after)) < k_tolerance);
      CHECK(std::abs(Vec2(r.last("other.x") - r.last("one.x"), r.last("other.y") - r.last("one.y")).norm() - std::sqrt(1.0 + 1.25 * 1.25)) <
            k_tolerance);
    }
}

TEST_CASE("a clutch that slips brings both discs to one speed in the time that its couple takes") {
  // 0.001 N m before it is set to 12: both decelerate one another by 12 t/I until they meet.
  const double before = 0.001, couple = 12.0, set = 0.25;
  const double rate = couple * (1.0 / k_i1 + 1.0 / k_i2), difference = k_w1 - k_w2 - before * (1.0 / k_i1 + 1.0 / k_i2) * set;
  const double together = (k_i1 * k_w1 + k_i2 * k_w2) / (k_i1 + k_i2);
  for (const char* method : k_exact_methods) {
    CAPTURE(std::string(method));
    const Run r = run(discs() + element("joint_friction", "clutch", "a = \"one\"; b = \"other\"; coordinate = \"angle\"; holds = 0.001") +
                          action("engage", "when = \"0.25 s\"; do = [\"set clutch.holds = 12 N m\"]") +
                          action("gone", "when = \"clutch sticks\"; do = [\"stop\"]"),
                      {method, 1e-12, 2.0});
    CHECK(r.result.ended_by == "gone");
    CHECK(r.result.stop_reason.empty());
    CHECK(std::abs(r.result.final_state.t - (set + difference / rate)) < k_tolerance);
    CHECK(std::abs(r.last("one.omega") - together) < 1e-8);
  }
}

TEST_CASE("a latch keeps what a spring has stored, and gives all of it back") {
  // 2 kg at 3 m/s into 50 N/m; it is held where it comes to rest, and let go at 2 s.
  const double omega = 5.0, furthest = 3.0 / omega, arrives = std::numbers::pi / 2.0 / omega;
  for (const char* method : k_exact_methods) {
    CAPTURE(std::string(method));
    const Run r =
        run(k_no_gravity + body("block", "mass = 2; inertia = 1; velocity = [3, 0]") + element("prismatic", "rail", "a = \"block\"") +
                element("spring_damper", "spring", "a = \"block\"; b = { body = \"ground\", at = [5, 0] }; stiffness = 50") +
                element("weld", "latch", "a = \"block\"; active = false") +
                action("catch", "when = \"block.vx < '0 m/s'\"; do = [\"hold latch\", \"arm shoot\"]") +
                action("shoot", "when = \"2 s\"; do = [\"release latch\"]; armed = false") + also(k_energies),
            {method, 1e-12, 2.4, 0.1});
    REQUIRE(r.event_times("catch").size() == 1);
    CHECK(std::abs(r.event_times("catch").at(0) - arrives) < k_tolerance);
    CHECK(r.event_times("shoot").at(0) == 2.0);
    for (std::size_t i = 0; i < r.times().size(); ++i)
      if (r.times()[i] > arrives && r.times()[i] < 2.0) CHECK(std::abs(r.series("block.x")[i] - furthest) < k_tolerance);
    CHECK(std::abs(r.last("block.x") - furthest * std::cos(omega * 0.4)) < 1e-8);
    CHECK(std::abs(balance(r) - 9.0) < 1e-8);
    CHECK(std::abs(r.last("whole.dissipated")) < k_tolerance);
  }
}

TEST_CASE("what a spring has stored is lost with it, and made stiffer it has taken work") {
  const std::string block =
      k_no_gravity + body("block", "mass = 2; inertia = 1; velocity = [3, 0]") + element("prismatic", "rail", "a = \"block\"") +
      element("spring_damper", "spring", "a = \"block\"; b = { body = \"ground\", at = [5, 0] }; stiffness = 50") + also(k_energies);
  const double x = 0.6 * std::sin(5.0 * 0.1);
  const Run lost = run(block + action("snap", "when = \"0.1 s\"; do = [\"release spring\"]"), {"dop853", 1e-12, 1.0});
  CHECK(std::abs(lost.last("whole.dissipated") - 25.0 * x * x) < k_tolerance);
  CHECK(std::abs(lost.last("block.vx") - 3.0 * std::cos(0.5)) < k_tolerance);
  CHECK(std::abs(balance(lost) - 9.0) < k_tolerance);
  const Run stiffer = run(block + action("stiffen", "when = \"0.1 s\"; do = [\"set spring.stiffness = 0.2 N/mm\"]"),
                          {"dop853", 1e-12, 0.1 + std::numbers::pi / 10.0});
  CHECK(std::abs(stiffer.last("whole.work") - 75.0 * x * x) < k_tolerance);
  CHECK(std::abs(stiffer.last("block.x") + x) < k_tolerance); // half a period of √(200/2) later
  CHECK(std::abs(balance(stiffer) - 9.0) < k_tolerance);
}

TEST_CASE("a run stops at the instant that a comparison comes true") {
  for (const char* method : k_exact_methods) {
    CAPTURE(std::string(method));
    const Run r =
        run(body("ball", "mass = 1; inertia = 1; position = [0, 2]") + action("ground", "when = \"ball.y < '0.5 m'\"; do = [\"stop\"]"),
            {method, 1e-12, 5.0, 0.1});
    const double t = std::sqrt(2.0 * 1.5 / k_g);
    CHECK(std::abs(r.result.final_state.t - t) < k_tolerance);
    CHECK(std::abs(r.times().back() - t) < k_tolerance);
    CHECK(std::abs(r.last("ball.y") - 0.5) < k_tolerance);
    CHECK(r.result.ended_by == "ground");
    REQUIRE(r.result.events.size() == 1);
    CHECK(r.result.events[0].kind == EventKind::happens);
    CHECK(r.result.events[0].detail == "stop");
  }
}

TEST_CASE("each time counts every rise of a condition, once the first alone") {
  // A mass on a spring swings with 1 Hz from +1: x < 0 comes true at 1/4, 5/4, 9/4 … s.
  const std::string text =
      k_no_gravity + body("mass", "mass = 1; inertia = 1; position = [1, 0]") +
      element("prismatic", "rail", "a = { body = \"mass\", point = [-1, 0] }") +
      element("spring_damper", "spring", "a = \"mass\"; axis = [1, 0]; stiffness = 39.47841760435743; free_length = 0") +
      action("each", "when = \"mass.x < '0 m'\"; do = [\"set push.couple = 0\"]; once = false") +
      action("first", "when = \"mass.x < '0 m'\"; do = [\"set push.couple = 0\"]") + element("load", "push", "at = \"mass\"");
  const Run r = run(text, {"dop853", 1e-12, 5.1});
  REQUIRE(r.event_times("each").size() == 5);
  for (int k = 0; k < 5; ++k) CHECK(std::abs(r.event_times("each")[static_cast<std::size_t>(k)] - (0.25 + k)) < k_tolerance);
  CHECK(r.event_times("first").size() == 1);
}

TEST_CASE("actions arm each other: brakes that are interlocked take their turns, each once the other has let go") {
  // A disc of 2 kg m² at 10 rad/s. The first brake takes 4 N m down to 6 rad/s, the second 8 N m down to 2, the first again to rest.
  const std::string text = k_no_gravity + body("disc", "mass = 1; inertia = 2; angular_velocity = 10") +
                           element("revolute", "bearing", "a = \"disc\"") +
                           element("joint_friction", "one", "a = \"disc\"; coordinate = \"angle\"; holds = 4") +
                           element("joint_friction", "two", "a = \"disc\"; coordinate = \"angle\"; holds = 8; active = false") +
                           action("over", "when = \"disc.omega < '6 rad/s'\"; do = [\"release one\", \"hold two\", \"arm back\"]") +
                           action("back", "when = \"disc.omega < '2 rad/s'\"; do = [\"release two\", \"hold one\"]; armed = false") +
                           action("rest", "when = \"one sticks\"; do = [\"stop\"]");
  for (const char* method : k_exact_methods) {
    CAPTURE(std::string(method));
    const Run r = run(text + also(k_energies), {method, 1e-12, 20.0, 0.1});
    REQUIRE(r.event_times("over").size() == 1);
    REQUIRE(r.event_times("back").size() == 1);
    CHECK(std::abs(r.event_times("over").at(0) - 2.0) < k_tolerance);
    CHECK(std::abs(r.event_times("back").at(0) - 3.0) < k_tolerance);
    CHECK(std::abs(r.result.final_state.t - 4.0) < k_tolerance);
    CHECK(std::abs(r.last("whole.dissipated") - 100.0) < 1e-8);
    for (std::size_t i = 0; i < r.times().size(); ++i) {
      const double t = r.times()[i], couple = t < 2.0 || t > 3.0 ? -4.0 : 0.0;
      if (std::abs(t - 2.0) > 1e-6 && std::abs(t - 3.0) > 1e-6 && t < 3.99) CHECK(std::abs(r.series("one.friction")[i] - couple) < 1e-9);
    }
  }
}

TEST_CASE("what is due at one instant happens in the order of the file, and the last value that is set holds") {
  const std::string text = k_no_gravity + body("mass", "mass = 2; inertia = 1") + element("load", "push", "at = \"mass\"; couple = 0") +
                           action("b", "when = \"1 s\"; do = [\"set push.couple = 3\", \"disarm never\"]") +
                           action("a", "when = \"1 s\"; do = [\"set push.couple = 5 N m\"]") +
                           action("never", "when = \"t > '1 s'\"; do = [\"stop\"]");
  const Run r = run(text, {"dop853", 1e-12, 2.0});
  REQUIRE(r.result.events.size() == 2);
  CHECK(r.result.events[0].element == "b");
  CHECK(r.result.events[1].element == "a");
  CHECK(std::abs(r.last("mass.omega") - 5.0) < k_tolerance);
}

TEST_CASE("what is true as a run begins happens at its start, behind the equilibrium that it begins from") {
  // 2 kg hang at rest from 100 N/m; at t = 0 half of the spring is let go.
  const std::string text =
      body("mass", "mass = 2; inertia = 1") + element("prismatic", "rail", "a = \"mass\"; axis = [0, 1]") +
      element("spring_damper", "one", "a = \"mass\"; b = { body = \"ground\", at = [0, 2] }; stiffness = 50; free_length = 2") +
      element("spring_damper", "two", "a = \"mass\"; b = { body = \"ground\", at = [0, 2] }; stiffness = 50; free_length = 2") +
      action("snap", "when = \"mass.y < '0 m'\"; do = [\"release two\"]");
  const Model model = scene(text + "[simulation]\ninitial = \"equilibrium\"\n");
  Run r;
  r.system = compile(model);
  r.result = simulate(*r.system, start_of(model, *r.system), options({"dop853", 1e-12, 1.0, 1.0}));
  REQUIRE(r.event_times("snap").size() == 1);
  CHECK(r.event_times("snap").at(0) == 0.0);
  const double rest = 2.0 * k_g / 100.0;
  CHECK(std::abs(r.last("mass.y") - (-2.0 * rest + rest * std::cos(5.0))) < 1e-8);
}

TEST_CASE("events of elements set actions off: a ball that lands lets another one fall") {
  const std::string text =
      body("ball", "mass = 1; inertia = 1; position = [0, 1]") + body("other", "mass = 1; inertia = 1; position = [3, 5]") +
      element("unilateral_contact", "floor", "a = \"ball\"; b = \"ground\"; normal = [0, 1]; stiffness = 1e6; damping = 100") +
      element("weld", "hook", "a = \"other\"") + action("landed", "when = \"floor closes\"; do = [\"release hook\"]");
  for (const char* method : k_exact_methods) {
    const Run r = run(text, {method, 1e-12, 1.0});
    const double lands = std::sqrt(2.0 / k_g);
    REQUIRE(r.event_times("landed").size() == 1);
    CHECK(std::abs(r.event_times("landed").at(0) - lands) < k_tolerance);
    CHECK(std::abs(r.last("other.y") - (5.0 - 0.5 * k_g * (1.0 - lands) * (1.0 - lands))) < 1e-8);
  }
}

TEST_CASE("a floor that is taken away lets fall what stood on it, friction and all") {
  const std::string text =
      body("box", "mass = 3; inertia = 1; position = [0, 0.0]; velocity = [1, 0]") +
      element("unilateral_contact", "floor", "a = \"box\"; normal = [0, 1]; stiffness = 1e5; damping = 100; preload = 29.43") +
      element("coulomb_stick", "grip", "contacts = [\"floor\"]; static_friction = 0.5; kinetic_friction = 0.5") +
      action("gone", "when = \"0.1 s\"; do = [\"release floor\"]");
  const Run r = run(text, {"dop853", 1e-12, 0.5, 0.1});
  CHECK(std::abs(r.last("box.vx") - (1.0 - 0.5 * k_g * 0.1)) < 1e-7);
  CHECK(std::abs(r.last("box.vy") + k_g * 0.4) < 1e-6);
  CHECK(r.last("floor.force") == 0.0);
}

TEST_CASE("a rope that begins to act is slack, or catches what falls into it") {
  // From 1 m above its end a mass falls; the rope of 2 m from (0, 2) is hung in at 0.1 s and becomes taut where the mass is at 0.
  const std::string text =
      body("mass", "mass = 2; inertia = 1; position = [0, 1]") +
      element("rope", "rope", "a = \"mass\"; b = { body = \"ground\", at = [0, 2] }; inextensible = true; length = 2; active = false") +
      action("hang in", "when = \"0.1 s\"; do = [\"hold rope\"]");
  const Run r = run(text + also(k_energies), {"dop853", 1e-12, 1.0});
  REQUIRE(r.event_times("rope", "closes its gap").size() == 1);
  CHECK(std::abs(r.event_times("rope", "closes its gap").at(0) - std::sqrt(2.0 / k_g)) < k_tolerance);
  CHECK(std::abs(r.last("mass.y")) < k_tolerance);
  CHECK(std::abs(r.last("whole.dissipated") - 2.0 * k_g) < 1e-8);
}

TEST_CASE("a rope whose length is set bears from that length on, and may not be too short for where its ends are") {
  // From 1 m below the ground 2 kg fall into 1.5 m, and hang there.
  const auto text = [](const std::string& length) {
    return body("mass", "mass = 2; inertia = 1; position = [0, -1]") +
           element("rope", "rope", "a = \"mass\"; inextensible = true; length = 1.5") +
           action("set", "when = \"1 s\"; do = [\"set rope.length = " + length + "\"]");
  };
  const double falls = std::sqrt(2.0 * 0.5 / k_g); // over the half metre that is paid out, from 1 s on
  const Run paid = run(text("2 m"), {"dop853", 1e-12, 1.0 + 0.5 * falls});
  CHECK(std::abs(paid.last("mass.y") - (-1.5 - 0.5 * k_g * 0.25 * falls * falls)) < k_tolerance);
  const Run caught = run(text("2 m"), {"dop853", 1e-12, 2.0});
  REQUIRE(caught.event_times("rope", "closes its gap").size() == 2);
  CHECK(std::abs(caught.event_times("rope", "closes its gap").at(1) - (1.0 + falls)) < k_tolerance);
  CHECK(std::abs(caught.last("mass.y") + 2.0) < k_tolerance);
  CHECK_THROWS_WITH_AS((void)run(text("1.2 m"), {"dop853", 1e-12, 2.0}), doctest::Contains("farther apart than its length"),
                       ElementFailure);
}

TEST_CASE("a value that makes other channels than a run began with ends it with a message") {
  const std::string text = body("sledge", "mass = 2; inertia = 1") + element("skate", "edge", "a = \"sledge\"; axis = [0, 1]") +
                           action("worn", "when = \"0.5 s\"; do = [\"set edge.grip = 1 N\"]");
  CHECK_THROWS_WITH_AS((void)run(text, {"dop853", 1e-10, 1.0}), doctest::Contains("other channels than at the start ('edge.share')"),
                       NumericalFailure);
}

TEST_CASE("a drive that gets another signal goes on from where it is") {
  const std::string text = k_no_gravity + signal_entry("constant", "slow", "value = 1") + signal_entry("constant", "fast", "value = 3") +
                           body("cart", "mass = 2; inertia = 1") +
                           element("prescribed_motion", "drive", "a = \"cart\"; coordinate = \"x\"; as = \"velocity\"; signal = \"slow\"") +
                           action("faster", "when = \"1 s\"; do = [\"set drive.signal = fast\"]") +
                           action("off", "when = \"cart.x > '2.5 m'\"; do = [\"release drive\"]");
  for (const char* method : k_exact_methods) {
    const Run r = run(text + also(k_energies), {method, 1e-12, 3.0});
    REQUIRE(r.event_times("off").size() == 1);
    CHECK(std::abs(r.event_times("off").at(0) - 1.5) < k_tolerance);
    CHECK(std::abs(r.last("cart.x") - 7.0) < k_tolerance);
    CHECK(std::abs(r.last("whole.kinetic") - 9.0) < k_tolerance);
    CHECK(std::abs(r.last("whole.dissipated") - 4.0) < k_tolerance); // ½ m Δv²: what the jump takes
    CHECK(std::abs(balance(r) - 1.0) < k_tolerance);
  }
}

TEST_CASE("fixed steps are cut where an action is due, and keep their order") {
  const auto error = [](double step) {
    const Run r = run(
        crane(element("distance", "rope", "a = \"load\"; b = \"head\""), action("drop", "when = \"0.3003 s\"; do = [\"release rope\"]")),
        {"rk4", step, 1.0});
    return std::abs(r.last("head.y") - 2.0 * k_g / 300.0 * (1.0 - std::cos(10.0 * (1.0 - 0.3003))));
  };
  const double order = error(0.02) / error(0.01); // 2^4, but for what the first step behind the action is shorter by
  CHECK(order > 10.0);
  CHECK(order < 22.0);
}

TEST_CASE("what an element has dissipated stays as it is when it acts no more, and goes on when it acts again") {
  // A damper of 2 N s/m on 1 kg at 3 m/s: v = 3 exp(-2 t) but between 0.2 and 0.7 s, when nothing acts.
  const std::string text = k_no_gravity + body("block", "mass = 1; inertia = 1; velocity = [3, 0]") +
                           element("prismatic", "rail", "a = \"block\"") +
                           element("spring_damper", "damper", "a = \"block\"; axis = [1, 0]; damping = 2") +
                           action("off", "when = \"0.2 s\"; do = [\"release damper\"]") +
                           action("on", "when = \"0.7 s\"; do = [\"hold damper\"]") + also("\"damper.dissipated\", \"whole.*\"");
  for (const char* method : k_exact_methods) {
    const Run r = run(text, {method, 1e-12, 1.0, 0.1});
    for (std::size_t i = 0; i < r.times().size(); ++i) {
      const double t = r.times()[i], braked = std::min(t, 0.2) + std::max(t - 0.7, 0.0);
      CHECK(std::abs(r.series("damper.dissipated")[i] - 4.5 * (1.0 - std::exp(-4.0 * braked))) < 1e-8);
    }
    CHECK(std::abs(balance(r) - 4.5) < k_tolerance);
  }
}

TEST_CASE("time stepping does what is due at the ends of its steps, with its own order") {
  const std::string text = crane(element("distance", "rope", "a = \"load\"; b = \"head\""),
                                 action("drop", "when = \"load.y > '-2 m' && t > '0.3003 s'\"; do = [\"release rope\"]"));
  const auto error = [&](double step) {
    SimulationOptions o = options({"moreau", 1e-9, 1.0, 1.0});
    o.settings.step = step;
    Run r;
    r.system = compile(scene(text + "[simulation]\nstep = 1e-3\n"));
    r.result = simulate(*r.system, r.system->initial_state(), o);
    REQUIRE(r.event_times("drop").size() == 1);
    CHECK(r.event_times("drop").at(0) >= 0.3003);
    CHECK(r.event_times("drop").at(0) <= 0.3003 + 1.001 * step);
    const double fallen = 1.0 - 0.3003;
    return std::abs(r.last("load.y") - (-1.0 - 0.5 * k_g * fallen * fallen));
  };
  CHECK(error(1e-3) < 20e-3);
  CHECK(error(1e-4) < 2e-3);
}

TEST_CASE("a second run of one system begins as the first one, and is the same to the bit") {
  const std::string text = discs() + element("weld", "clutch", "a = \"other\"; b = \"one\"; active = false") +
                           action("engage", "when = \"one.theta > '3 rad'\"; do = [\"hold clutch\"]") +
                           action("let go", "when = \"one.theta > '6 rad'\"; do = [\"release clutch\"]");
  const auto system = compile(scene(text + "[simulation]\nstep = 1e-3\n"));
  const RunResult one = simulate(*system, system->initial_state(), options({"dop853", 1e-10, 2.0, 0.1}));
  const RunResult two = simulate(*system, system->initial_state(), options({"dop853", 1e-10, 2.0, 0.1}));
  REQUIRE(one.events.size() == 2);
  REQUIRE(one.trajectory->size() == two.trajectory->size());
  for (std::size_t i = 0; i < one.trajectory->size(); ++i)
    for (std::size_t c = 0; c < one.trajectory->channels().size(); ++c) CHECK(one.trajectory->value(i, c) == two.trajectory->value(i, c));
  CHECK(one.final_state.q == two.final_state.q);
  CHECK(one.final_state.mode.size() == system->units.size());
}

TEST_CASE("actions that set each other off without end are told with their ring") {
  const std::string ring = body("ball", "mass = 1; inertia = 1; position = [0, 1]") +
                           action("a", "when = \"ball.y < '0.5 m'\"; do = [\"arm b\"]; armed = true") +
                           action("b", "when = \"ball.y < '0.5 m'\"; do = [\"arm c\"]; armed = false") +
                           action("c", "when = \"ball.y < '0.6 m'\"; do = [\"arm b\"]; armed = false");
  std::string said;
  try {
    (void)run(ring, {"dop853", 1e-10, 2.0});
  } catch (const NumericalFailure& failure) {
    said = failure.what();
  }
  CHECK(said.find("actions set each other off without end: 'b', then 'c', then 'b' again") != std::string::npos);
}

TEST_CASE("what cannot close says how much is missing") {
  const auto message = [](const std::string& text) {
    try {
      (void)run(text, {"dop853", 1e-10, 2.0});
    } catch (const NumericalFailure& failure) {
      return std::string(failure.what());
    }
    return std::string();
  };
  const std::string ball = body("ball", "mass = 1; inertia = 1; position = [0, 1]"),
                    close = action("close", "when = \"0.1 s\"; do = [\"hold it\"]");
  CHECK(message(ball + element("revolute", "it", "a = \"ball\"; active = false") + close)
            .find("'it' cannot close: its markers would have to move by 0.9509 m") != std::string::npos);
  CHECK(message(ball +
                element("rope", "it",
                        "a = \"ball\"; b = { body = \"ground\", at = [0, 1.2] }; length = 0.24; inextensible = true; active = false") +
                close)
            .find("farther apart than its length") != std::string::npos);
}

TEST_CASE("what is wrong with an action is said with its place") {
  const auto says = [](const std::string& fields, const std::string& expected) {
    std::string said;
    try {
      (void)run(body("load", "mass = 2; inertia = 1") + element("revolute", "hook", "a = \"load\"") +
                    element("load", "push", "at = \"load\"; couple = 1") + action("drop", fields),
                {});
    } catch (const ModelError& error) {
      said = error.diagnostics().front().message;
    }
    CAPTURE(fields);
    CAPTURE(said);
    CHECK(said.find(expected) != std::string::npos);
  };
  says("when = \"2 s\"; do = [\"release hok\"]", "there is no element 'hok' (did you mean 'hook'?)");
  says("when = \"2 s\"; do = [\"relase hook\"]", "is nothing that an action does");
  says("when = \"2 s\"; do = [\"stop now\"]", "is nothing that an action does");
  says("when = \"2 s\"; do = []", "'do' is empty");
  says("when = \"2 s\"; do = [\"arm drip\"]", "there is no action 'drip' (did you mean 'drop'?)");
  says("when = \"2 s\"; do = [\"stop\", \"release hook\"]", "nothing happens behind");
  says("when = \"2 s\"; do = [\"release hook\", \"hold hook\"]", "is named in two steps");
  says("when = \"2 s\"; do = [\"set push.cuple = 1\"]", "did you mean 'couple'");
  says("when = \"2 s\"; do = [\"set push.couple = 1 N\"]", "'push.couple'");
  says("when = \"2 s\"; do = [\"set push.torque = wave\"]", "there is no signal 'wave'");
  says("when = \"2 s\"; do = [\"set push.couple = nan\"]", "a finite number");
  says("when = \"2 s\"; do = [\"set hook.angle = 1\"]", "it says where a run begins");
  says("when = \"2 m\"; do = [\"stop\"]", "no time");
  says("when = \"-2 s\"; do = [\"stop\"]", "a run begins at 0 s");
  says("when = \"load.y\"; do = [\"stop\"]", "compares nothing");
  says("when = \"load.y > '2 s'\"; do = [\"stop\"]", "unit");
  says("when = \"lod.y > '2 m'\"; do = [\"stop\"]", "did you mean 'load.y'");
  says("when = \"hok opens\"; do = [\"stop\"]", "there is no element 'hok' (did you mean 'hook'?)");
  says("when = \"hook.force_x > '2 N'\"; do = [\"stop\"]", "no force can depend on it");
  says("when = \"1 < 2\"; do = [\"stop\"]", "the same at all times");
}

TEST_CASE("actions of a part are about its own elements, and may be repeated") {
  const Model model = read_model(STEPLAP_TEST_DATA "/formulas/dropped_balls.toml", transformer_catalog());
  const Run r = run(model, {"dop853", 1e-12, 2.0, 0.1});
  for (int i = 0; i < 3; ++i) {
    const double falls = 0.5 + 0.25 * i;
    const std::string name = "rack " + std::to_string(i) + ".ball";
    REQUIRE(r.event_times("rack " + std::to_string(i) + ".drop").size() == 1);
    CHECK(std::abs(r.event_times("rack " + std::to_string(i) + ".drop").at(0) - falls) < k_tolerance);
    CHECK(std::abs(r.last(name + ".y") - (1.0 - 0.5 * k_g * (2.0 - falls) * (2.0 - falls))) < 1e-8);
  }
  CHECK(r.event_times("check 1").size() == 1);
  CHECK(std::abs(r.last("rack 1.switch.omega") - (1.0 + 20.0 * (2.0 - 0.75 - std::sqrt(1.0 / k_g)))) <
        1e-8); // 2 N m on 0.1 kg m² since its ball is 0.5 m lower
}
