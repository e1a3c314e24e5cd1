// One-way clutches whose bodies turn against their lock: an impulse joins them at once, by Newton's law without rebound. Truths are
// angular momentum, the least change of velocities under all locks (found by trying every set of them), and the ropes' own blows.
//
// Tolerances: a blow is a projection of velocities, exact to 1e-12 of rates near 10; a run at 1e-11 adds 1e-10.
#include "tests/physics/rest_scene.h"

#include "mbd/dynamics/dynamics.h"
#include "mbd/simulation/check_sticking.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/one_way_lock.h"
#include "mbd/trust/audit.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace steplap;
using namespace steplap::testing;
using random::RandomNumber;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p", "auto"};

struct Disc {
  double inertia = 1.0, omega = 0.0;
};
// a may overrun b with ω_a − ω_b > 0, or < 0 if `is_clockwise`; −1 is the ground.
struct Clutch {
  int a = 0, b = -1;
  bool is_clockwise = false;
};

std::string disc_name(int i) { return i < 0 ? "ground" : "disc" + std::to_string(i); }

std::string discs_text(const std::vector<Disc>& discs) {
  std::string text = k_no_gravity;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const std::string name = disc_name(static_cast<int>(i));
    text += body(name, "mass = 1.0; inertia = " + number(discs[i].inertia) + "; angular_velocity = " + number(discs[i].omega)) +
            element("revolute", "axle of " + name, "a = '" + name + "'");
  }
  return text;
}

std::string clutch_text(const std::string& name, const Clutch& clutch, const std::string& more = "") {
  return element("freewheel", name,
                 "a = '" + disc_name(clutch.a) + "'; b = '" + disc_name(clutch.b) + "'; free = '" +
                     (clutch.is_clockwise ? "clockwise" : "counter_clockwise") + "'" + more);
}

const std::string k_energies = "[output]\nalso = ['whole.*', '*.dissipated', '*.work']\n";

double energy_of(const std::vector<Disc>& discs, const std::vector<double>& omega) {
  double sum = 0.0;
  for (std::size_t i = 0; i < discs.size(); ++i) sum += 0.5 * discs[i].inertia * omega[i] * omega[i];
  return sum;
}

// The rates that the clutches of `locked` (bits) join, by groups; empty if some clutch would turn against its lock.
std::vector<double> joined(const std::vector<Disc>& discs, const std::vector<Clutch>& clutches, unsigned locked) {
  const int n = static_cast<int>(discs.size());
  std::vector<int> group(discs.size() + 1); // the last one is the ground
  for (int i = 0; i <= n; ++i) group[i] = i;
  const auto at = [n](int i) { return i < 0 ? n : i; };
  for (std::size_t c = 0; c < clutches.size(); ++c) {
    if (!(locked >> c & 1U)) continue;
    const int from = group[at(clutches[c].a)], to = group[at(clutches[c].b)];
    for (int& g : group)
      if (g == from) g = to;
  }
  std::vector<double> omega(discs.size());
  for (int i = 0; i < n; ++i) {
    double momentum = 0.0, inertia = 0.0;
    for (int j = 0; j < n; ++j)
      if (group[j] == group[i]) momentum += discs[j].inertia * discs[j].omega, inertia += discs[j].inertia;
    omega[i] = group[i] == group[n] ? 0.0 : momentum / inertia;
  }
  for (const Clutch& c : clutches) {
    const double rate = omega[c.a] - (c.b < 0 ? 0.0 : omega[c.b]);
    if ((c.is_clockwise ? -rate : rate) < -1e-12) return {};
  }
  return omega;
}

// Of all that the locks let be, the rates that are nearest in the measure of the kinetic energy: those of some set of locks.
std::vector<double> behind_the_blow(const std::vector<Disc>& discs, const std::vector<Clutch>& clutches) {
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned locked = 0; locked < 1U << clutches.size(); ++locked) {
    const std::vector<double> omega = joined(discs, clutches, locked);
    if (omega.empty()) continue;
    double change = 0.0;
    for (std::size_t i = 0; i < discs.size(); ++i) change += 0.5 * discs[i].inertia * std::pow(omega[i] - discs[i].omega, 2);
    if (change >= least) continue;
    least = change;
    best = omega;
  }
  return best;
}

