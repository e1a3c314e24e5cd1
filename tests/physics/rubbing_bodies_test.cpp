// Friction that falls when it slides, in machines of several bodies, by time stepping. What holds in truth must hold at every step size,
// and what slides must come to the right place.
#include "tests/physics/model_text.h"
#include "tests/physics/rubbing_check.h"
#include "tests/physics/stepped.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace steplap;
using namespace steplap::testing;

namespace {

struct Family {
  const char* name;
  RubbingScene make;
  int scenes;
  int few;         ///< of them are tried with short steps, and in other ways of writing
  int least_sound; ///< of them have slips that do not hang by a hair
};

const std::vector<Family>& families() {
  static const std::vector<Family> all = {{"bodies on guides", rubbing_on_guides, 120, 12, 60},
                                          {"crates", stacked_crates, 25, 3, 12},
                                          {"limbs", limbs_on_sliding_base, 25, 3, 12}};
  return all;
}

// Bodies of 1 kg that rub on a deck of `deck` kg, which a force draws on a frictionless guide. All have the same friction.
std::string equal_bodies(int count, double deck) {
  std::string text =
      k_no_gravity +
      signal_entry("trapezoid", "pull", "peak = " + random::number(9.0 * (count + deck)) + "; rise = 0.3; fall = 0.0; duration = 10.0") +
      body("deck", "inertia = 1.0; mass = " + random::number(deck)) + element("prismatic", "road", "a = 'deck'") +
      element("load", "pull", "at = 'deck'; force_x = 'pull'");
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i);
    text += body("m" + n, "mass = 1.0; inertia = 1.0") + element("prismatic", "g" + n, "a = 'm" + n + "'") +
            element("joint_friction", "f" + n, "a = 'm" + n + "'; b = 'deck'; coordinate = 'x'; holds = 6.0; drags = 3.0");
  }
  return text;
}

std::vector<double> slips(const Run& run, const std::string& element) {
  std::vector<double> times = run.event_times(element, "slips");
  for (const char* what : {"slips forward", "slips backward"}) {
    const std::vector<double> more = run.event_times(element, what);
    times.insert(times.end(), more.begin(), more.end());
  }
  std::sort(times.begin(), times.end());
  return times;
}

} // namespace

TEST_CASE("moreau: of several bodies that rub on each other those hold that hold in truth, and the others slide as far") {
  for (const Family& family : families()) {
    CAPTURE(std::string(family.name));
    int sound = 0, holding = 0, sliding = 0;
    for (int seed = 1; seed <= family.scenes; ++seed) {
      const RubbingTruth truth(family.make, seed);
      if (!truth.is_robust()) continue;
      CAPTURE(seed);
      ++sound;
      holding += truth.holding();
      sliding += truth.sliding();
      CHECK(truth.differs(family.make, seed, 1e-3, {}) == "");
      if (seed <= family.few) CHECK(truth.differs(family.make, seed, 1e-4, {}) == "");
    }
    // The scenes have to ask something.
    CHECK(sound >= family.least_sound);
    CHECK(holding >= sound / 2);
    CHECK(sliding >= sound / 2);
  }
}

TEST_CASE("moreau: a machine of bodies that rub moves alike mirrored, and with its bodies and elements in the opposite order") {
  constexpr double k_step = 1e-3;
  for (const Family& family : families())
    for (int seed = 1; seed <= family.few; ++seed) {
      CAPTURE(std::string(family.name));
      CAPTURE(seed);
      const RubbingBodies scene = family.make(seed, {});
      const Run run = stepped(scene.text, k_step, scene.end);
      for (const Writing& writing : {Writing{-1.0, false}, Writing{1.0, true}}) {
        CAPTURE(writing.is_reversed);
        const RubbingBodies other_scene = family.make(seed, writing);
        const Run other = stepped(other_scene.text, k_step, scene.end);
        for (const std::string& friction : scene.frictions) {
          CAPTURE(friction);
          CHECK(slips(other, friction) == slips(run, friction));
          CHECK(other.event_times(friction, "sticks") == run.event_times(friction, "sticks"));
        }
        // Wrenches are settled to 1e-6 of each at worst, and so are the accelerations they give.
        const double allowed = 1e-6 * scene.acceleration * scene.end * scene.end;
        for (const std::string& place : scene.places) {
          CAPTURE(place);
          CHECK(std::abs(writing.sign * other.last(place) - run.last(place)) <= allowed);
        }
      }
    }
}

