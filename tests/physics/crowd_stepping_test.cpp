// Crowds of bodies by time stepping: what a step costs, counted, and friction that holds exactly.
#include "mbd/integrators/time_stepping.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"
#include "tests/physics/stepped.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

using namespace steplap;
using namespace steplap::testing;

namespace {

// Blocks of 10 kg on a deck on two legs, so stiff that the sag under the weight is over after a few steps. A load pushes each block; the share of
// μ N = 29 N grows from block to block, up to `most`.
std::string blocks_on_deck(int count, double most) {
  const auto number = [](double x) { return std::to_string(x); };
  std::string text = body("deck", "mass = 5e3; inertia = 1e6");
  for (const double x : {-0.5 * count, 0.5 * count})
    text += element("bushing", x < 0.0 ? "left leg" : "right leg",
                    "a = { body = 'deck', point = [" + number(x) + ", 0.0] }; b = { body = 'ground', at = [" + number(x) +
                        ", 0.0] }; stiffness = [1e12, 1e12]; damping = [1e7, 1e7]; rotational_stiffness = 1e12");
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i);
    const double x = i - 0.5 * count + 0.5;
    text += body("block " + n, "mass = 10.0; inertia = 0.5; position = [" + number(x) + ", 0.2]");
    for (const double along : {-0.2, 0.2})
      text += element("unilateral_contact", (along < 0.0 ? "left foot " : "right foot ") + n,
                      "a = { body = 'block " + n + "', point = [" + number(along) + ", -0.2] }; b = { body = 'deck', point = [" +
                          number(x + along) + ", 0.0] }; stiffness = 1e7; damping = 1e3; preload = 49.03325");
    text += element("coulomb_stick", "friction " + n, "contacts = ['left foot " + n + "', 'right foot " + n + "']; static_friction = 0.3") +
            signal_entry("trapezoid", "push " + n,
                         "peak = " + number(29.4 * most * (i + 1) / count) + "; rise = 0.02; fall = 0.0; duration = 1.0") +
            element("load", "push " + n, "at = 'block " + n + "'; force_x = 'push " + n + "'");
  }
  return text;
}

// The same blocks without loads and deck, let go above the ground from different heights, with a velocity along it.
std::string blocks_above_ground(int count, double along) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i);
    const double x = i - 0.5 * count + 0.5, height = 1e-3 + 0.019 * (7 * i % count) / count;
    text += body("block " + n, "mass = 10.0; inertia = 0.5; position = [" + std::to_string(x) + ", " + std::to_string(0.2 + height) +
                                   "]; velocity = [" + std::to_string(along) + ", 0.0]");
    for (const double side : {-0.2, 0.2})
      text += element("unilateral_contact", (side < 0.0 ? "left foot " : "right foot ") + n,
                      "a = { body = 'block " + n + "', point = [" + std::to_string(side) + ", -0.2] }; b = { body = 'ground', point = [" +
                          std::to_string(x + side) + ", 0.0] }; stiffness = 1e7; damping = 1e3");
    text += element("coulomb_stick", "friction " + n, "contacts = ['left foot " + n + "', 'right foot " + n + "']; static_friction = 0.3");
  }
  return text;
}

struct Crowd {
  std::unique_ptr<const System> system;
  std::unique_ptr<Dynamics> dynamics;
  State state;
  long extra_parts = 0;

  explicit Crowd(const std::string& text) : system(compile(scene(text + "\n[simulation]\nstep = 1e-3\n"))) {
    dynamics = std::make_unique<Dynamics>(*system);
    state = system->initial_state();
  }
  void step(int steps) {
    TimeStepping stepping(*system);
    for (int i = 1; i <= steps; ++i) stepping.step(*dynamics, state, 1e-3 * i, 1e-12);
    extra_parts = stepping.extra_parts();
  }
  // Returns the rate of a friction row at the state, m/s.
  [[nodiscard]] double rate(int friction) {
    dynamics->set_state(state);
    std::vector<double> y(dynamics->dimension()), dy(dynamics->dimension());
    dynamics->pack(state, y.data());
    dynamics->rates(state.t, y.data(), dy.data());
    const RowSpec* const rows = system->frictions[friction].friction->rows(state.friction[friction]);
    return evaluate_row<false>(rows[0], dynamics->motion().data()).rate;
  }
  // Returns the number of entries of both vectors of unit forces along x on all bodies.
  [[nodiscard]] double entries() {
    dynamics->set_state(state);
    std::vector<double> y(dynamics->dimension());
    dynamics->pack(state, y.data());
    Linearization linearization;
    linearization.evaluate(*dynamics, state.t, y.data());
    StageSystem stages;
    stages.set(linearization, dynamics->layout());
    REQUIRE(stages.factor(1e-3));
    SparseVectors vectors;
    for (int k = 0; k < dynamics->coordinate_count(); k += 3) {
      const ForceRow row{1, {k}, {1.0}};
      stages.append_force(row, vectors);
      stages.append_rate(row, vectors);
    }
    return static_cast<double>(vectors.place.size());
  }
};

} // namespace