// From the first sample on: no couple acts, so that rates stay what the blow has left.
void check_blow(const std::string& text, const std::vector<Disc>& discs, const std::vector<double>& truth, const Settings& settings) {
  const Run r = run(text + k_energies, settings);
  std::vector<double> omega(discs.size()), before(discs.size());
  for (std::size_t i = 0; i < discs.size(); ++i) {
    omega[i] = r.last(disc_name(static_cast<int>(i)) + ".omega");
    before[i] = discs[i].omega;
    CHECK(std::abs(omega[i] - truth[i]) < 1e-10);
  }
  const double lost = energy_of(discs, before) - energy_of(discs, truth);
  CHECK(std::abs(r.last("whole.dissipated") - lost) < 1e-9 * (1.0 + lost));
  CHECK(std::abs(r.last("whole.kinetic") - energy_of(discs, truth)) < 1e-9 * (1.0 + energy_of(discs, before)));
  CHECK(std::abs(r.last("whole.work")) < 1e-12);
}

} // namespace

TEST_CASE("two bodies that begin to turn against the lock are joined: momentum stays, energy is lost, the event tells") {
  const std::vector<Disc> discs{{2.0, 1.0}, {3.0, 5.0}};
  const double together = (2.0 * 1.0 + 3.0 * 5.0) / 5.0, reduced = 2.0 * 3.0 / 5.0;
  for (const char* method : k_methods)
    for (const bool is_mirrored : {false, true}) {
      CAPTURE(std::string(method));
      CAPTURE(is_mirrored);
      const double sign = is_mirrored ? -1.0 : 1.0;
      const std::vector<Disc> turned{{2.0, sign}, {3.0, 5.0 * sign}};
      const std::string text = discs_text(turned) + clutch_text("clutch", {0, 1, is_mirrored});
      check_blow(text, turned, {sign * together, sign * together}, {method, 1e-11, 1.0, 0.5});
      const Run r = run(text + k_energies, {method, 1e-11, 1.0, 0.5});
      CHECK(r.last("clutch.impulse") == doctest::Approx(reduced * 4.0).epsilon(1e-12));
      CHECK(r.last("clutch.dissipated") == doctest::Approx(0.5 * reduced * 16.0).epsilon(1e-12));
      CHECK(r.last("clutch.mode") == 1.0);
      REQUIRE(r.event_times("clutch", "sticks").size() == 1);
      CHECK(r.event_times("clutch", "sticks")[0] == 0.0);
      CHECK(r.result.events.front().words() == "sticks with 4.8 N m s, 9.6 J lost");
    }
}

// Behind the blow both turn with ω = (J₁ω₁ + J₂ω₂)/(J₁ + J₂), the other way than the second disc did before it.
TEST_CASE("a formula's comparisons at the start are those behind a blow") {
  for (const char* const method : k_methods) {
    CAPTURE(method);
    const std::string text =
        discs_text({{1.0, 10.0}, {1.0, -4.0}}) + clutch_text("lock", {1, 0}) +
        element("force", "drag", "a = 'disc1'; coordinate = 'angle'; formula = \"-'1 N m s2' * abs(rate) * rate\"; energy = 'dissipated'");
    Run r;
    r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
    SimulationOptions o = options({method, 1e-10, 0.5});
    o.has_extremes = true;
    r.result = simulate(*r.system, r.system->initial_state(), o);
    for (const ChannelRange& range : r.result.ranges) {
      if (range.channel->name != "drag.couple") continue;
      CHECK(range.high.value <= 0.0);
      CHECK(range.low.value == doctest::Approx(-9.0).epsilon(1e-9)); // ω = 3
    }
  }
}

TEST_CASE("turning the way that is free takes no blow, nor does a lock whose couple has a bound") {
  for (const std::string more : {"", "; drags = 0.3", "; holds = 2.0"}) {
    CAPTURE(more);
    const bool is_brake = more == "; holds = 2.0";
    const std::vector<Disc> discs{{2.0, is_brake ? 1.0 : 5.0}, {3.0, is_brake ? 5.0 : 1.0}};
    const Run r = run(discs_text(discs) + clutch_text("clutch", {0, 1}, more), {"dop853", 1e-11, 0.5, 0.5});
    const double couple = is_brake ? 2.0 : more.empty() ? 0.0 : -0.3; // on a
    CHECK(r.last("disc0.omega") == doctest::Approx(discs[0].omega + couple / 2.0 * 0.5).epsilon(1e-11));
    CHECK(r.last("disc1.omega") == doctest::Approx(discs[1].omega - couple / 3.0 * 0.5).epsilon(1e-11));
    CHECK(r.last("clutch.impulse") == 0.0);
    CHECK(r.event_times("clutch", "sticks").empty());
  }
}

