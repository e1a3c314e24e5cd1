// Time stepping with joints, drives and friction: it comes to the answer of the methods that locate
// events, at first order, whatever holds the bodies between which friction acts.
#include "mbd/integrators/time_stepping.h"
#include "tests/physics/model_text.h"
#include "tests/physics/stepped.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

struct Case {
  const char* name;
  std::string (*text)(double mass); ///< of the body that joints and drives hold or lead
  std::vector<double> masses;
  double end;
  std::string element;               ///< whose slips and sticks are compared
  std::vector<std::string> channels; ///< of the end state
};

// Two square sheets: the limb's on the larger yoke's.
std::string sheets(double pressure) {
  return element("step_lap_joint", "joint", "limb = 'limb'; active_part = 'base'") +
         element("step_lap_interface", "corner",
                 "joint = 'joint'; yoke = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]; "
                 "limb = [[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3], [-0.3, 0.3]]; count = 100; "
                 "static_friction = 0.25; pressure = " +
                     number(pressure));
}

// A limb on a base that is welded to the ground away from its centre, pulled and turned.
std::string on_welded_base(double base_mass) {
  return k_no_gravity + signal_entry("trapezoid", "ramp", "peak = 1.8e6; rise = 0.1; fall = 0.0; duration = 10.0") +
         signal_entry("half_sine", "turn", "peak = 4e4; duration = 0.06") + body("base", "inertia = 500.0; mass = " + number(base_mass)) +
         body("limb", "mass = 1000.0; inertia = 700.0") + sheets(1e5) +
         element("load", "pull", "at = 'limb'; force_x = 'ramp'; torque = 'turn'") +
         element("weld", "held", "a = { body = 'base', at = [0.4, -0.7] }; b = { body = 'ground', at = [0.4, -0.7] }");
}

// A limb on a base that a drive moves along a guide; the guide's reactions must not let it go
// sooner or later.
std::string on_guided_base(double base_mass) {
  return signal_entry("haversine", "braking", "peak = -18.0; start = 0.005; duration = 0.06") +
         body("base", "inertia = 50.0; mass = " + number(base_mass)) +
         body("limb", "mass = 9000.0; inertia = 4000.0; position = [0.0, 0.1]") + sheets(1.5e4) +
         element("prescribed_motion", "brake", "a = 'base'; coordinate = 'x'; signal = 'braking'; as = 'acceleration'") +
         element("prismatic", "road",
                 "a = { body = 'base', at = [0.0, -0.5] }; b = { body = 'ground', at = [0.0, -0.5] "
                 "}; axis = [1.0, 0.0]");
}

// The same by a drive and a guide that are no single coordinate of one body: rows, not locks.
std::string on_base_guided_askew(double base_mass) {
  return k_no_gravity + signal_entry("haversine", "braking", "peak = -18.0; start = 0.005; duration = 0.06") +
         body("base", "inertia = 50.0; mass = " + number(base_mass)) +
         body("limb", "mass = 9000.0; inertia = 4000.0; position = [0.0, 0.1]") + sheets(1.5e4) +
         element("prescribed_motion", "brake",
                 "a = { body = 'base', at = [0.2, 0.3] }; b = { body = 'ground', at = [0.2, 0.3], "
                 "angle = '30 deg' }; coordinate = 'x'; "
                 "signal = 'braking'; as = 'acceleration'") +
         element("prismatic", "road",
                 "a = { body = 'base', at = [0.0, -0.5] }; b = { body = 'ground', at = [0.0, "
                 "-0.5], angle = '30 deg' }; axis = [1.0, 0.0]");
}

// A block on a table of two welded bodies that a drive moves along a guide.
std::string on_moved_table(double table_mass) {
  const auto foot = [](const std::string& name, double x) {
    return element("unilateral_contact", name,
                   "a = { body = 'block', at = [" + number(x) +
                       ", 0.0] }; b = { body = 'top', at = [0.0, 0.0] }; normal = [0.0, 1.0]; "
                       "stiffness = 2e5; damping = 400.0; preload = 49.05");
  };
  return signal_entry("haversine", "shove", "peak = 9.0; duration = 0.2") +
         body("block", "mass = 10.0; inertia = 0.4; position = [0.0, 0.1]") + body("top", "inertia = 3.0; mass = " + number(table_mass)) +
         body("frame", "mass = 20.0; inertia = 5.0; position = [0.3, -0.4]") + element("weld", "bolts", "a = 'top'; b = 'frame'") +
         foot("rear", -0.4) + foot("front", 0.4) +
         element("coulomb_stick", "friction", "contacts = ['rear', 'front']; static_friction = 0.5; kinetic_friction = 0.4") +
         element("prescribed_motion", "drive", "a = 'frame'; coordinate = 'x'; signal = 'shove'; as = 'acceleration'") +
         element("prismatic", "guide", "a = 'frame'; axis = [1.0, 0.0]; b = { body = 'ground', at = [0.3, -0.4] }");
}