TEST_CASE("moreau: what a force on one body of a crowd reaches does not grow with the crowd") {
  // Each block meets the deck only, so a row reaches these two, whatever the order of elimination: six of the unknowns.
  // Twice the blocks have twice the entries; the deck's own make the difference from two.
  const double twenty = Crowd(blocks_on_deck(20, 0.9)).entries(), forty = Crowd(blocks_on_deck(40, 0.9)).entries(),
               eighty = Crowd(blocks_on_deck(80, 0.9)).entries();
  CHECK(forty <= 2.05 * twenty);
  CHECK(eighty <= 2.05 * forty);
}

TEST_CASE("moreau: a step of a crowd takes as many evaluations whatever the number of bodies") {
  const auto evaluations = [](int count) {
    Crowd crowd(blocks_on_deck(count, 0.9));
    crowd.step(40);
    return static_cast<double>(crowd.dynamics->evaluations());
  };
  // All blocks press and hold, and their passes are made together. A pass more where one of them ends near its tolerance is a third.
  const double ten = evaluations(10);
  for (const int count : {20, 40}) {
    CAPTURE(count);
    CHECK(evaluations(count) <= 1.34 * ten);
  }
}

TEST_CASE("moreau: of a crowd that is pushed, those pushed beyond their bounds slide, and the others do not creep") {
  // The pushes are between 1/40 and 40/40 of 1.2 μ N: those of blocks 34 to 40 are beyond μ N, that of 33 is 0.99 of it.
  constexpr int k_blocks = 40;
  Crowd crowd(blocks_on_deck(k_blocks, 1.2));
  crowd.step(40);
  for (int i = 0; i < k_blocks; ++i) {
    CAPTURE(i);
    const bool slips = crowd.state.friction[i].phase == FrictionPhase::slip;
    CHECK(slips == (i >= 33));
    // Friction changes the velocity by 3e-3 m/s in a step, to 1e-8 of that (time_stepping.cpp); blocks that slide are faster than 1e-3 m/s.
    if (!slips) CHECK(std::abs(crowd.rate(i)) <= 3e-11);
  }
}

TEST_CASE("moreau: the landings of a crowd do not multiply the steps of all") {
  const auto land = [](int count) {
    Crowd crowd(blocks_above_ground(count, 1e-3));
    crowd.step(100); // the last block lands after 63 ms
    CAPTURE(count);
    // A landing is no reason to halve a step; with halves for each, 40 blocks had 26 parts more.
    CHECK(crowd.extra_parts == 0);
    return static_cast<double>(crowd.dynamics->evaluations());
  };
  // A step is repeated if any contact changes, and passes for all are made together. With more blocks more of the steps are repeated,
  // but none is divided: the evaluations of a step grow far slower than the blocks.
  const double ten = land(10), twenty = land(20), forty = land(40);
  CHECK(twenty <= 1.25 * ten);
  CHECK(forty <= 1.25 * twenty);
}

// A block of 10 kg on two undamped feet, `height` above the ground.
std::string block_on_springs(double height, double stiffness) {
  std::string text = body("block", "mass = 10.0; inertia = 0.5; position = [0.0, " + std::to_string(0.2 + height) + "]");
  for (const char* const x : {"-0.2", "0.2"})
    text += element("unilateral_contact", std::string("foot at ") + x,
                    std::string("a = { body = 'block', point = [") + x + ", -0.2] }; b = { body = 'ground', point = [" + x +
                        ", 0.0] }; stiffness = " + std::to_string(stiffness));
  return text;
}