// Along a chain whose clutches all refuse the same way the rates behind the blow are the weighted monotone regression of those
// before; with both ways, branches and backstops among them a least distance that is found by trying.
TEST_CASE("many clutches at once, in chains and in trees, with backstops: the least change that all locks allow") {
  RandomNumber r(7);
  int joined_ones = 0, free_ones = 0;
  for (int trial = 0; trial < 60; ++trial) {
    CAPTURE(trial);
    const bool is_chain = trial % 3 == 0;
    std::vector<Disc> discs;
    std::vector<Clutch> clutches;
    const int count = 2 + r.below(5);
    for (int i = 0; i < count; ++i) discs.push_back({r.decades(-1.0, 1.0), r.between(-5.0, 5.0)});
    for (int i = 1; i < count; ++i) clutches.push_back({i, is_chain ? i - 1 : r.below(i), !is_chain && r.chance(0.5)});
    if (!is_chain && r.chance(0.5)) clutches.push_back({r.below(count), -1, r.chance(0.5)});
    std::string text = discs_text(discs);
    for (std::size_t c = 0; c < clutches.size(); ++c) text += clutch_text("clutch" + std::to_string(c), clutches[c]);
    const std::vector<double> truth = behind_the_blow(discs, clutches);
    REQUIRE(truth.size() == discs.size());
    for (const Clutch& c : clutches) ++(std::abs(truth[c.a] - (c.b < 0 ? 0.0 : truth[c.b])) < 1e-9 ? joined_ones : free_ones);
    check_blow(text, discs, truth, {k_methods[trial % 4], 1e-11, 0.3, 0.3});
  }
  CHECK(joined_ones > 50);
  CHECK(free_ones > 30);
}

TEST_CASE("two clutches side by side share a blow, and two that face each other make a coupling") {
  const std::vector<Disc> discs{{2.0, 1.0}, {3.0, 5.0}};
  const std::string load = element("load", "there", "at = 'disc0'; torque = 'wave'") +
                           signal_entry("harmonics", "wave", "amplitudes = [7.0]; frequencies = [3.0]");
  check_blow(discs_text(discs) + clutch_text("one", {0, 1}) + clutch_text("other", {0, 1}), discs, {3.4, 3.4}, {"dop853", 1e-11, 0.3, 0.3});
  const Run r =
      run(discs_text(discs) + clutch_text("one", {0, 1}, "; drags = 0.1") + clutch_text("other", {0, 1, true}, "; drags = 0.1") + load,
          {"dop853", 1e-11, 2.1, 0.01});
  const std::vector<double> a = r.series("disc0.omega"), b = r.series("disc1.omega");
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(std::abs(a[i] - b[i]) < 1e-9);
    CHECK(std::abs(a[i] - (3.4 + 7.0 / 5.0 * std::sin(6.0 * k_pi * r.times()[i]) / (6.0 * k_pi))) < 1e-9);
  }
}

// No drag gives a capacity to compare with: what either clutch does not hold, the other holds without bound.
TEST_CASE("two clutches that face each other stay locked under a torque that changes its sign") {
  constexpr double k_turn = 6.0 * 3.14159265358979324; // rad/s of the torque, 10 N m
  const std::string text = discs_text({{0.5, 0.0}, {2.0, 0.0}}) + clutch_text("one", {0, 1, false}) + clutch_text("other", {0, 1, true}) +
                           signal_entry("sine", "sway", "amplitude = 10.0; frequency = 3.0") +
                           element("load", "drive", "at = 'disc1'; torque = 'sway'");
  for (const char* method : k_methods) {
    CAPTURE(std::string(method));
    const Run r = run(text, {method, 1e-10, 0.5, 0.01});
    CHECK(r.event_times("one").empty());
    CHECK(r.event_times("other").empty());
    const std::vector<double> one = r.series("one.couple"), other = r.series("other.couple"), omega = r.series("disc0.omega");
    for (std::size_t i = 0; i < r.times().size(); ++i) {
      const double torque = 10.0 * std::sin(k_turn * r.times()[i]);
      CHECK(std::abs(omega[i] - 10.0 / (2.5 * k_turn) * (1.0 - std::cos(k_turn * r.times()[i]))) < 1e-8);
      CHECK(std::abs(one[i] - std::max(0.0, 0.2 * torque)) < 1e-9); // 0.5 of 2.5 kg m²: each carries its sign of the torque
      CHECK(std::abs(other[i] - std::min(0.0, 0.2 * torque)) < 1e-9);
    }
  }
}