// The same block on a table that is welded to the ground, drawn by its own load through an arm on a
// pin.
std::string drawn_by_arm(double table_mass) {
  const auto foot = [](const std::string& name, double x) {
    return element("unilateral_contact", name,
                   "a = { body = 'block', at = [" + number(x) +
                       ", 0.0] }; b = { body = 'table', at = [0.0, 0.0] }; normal = [0.0, 1.0]; "
                       "stiffness = 2e5; damping = 400.0; preload = 63.765");
  };
  return signal_entry("half_sine", "tug", "peak = 260.0; duration = 0.15") +
         body("block", "mass = 10.0; inertia = 0.4; position = [0.0, 0.1]") +
         body("arm", "mass = 3.0; inertia = 0.2; position = [0.0, -0.2]") + body("table", "inertia = 3.0; mass = " + number(table_mass)) +
         element("weld", "bolts", "a = 'table'") + foot("rear", -0.4) + foot("front", 0.4) +
         element("coulomb_stick", "friction", "contacts = ['rear', 'front']; static_friction = 0.5") +
         element("revolute", "pin", "a = { body = 'arm', at = [0.0, 0.1] }; b = 'block'") +
         element("load", "tug", "at = 'arm'; force_x = 'tug'");
}

// A pendulum in a bearing with dry friction, on a bracket that is welded to the ground.
std::string pendulum(double bracket_mass) {
  return signal_entry("harmonics", "sway", "amplitudes = [40.0]; frequencies = [2.5]") +
         body("bob", "mass = 4.0; inertia = 0.3; position = [0.0, -0.6]") +
         body("bracket", "inertia = 2.0; mass = " + number(bracket_mass)) + element("weld", "bolts", "a = 'bracket'") +
         element("revolute", "bearing", "a = { body = 'bob', at = [0.0, 0.0] }; b = 'bracket'") +
         element("joint_friction", "friction", "a = 'bob'; b = 'bracket'; coordinate = 'angle'; holds = 14.0; drags = 11.0") +
         element("load", "sway", "at = 'bob'; torque = 'sway'");
}

// Three parallel cranks carry a beam: one of them more than it takes, so that rows depend on each
// other.
std::string parallel_cranks(double beam_mass) {
  std::string text = signal_entry("half_sine", "shove", "peak = 90.0; duration = 0.12") +
                     body("beam", "inertia = 2.0; position = [0.0, -0.5]; mass = " + number(beam_mass));
  for (const std::string i : {"-1.0", "0.0", "1.0"})
    text += body("crank" + i, "mass = 1.0; inertia = 0.05; position = [" + i + ", -0.25]") +
            element("revolute", "top" + i,
                    "a = { body = 'crank" + i + "', at = [" + i + ", 0.0] }; b = { body = 'ground', at = [" + i + ", 0.0] }") +
            element("revolute", "end" + i,
                    "a = { body = 'crank" + i + "', at = [" + i + ", -0.5] }; b = { body = 'beam', at = [" + i + ", -0.5] }");
  return text + element("joint_friction", "friction", "a = 'crank0.0'; coordinate = 'angle'; holds = 12.0") +
         element("load", "shove", "at = 'beam'; force_x = 'shove'");
}