TEST_CASE("moreau: bodies with equal friction under equal loads begin to slide in the same step, though each that slides loads or relieves "
          "the others") {
  // All hold to 6 m/s²; the pull is 9 (n + M) in 0.3 s, so that they slide at 0.2 s. Then each is moved on by 3 m/s² and the deck by
  // (30 t (n + M) − 3 n)/M.
  constexpr double k_onset = 0.2, k_end = 0.25;
  for (const int count : {2, 3, 4, 7})
    for (const double deck : {0.5, 2.0, 40.0})
      for (const double step : {1e-2, 1e-3, 1e-4}) {
        CAPTURE(count);
        CAPTURE(deck);
        CAPTURE(step);
        const Run run = stepped(equal_bodies(count, deck), step, k_end);
        const std::vector<double> first = slips(run, "f0");
        REQUIRE(first.size() == 1);
        // A step has the mean of its loads, which reaches the bound half a step late.
        CHECK(first[0] >= k_onset - 1e-12);
        CHECK(first[0] <= k_onset + 1.6 * step);
        // Friction falls up to a step and a half off the onset, and a wrong 3 N, or what the load has grown by, acts so long.
        const double moved = 15.0 * k_onset * k_onset, off = 1.5 * step * (3.0 + 45.0 * step);
        for (int i = 0; i < count; ++i) {
          CAPTURE(i);
          CHECK(slips(run, "f" + std::to_string(i)) == first);
          CHECK(std::abs(run.last("m" + std::to_string(i) + ".vx") - moved - 3.0 * (k_end - k_onset)) <= off);
        }
        const double pulled = (15.0 * (count + deck) * (k_end * k_end - k_onset * k_onset) - 3.0 * count * (k_end - k_onset)) / deck;
        CHECK(std::abs(run.last("deck.vx") - moved - pulled) <= off * count / deck);
      }
}

TEST_CASE("moreau: of two equal frictions in series the one slides that moves the pulled body") {
  // 2 kg on 1 kg on the ground, both held to 6 N. The pull grows to 12 N in 1 s, so that at 0.5 s both bear 6 N. Only the upper one can
  // slide on: the lower body is pulled by 4 N then, and the ground holds it.
  const std::string text = k_no_gravity + signal_entry("trapezoid", "pull", "peak = 12.0; rise = 1.0; fall = 0.0; duration = 10.0") +
                           body("lower", "mass = 1.0; inertia = 1.0") + body("upper", "mass = 2.0; inertia = 1.0") +
                           element("prismatic", "rail", "a = 'lower'") + element("prismatic", "guide", "a = 'upper'") +
                           element("joint_friction", "on ground", "a = 'lower'; coordinate = 'x'; holds = 6.0; drags = 4.0") +
                           element("joint_friction", "on lower", "a = 'upper'; b = 'lower'; coordinate = 'x'; holds = 6.0; drags = 4.0") +
                           element("load", "pull", "at = 'upper'; force_x = 'pull'");
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    CAPTURE(step);
    const Run run = stepped(text, step, 1.0);
    CHECK(slips(run, "on ground").empty());
    REQUIRE(slips(run, "on lower").size() == 1);
    CHECK(std::abs(slips(run, "on lower")[0] - 0.5) <= 1.6 * step);
    CHECK(std::abs(run.last("lower.x")) <= 1e-12);
    // ∫ (12 t − 4)/2 from 0.5 to 1 s; late by a step and a half with 1 m/s² at the onset.
    CHECK(std::abs(run.last("upper.vx") - 1.25) <= 1.5 * step);
  }
}