TEST_CASE("a clutch that an action closes while its bodies turn backwards joins them then") {
  const std::vector<Disc> discs{{2.0, 1.0}, {3.0, 5.0}};
  for (const char* method : k_methods)
    for (const double when : {0.25, 0.5}) {
      CAPTURE(std::string(method));
      const std::string text = discs_text(discs) + clutch_text("clutch", {0, 1}, "; active = false") + k_energies +
                               "[[action]]\nname = 'engages'\nwhen = \"t > '" + number(when) + " s'\"\ndo = ['hold clutch']\n";
      const Run r = run(text, {method, 1e-11, 1.0, 0.5});
      CHECK(std::abs(r.last("disc0.theta") - (when + 3.4 * (1.0 - when))) < 1e-9);
      CHECK(std::abs(r.last("disc1.theta") - (5.0 * when + 3.4 * (1.0 - when))) < 1e-9);
      CHECK(std::abs(r.last("whole.dissipated") - 9.6) < 1e-9);
      CHECK(std::abs(r.last("clutch.dissipated") - 9.6) < 1e-9);
      REQUIRE(r.event_times("clutch", "sticks").size() == 1);
      CHECK(std::abs(r.event_times("clutch", "sticks")[0] - when) < 1e-12);
    }
}

TEST_CASE("what an action's weld stops or takes along strikes a clutch behind it") {
  // Disc 0 overruns disc 1 until this is welded to disc 2, which turns faster than both: all go on together.
  const std::vector<Disc> discs{{2.0, 4.0}, {3.0, 1.0}, {5.0, 11.0}};
  const double all = (2.0 * 4.0 + 3.0 * 1.0 + 5.0 * 11.0) / 10.0;
  for (const char* method : k_methods) {
    CAPTURE(std::string(method));
    const std::string text = discs_text(discs) + clutch_text("clutch", {0, 1}) + k_energies +
                             element("weld", "key", "a = 'disc1'; b = 'disc2'; active = false") +
                             "[[action]]\nname = 'keyed'\nwhen = '0.5 s'\ndo = ['hold key', 'release axle of disc2']\n";
    const Run r = run(text, {method, 1e-11, 1.0, 1.0});
    for (int i = 0; i < 3; ++i) CHECK(std::abs(r.last(disc_name(i) + ".omega") - all) < 1e-9);
    CHECK(std::abs(r.last("whole.dissipated") - (0.5 * (2.0 * 16.0 + 3.0 + 5.0 * 121.0) - 5.0 * all * all)) < 1e-8);
  }
}

TEST_CASE("a rope's jerk is borne by a backstop the way that it locks, and by the drum's inertia the way that it does not") {
  const double m = 4.0, inertia = 0.7, radius = 0.5, speed = 3.0, slack = 0.6;
  const std::string scene_text =
      k_no_gravity + body("drum", "mass = 1.0; inertia = " + number(inertia)) + element("revolute", "axle", "a = 'drum'") +
      body("load", "mass = " + number(m) + "; inertia = 1.0; position = " + point(radius, -2.0) + "; velocity = " + point(0.0, -speed)) +
      element("prismatic", "guide", "a = 'load'; axis = [0.0, 1.0]") +
      element("rope", "rope",
              "a = 'load'; b = { body = 'drum', at = " + point(radius, 0.0) + " }; inextensible = true; length = " + number(2.0 + slack));
  for (const bool is_backstop : {true, false}) { // the load turns the drum clockwise
    CAPTURE(is_backstop);
    const Run r =
        run(scene_text +
                element("freewheel", "clutch", std::string("a = 'drum'; free = '") + (is_backstop ? "counter_clockwise'" : "clockwise'")) +
                k_energies,
            {"dop853", 1e-11, 0.21, 0.21});
    CHECK(r.event_times("rope").size() >= 1);
    CHECK(std::abs(r.event_times("rope").at(0) - slack / speed) < 1e-10);
    const double after = is_backstop ? 0.0 : m * speed / (m + inertia / (radius * radius));
    const double kinetic = is_backstop ? 0.0 : 0.5 * m * after * after + 0.5 * inertia * std::pow(after / radius, 2);
    CHECK(std::abs(r.last("whole.dissipated") - (0.5 * m * speed * speed - kinetic)) < 1e-8);
    CHECK(r.last("rope.impulse") == doctest::Approx(m * (speed - after)).epsilon(1e-9));
    CHECK(r.last("clutch.impulse") == doctest::Approx(is_backstop ? m * speed * radius : 0.0).epsilon(1e-9));
  }
}