std::vector<Case> cases() {
  const std::vector<std::string> limb = {"limb.x", "limb.theta", "limb.vx", "limb.omega"};
  return {{"limb on a welded base", on_welded_base, {5.0, 500.0, 1e4}, 0.08, "joint", limb},
          {"limb on a guided and driven base", on_guided_base, {10.0, 1e3, 1e5}, 0.1, "joint", limb},
          {"limb on a base guided askew", on_base_guided_askew, {10.0, 1e5}, 0.1, "joint", limb},
          {"block on a moved table", on_moved_table, {1.0, 1e4}, 0.3, "friction", {"block.x", "block.vx", "block.theta"}},
          {"block drawn by an arm", drawn_by_arm, {1.0, 1e4}, 0.3, "friction", {"block.x", "arm.theta", "arm.omega"}},
          {"pendulum on a welded bracket", pendulum, {1.0, 1e4}, 0.5, "friction", {"bob.theta", "bob.omega"}},
          {"parallel cranks, light beam", parallel_cranks, {2.0}, 0.3, "friction", {"beam.x", "crank1.0.theta"}},
          {"parallel cranks, heavy beam", parallel_cranks, {200.0}, 0.3, "friction", {"beam.x", "crank1.0.theta"}}};
}

// Slips and sticks behind the start; a slip that turns round may stick for a step on its way, which is left out.
std::vector<double> changes(const Run& r, const std::string& element, double step) {
  std::vector<double> times;
  bool was_stick = false;
  for (const Event& event : r.result.events) {
    if (event.element != element || event.kind == EventKind::changes_foot || event.is_at_start()) continue;
    const bool is_stick = event.kind == EventKind::sticks;
    if (!is_stick && was_stick && event.t - times.back() <= 1.5 * step) times.pop_back();
    times.push_back(event.t);
    was_stick = is_stick;
  }
  return times;
}

// Worst of the channels at the end, each by the largest value it has in the run.
double end_error(const Run& r, const Run& exact, const std::vector<std::string>& channels) {
  double worst = 0.0;
  for (const std::string& channel : channels) {
    double size = 1e-9;
    const auto values = exact.series(channel);
    for (const double value : values) size = std::max(size, std::abs(value - values.front()));
    worst = std::max(worst, std::abs(r.last(channel) - exact.last(channel)) / size);
  }
  return worst;
}

} // namespace

TEST_CASE("moreau: friction with joints and drives comes to the exact slips and end states at "
          "first order") {
  constexpr double k_long = 1e-3, k_short = 5e-5;
  for (const Case& c : cases()) {
    CAPTURE(std::string(c.name));
    // What a body weighs that joints and drives lead all the way changes no motion: one reference,
    // of the heaviest.
    const Run exact = run(c.text(c.masses.back()), {"dop853", 1e-10, c.end, c.end / 50});
    const std::vector<double> expected = changes(exact, c.element, 0.0);
    REQUIRE(!expected.empty());
    for (const double mass : c.masses) {
      CAPTURE(mass);
      double error[2] = {}; // the worst of a few steps, as it hangs on where in a step a slip falls
      for (const int trial : {0, 1, 2, 3, 4, 5}) {
        const int i = trial % 2;
        const double step = (i == 0 ? k_long : k_short) * (1.0 - 0.07 * (trial / 2));
        CAPTURE(step);
        const Run r = stepped(c.text(mass), step, c.end);
        const std::vector<double> found = changes(r, c.element, step);
        REQUIRE(found.size() == expected.size());
        // Changes are noted at a step's end: up to one step late; and friction takes the mean of a
        // step, that is what it needs half a step before.
        CHECK(std::abs(found.front() - expected.front()) <= 1.5 * step);
        // Later ones follow a motion that is off by about a step, too.
        for (std::size_t n = 1; n < found.size(); ++n) CHECK(std::abs(found[n] - expected[n]) <= 2.0 * step);
        error[i] = std::max(error[i], end_error(r, exact, c.channels));
      }
      // First order makes it a twentieth; where in a step a slip falls changes that by less than a
      // factor of two.
      CAPTURE(error[0]);
      CHECK(error[1] <= 0.1 * error[0]);
    }
  }
}

TEST_CASE("moreau: friction on a driven coordinate slides at the drive's rate and takes its work") {
  // A wheel on a pin, turned through sin: friction of 1 N m takes 1 N m times the angle gone, 4 ×
  // 0.2 rad.
  const std::string text = k_no_gravity + signal_entry("harmonics", "swing", "amplitudes = [0.2]; frequencies = [2.0]") +
                           body("wheel", "mass = 1.0; inertia = 0.1; angle = 0.2") + element("revolute", "pin", "a = 'wheel'") +
                           element("prescribed_motion", "drive", "a = 'wheel'; coordinate = 'angle'; signal = 'swing'; as = 'position'") +
                           element("joint_friction", "bearing", "a = 'wheel'; coordinate = 'angle'; holds = 1.0");
  const double step = 1e-4;
  const Run r = stepped(text, step, 0.5, 0.01);
  CHECK(r.result.statistics.dissipated == doctest::Approx(0.8).epsilon(1e-3)); // first order: step × 2π·2 Hz
  for (const double couple : r.series("bearing.friction")) CHECK(std::abs(couple) <= 1.0);
}