TEST_CASE("moreau: friction that turns round is held by its static coefficient on the way") {
  // 1 kg slides at 1 m/s, and is pushed back with 5 N: static friction of 6 N holds it when it comes to rest, after 1/(5 + 3) s. With
  // 7 N it does not.
  for (const bool is_strong : {false, true})
    for (const double step : {1e-2, 1e-3, 1e-4}) {
      CAPTURE(is_strong);
      CAPTURE(step);
      const double push = is_strong ? 7.0 : 5.0;
      const std::string text = k_no_gravity + signal_entry("constant", "push", "value = " + random::number(-push)) +
                               body("block", "mass = 1.0; inertia = 1.0; velocity = [1.0, 0.0]") +
                               element("prismatic", "guide", "a = 'block'") +
                               element("joint_friction", "friction", "a = 'block'; coordinate = 'x'; holds = 6.0; drags = 3.0") +
                               element("load", "push", "at = 'block'; force_x = 'push'");
      const Run run = stepped(text, step, 0.5);
      const double rest = 1.0 / (push + 3.0), back = is_strong ? 4.0 * (0.5 - rest) : 0.0;
      // In the step of the turn friction acts for the whole step instead of a part of it: 2 · 3 N.
      CHECK(std::abs(run.last("block.vx") + back) <= (is_strong ? 6.0 * step : 1e-12));
      CHECK(std::abs(run.last("block.x") - (0.5 * rest - 0.5 * back * (0.5 - rest))) <= 3.0 * step);
    }
}

TEST_CASE("moreau: two equal limbs of a base begin to slide in the same step and move alike") {
  for (const double step : {1e-3, 1e-4}) {
    CAPTURE(step);
    std::string text = k_no_gravity + signal_entry("trapezoid", "pull", "peak = 4e4; rise = 0.2; fall = 0.0; duration = 10.0") +
                       body("base", "mass = 2000.0; inertia = 3000.0") + element("prismatic", "road", "a = 'base'") +
                       element("load", "pull", "at = 'base'; force_x = 'pull'");
    for (const double side : {-1.0, 1.0}) {
      const std::string name = side < 0.0 ? "left" : "right", x = side < 0.0 ? "-1.5" : "1.5";
      const auto square = [](double at, double half) {
        const std::string low = random::number(at - half), high = random::number(at + half), down = random::number(-half),
                          up = random::number(half);
        return "[[" + low + ", " + down + "], [" + high + ", " + down + "], [" + high + ", " + up + "], [" + low + ", " + up + "]]";
      };
      text += body(name, "mass = 1000.0; inertia = 500.0; position = [" + x + ", 0.05]") +
              element("step_lap_joint", name + " joint", "limb = '" + name + "'; active_part = 'base'") +
              element("step_lap_interface", name + " corner",
                      "joint = '" + name + " joint'; yoke = " + square(1.5 * side, 1.0) + "; limb = " + square(1.5 * side, 0.3) +
                          "; count = 100; static_friction = 0.25; kinetic_friction = 0.1; pressure = 700.0");
    }
    const Run run = stepped(text, step, 0.3);
    REQUIRE(slips(run, "left joint").size() == 1);
    CHECK(slips(run, "right joint") == slips(run, "left joint"));
    // Both limbs stand 0.05 m above their sheets' middles, so that they move alike; wrenches are settled to 1e-8 of each.
    CHECK(std::abs(run.last("left.vx") - run.last("right.vx")) <= 1e-6 * std::abs(run.last("left.vx")));
    CHECK(std::abs(run.last("left.omega") - run.last("right.omega")) <= 1e-6 * std::abs(run.last("left.omega")));
  }
}