TEST_CASE("moreau: a block that falls on undamped feet rebounds with the energy that it had, whatever their stiffness") {
  // In a step the feet vibrate by 0.1, 1.4 and 14 rad. Free flight by implicit Euler loses ½ g² h t of ½ v² + g y. The share of the first
  // closed step is known to 2 %, and so is the energy of the stiffest feet, which compress and release within two steps.
  constexpr double k_fall = 0.01, k_step = 1e-3, k_end = 0.1, k_gravity = 9.81, k_share = 0.02;
  for (const double stiffness : {5e4, 1e7, 1e9}) {
    CAPTURE(stiffness);
    const Run run = stepped(block_on_springs(k_fall, stiffness), k_step, k_end, k_step);
    const std::vector<double> y = run.series("block.y"), v = run.series("block.vy");
    double least = 1.0, most = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      if (y[i] < 0.2) continue; // it presses
      const double energy = (0.5 * v[i] * v[i] + k_gravity * (y[i] - 0.2)) / (k_gravity * k_fall);
      least = std::min(least, energy);
      most = std::max(most, energy);
    }
    CHECK(*std::max_element(v.begin(), v.end()) > 0.3); // it has rebounded; it fell with 0.44 m/s
    CHECK(least >= 1.0 - 0.5 * k_gravity * k_step * k_end / k_fall - k_share);
    CHECK(most <= 1.0 + 1e-12);
  }
}

TEST_CASE("moreau: a block let go just above the ground comes to rest") {
  // It closes with 0.014 m/s, by which weight changes its velocity in 1.4 steps: a rebound would be over before the steps show it.
  const Run rest = stepped(block_on_springs(1e-5, 1e7), 1e-3, 0.1);
  CHECK(rest.result.events.size() == 2); // each foot closes, once
  CHECK(std::abs(rest.result.final_state.v[4]) <= 1e-9);
}

TEST_CASE("moreau: blocks that land one after the other follow the motion with exact events within a step of their fall") {
  // They fall up to 20 mm, with up to 0.63 m/s, by which they move 0.6 mm in a step. Without rebounds the error was 3.4 mm.
  constexpr double k_step = 1e-3, k_end = 0.1;
  const std::string text = blocks_above_ground(10, 0.0);
  const Run stepping = stepped(text, k_step, k_end, k_step), exact = run(text, {"dop853", 1e-9, k_end, k_step});
  double square = 0.0;
  for (int block = 0; block < 10; ++block) {
    const std::string channel = "block " + std::to_string(block) + ".y";
    const std::vector<double> mine = stepping.series(channel), theirs = exact.series(channel);
    REQUIRE(mine.size() == theirs.size());
    for (std::size_t i = 0; i < mine.size(); ++i)
      square += (mine[i] - theirs[i]) * (mine[i] - theirs[i]) / (10.0 * static_cast<double>(mine.size()));
  }
  CHECK(std::sqrt(square) <= 0.63 * k_step);
}

TEST_CASE("a block that lands with a velocity slips until its friction has stopped it, by every method") {
  // It falls 1 mm and moves at 1 mm/s. μ N/m reaches 40 m/s² within a step, so it slides for a small part of a step and a micrometre at most.
  constexpr double k_speed = 1e-3, k_step = 1e-3;
  for (const char* method : {"moreau", "dop853"})
    for (const double along : {k_speed, -k_speed, 0.0}) {
      CAPTURE(std::string(method));
      CAPTURE(along);
      const std::unique_ptr<const System> system = compile(scene(blocks_above_ground(1, along) + "\n[simulation]\nstep = 1e-3\n"));
      SimulationOptions options;
      options.end = options.output_step = 0.02; // it lands after 14 ms
      options.integrator = method;
      options.settings.step = k_step;
      const RunResult result = simulate(*system, system->initial_state(), options);
      const auto found = [&](EventKind kind) {
        return std::find_if(result.events.begin(), result.events.end(),
                            [&](const Event& e) { return e.element == "friction 0" && e.kind == kind; });
      };
      const auto slip = found(along > 0.0 ? EventKind::slips_forward : EventKind::slips_backward);
      CHECK((slip != result.events.end()) == (along != 0.0));
      CHECK(found(EventKind::sticks) != result.events.end());
      if (along != 0.0) CHECK(std::abs(slip->t - std::sqrt(2e-3 / 9.81)) <= 2.0 * k_step);
    }
}

TEST_CASE("moreau: what a block slides at its landing is less than its velocity times the step") {
  for (const double along : {1e-3, 0.0}) {
    CAPTURE(along);
    Crowd crowd(blocks_above_ground(1, along));
    crowd.step(16); // it lands after 14 ms
    const FrictionState& friction = crowd.state.friction[0];
    CHECK(friction.phase == FrictionPhase::stick);
    CHECK(friction.has_slipped == (along > 0.0));
    CHECK((friction.slid > 0.0) == (along > 0.0));
    CHECK(friction.slid <= along * 1e-3);
  }
}