TEST_CASE("a driven body takes another along at once, by work of the drive; two that are driven against the lock are refused") {
  const std::vector<Disc> discs{{2.0, 1.0}, {3.0, 5.0}};
  const std::string drive = signal_entry("constant", "five", "value = 5.0") +
                            element("prescribed_motion", "drive", "a = 'disc1'; coordinate = 'angle'; signal = 'five'; as = 'velocity'");
  const Run r = run(discs_text(discs) + clutch_text("clutch", {0, 1}) + drive + k_energies, {"dop853", 1e-11, 1.0, 1.0});
  CHECK(std::abs(r.last("disc0.omega") - 5.0) < 1e-11);
  CHECK(std::abs(r.last("whole.dissipated") - 0.5 * 2.0 * 16.0) < 1e-9);
  CHECK(std::abs(r.last("whole.work") - 2.0 * 4.0 * 5.0) < 1e-9); // the impulse J Δω at 5 rad/s
  const std::string other = signal_entry("constant", "one", "value = 1.0") +
                            element("prescribed_motion", "other", "a = 'disc0'; coordinate = 'angle'; signal = 'one'; as = 'velocity'");
  try {
    (void)run(discs_text(discs) + clutch_text("clutch", {0, 1}) + drive + other, {"dop853", 1e-11, 1.0, 1.0});
    FAIL("went on against the lock");
  } catch (const NumericalFailure& failure) {
    CHECK(std::string(failure.what()).find("'clutch' against its lock") != std::string::npos);
  }
}

TEST_CASE("time stepping, which knows no blows, comes to the same") {
  const std::vector<Disc> discs{{2.0, 1.0}, {3.0, 5.0}, {1.0, 6.0}};
  const std::vector<Clutch> clutches{{0, 1}, {1, 2}};
  const std::string text = discs_text(discs) + clutch_text("one", clutches[0]) + clutch_text("two", clutches[1]);
  const std::vector<double> truth = behind_the_blow(discs, clutches);
  const Model model = scene(text + "[simulation]\nstep = 1e-3\n");
  SimulationOptions o = options({"moreau", 1e-3, 0.5, 0.5});
  o.settings.step = 1e-3;
  const auto system = compile(model);
  const RunResult result = simulate(*system, system->initial_state(), o);
  for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(result.final_state.v[3 * (i + 1) + 2] - truth[i]) < 1e-10);
}

TEST_CASE("a locked clutch that holds back is found out, by the run and by the audit, though the couple that it holds has no bound") {
  for (const double drags : {0.0, 0.2}) {
    CAPTURE(drags);
    const std::vector<Disc> discs{{2.0, 1.0}, {3.0, 1.0}};
    const std::string text = discs_text(discs) + clutch_text("clutch", {0, 1}, "; drags = " + number(drags));
    const Model model = scene(text + "[simulation]\nstep = 1e-3\n");
    const auto system = compile(model);
    State state = system->initial_state();
    state.friction[0].phase = FrictionPhase::stick;
    std::vector<double> event_value(static_cast<std::size_t>(system->event_count), 1.0);
    // Bounds less what it bears, either way: of the way that it locks nothing is known but that it is far.
    const auto holds_back = [&](double couple) {
      event_value[system->frictions[0].first_event] = OneWayLock::k_without_bound;
      event_value[system->frictions[0].first_event + 1] = drags - couple;
      check_sticking(*system, state, nullptr, 0.5, event_value);
    };
    CHECK_NOTHROW(holds_back(drags - 0.1));
    CHECK_NOTHROW(holds_back(drags + 1e-9)); // of 2 kg m² (π/s)²: a part of 5e-11
    CHECK_THROWS_AS(holds_back(drags + 0.01), ElementFailure);

    add_audit_channels(*system, model);
    Dynamics dynamics(*system);
    dynamics.set_state(state);
    std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
    dynamics.pack(state, y.data());
    dynamics.rates(0.0, y.data(), dy.data());
    Snapshot snapshot = dynamics.snapshot(dy.data());
    const auto overload = [&](double couple) { // of the clutch's, on a
      snapshot.friction_force = &couple;
      return system->find_channel("audit: clutch.overload")->value(snapshot);
    };
    CHECK(overload(0.0) == -1.0);
    CHECK(overload(1e6) < 0.0);
    CHECK(overload(-drags - 1e-9) < 1e-6);
    CHECK(overload(-drags - 0.01) > 0.01);
  }
}