TEST_CASE("moreau: two feet with friction of their own, nearly dependent rows, lose only what "
          "sliding takes") {
  // A box turned by a jolt rocks on two feet without dampers. Its feet move against each other, by
  // what it turns: that takes μN over some 1e-8 m, nothing beside the energy of the rocking, 2e-4
  // J.
  const auto foot = [](const std::string& name, const char* x) {
    return element("unilateral_contact", name,
                   std::string("a = { body = 'box', at = [") + x + ", 0.0] }; b = { body = 'ground', at = [" + x +
                       ", 0.0] }; stiffness = 1e5; preload = 49.05") +
           element("coulomb_stick", name + " friction", "contacts = ['" + name + "']; static_friction = 0.3");
  };
  const std::string text = body("box", "mass = 10.0; inertia = 1.0; position = [0.0, 0.25]; angular_velocity = 0.02") +
                           foot("rear", "-0.5") + foot("front", "0.5");
  const Run r = stepped(text, 2e-5, 0.1, 1e-3);
  double largest = 0.0;
  for (const double omega : r.series("box.omega")) largest = std::max(largest, std::abs(omega));
  CHECK(largest >= 0.0199);
  CHECK(r.result.statistics.energy_residual <=
        0.15 * 0.5 * 1.0 * 0.02 * 0.02); // T = 28 ms: 2π²h/T = 1.4 % of the amplitude a period, 10 % of the energy in all
}

TEST_CASE("moreau: no step of rounding length, and none decides anything") {
  // A sheet that holds at half of what it bears, on a machine that moves: nothing ever slips. The
  // ends and the steps are such that sums of steps end beside them.
  const std::string text = signal_entry("trapezoid", "ramp", "peak = 45.0; rise = 0.03; fall = 0.0; duration = 10.0") +
                           body("block", "mass = 10.0; inertia = 0.4; position = [0.0, 0.1]; velocity = [3.0, 0.0]") +
                           body("sledge", "mass = 50.0; inertia = 4.0; velocity = [3.0, 0.0]") +
                           element("prismatic", "road", "a = 'sledge'; axis = [1.0, 0.0]") +
                           element("prismatic", "guide", "a = 'block'; b = 'sledge'; axis = [1.0, 0.0]") +
                           element("joint_friction", "brake", "a = 'block'; b = 'sledge'; coordinate = 'x'; holds = 80.0") +
                           element("load", "pull", "at = 'block'; force_x = 'ramp'");
  for (const double step : {1e-4, 3e-5, 1e-5})
    for (const double end : {0.1, 0.3}) {
      CAPTURE(step);
      CAPTURE(end);
      const Run r = stepped(text, step, end);
      CHECK(changes(r, "brake", 0.0).empty());
      // Two pieces, to and from the kink at 0.03 s, each of whole steps that are no longer than
      // asked for.
      CHECK(r.result.statistics.steps <= static_cast<long>(std::ceil(0.03 / step - 1e-6) + std::ceil((end - 0.03) / step - 1e-6)));
    }
}

TEST_CASE("time stepping: a step of rounding length changes no mode and no phase") {
  const auto system = compile(scene(drawn_by_arm(50.0) + "\n[simulation]\nstep = 1e-3\n"));
  Dynamics dynamics(*system);
  TimeStepping stepping(*system);
  State state = system->initial_state();
  for (int i = 1; i <= 60; ++i) {
    stepping.step(dynamics, state, 1e-3 * i, 1e-12);
    for (const double tiny : {1e-17, 1e-15, 1e-12, 1e-10}) {
      const State before = state;
      stepping.step(dynamics, state, state.t + tiny, 1e-12);
      CHECK(state.mode == before.mode);
      CHECK(state.friction[0].phase == before.friction[0].phase);
      CHECK(state.friction[0].slid == before.friction[0].slid);
      for (std::size_t k = 0; k < state.q.size(); ++k) // as far as the velocities go, 10 m/s
        CHECK(std::abs(state.q[k] - before.q[k]) <= 10.0 * tiny + 1e-15);
    }
  }
}
