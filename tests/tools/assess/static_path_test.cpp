// Rests under a pull that grows follow the way of the load: frictions in series, stops with play, ropes.
#include "tests/tools/assess/static_scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace steplap;
using namespace steplap::assess;
using steplap::testing::machine;
using steplap::testing::one_load;

namespace {

constexpr double k_g = 9.81;

// One box in the other, the outermost on the ground. Each stands on two feet with friction and has a stop with play on both sides.
struct Nest {
  std::vector<double> mass, mu, play, stiffness;
};

std::string text_of(const Nest& nest) {
  const auto n = [](double x) { return std::to_string(x); };
  std::string text;
  for (std::size_t i = 0; i < nest.mass.size(); ++i) {
    const std::string id = std::to_string(i), box = "box " + id, outer = i == 0 ? "ground" : "box " + std::to_string(i - 1);
    text += "[[body]]\nname = '" + box + "'\nmass = " + n(nest.mass[i]) + "\ninertia = " + n(nest.mass[i]) + "\nposition = [0, 1]\n";
    for (const double side : {-1.0, 1.0}) {
      const std::string place =
          ", at = [" + n(side * (1.4 - 0.2 * static_cast<double>(i))) + ", " + n(0.1 * static_cast<double>(i)) + "] }\n";
      text += "[[element]]\nkind = 'unilateral_contact'\nname = '" + std::string(side < 0.0 ? "rear " : "front ") + id +
              "'\na = { body = '" + box + "'" + place + "b = { body = '" + outer + "'" + place +
              "normal = [0, 1]\nstiffness = 1e9\ndamping = 1e5\n";
    }
    text += "[[element]]\nkind = 'coulomb_stick'\nname = 'floor " + id + "'\ncontacts = ['rear " + id + "', 'front " + id +
            "']\nstatic_friction = " + n(nest.mu[i]) + "\n";
    const std::string at_floor = ", at = [0, " + n(0.1 * static_cast<double>(i)) + "] }\n"; // so that tilting does not move the stop
    text += "[[element]]\nkind = 'spring_damper'\nname = 'stop " + id + "'\na = { body = '" + box + "'" + at_floor + "b = { body = '" +
            outer + "'" + at_floor + "axis = [1, 0]\nstiffness = " + n(nest.stiffness[i]) + "\ndamping = 1e4\ngap = " + n(nest.play[i]) +
            "\n";
  }
  return text;
}

Nest random_nest(std::mt19937& random) {
  const auto between = [&random](double low, double high) { return low + (high - low) * (static_cast<double>(random()) / 4294967295.0); };
  Nest nest;
  const std::size_t boxes = 2 + random() % 2;
  for (std::size_t i = 0; i < boxes; ++i) {
    nest.mass.push_back(between(1e3, 2e4));
    nest.mu.push_back(between(0.1, 0.4));
    nest.play.push_back(between(0.0, 5e-3));
    nest.stiffness.push_back(std::pow(10.0, between(7.0, 8.3)));
  }
  return nest;
}

} // namespace

// Floor i carries the weight of M, all boxes from i inwards, and M a goes through floor and stop together. Friction that slides forward
// at the end bears μ M g, the stop the rest: M (a − μ g), or nothing where the floor holds. Back to no pull the floor holds up to μ M g
// backward, and the stop slides back until it presses with that at most. Increments agree in
// their forces to 2e-4 each, and a way has some ten: 2e-3.
TEST_CASE("frictions in series with stops and plays: forces on the way up and back") {
  std::mt19937 random(43); // its numbers are the same everywhere
  for (int k = 0; k < 60; ++k) {
    const Nest nest = random_nest(random);
    StaticMachine nested(*machine(text_of(nest)));
    const double a = (k % 2 == 0 ? 1.0 : -1.0) * 0.5 * k_g;
    const Probe up = nested.ramped({a, 0.0});
    REQUIRE_MESSAGE(up.rest, up.failure);
    const Probe back = nested.ramped_from(up, Vec2::Zero());
    REQUIRE_MESSAGE(back.rest, back.failure);
    double inner = 0.0;
    for (std::size_t i = nest.mass.size(); i-- > 0;) {
      inner += nest.mass[i];
      const double slides = nest.mu[i] * inner * k_g, pressed = std::max(0.0, inner * std::abs(a) - slides);
      const std::string stop = "stop " + std::to_string(i) + ".force";
      CAPTURE(k);
      CAPTURE(stop);
      CHECK(std::abs(nested.value(up, stop)) == doctest::Approx(pressed).epsilon(2e-3));
      CHECK(std::abs(nested.value(back, stop)) == doctest::Approx(std::min(pressed, slides)).epsilon(2e-3));
    }
  }
}

namespace {

std::string file_of(const std::string& name) { return STEPLAP_TEST_DATA "/static_way/" + name + ".toml"; }

double value_under(const std::string& name, const Vec2& pull, const std::string& channel) {
  StaticMachine asked(*load_model(file_of(name)));
  const Probe probe = asked.ramped(pull);
  REQUIRE_MESSAGE(probe.rest, probe.failure);
  return probe.rest ? asked.value(probe, channel) : std::nan("");
}

} // namespace

// A tank of m = 26.21 t on beams with friction μ, held by chains at α = 39.2° to the deck: with the tank sliding forward the chain bears
// m (a − μ g)/(cos α + μ sin α) = 133.25 kN where it is not stretched, and 132.8 kN with the change of its angle, which slow ramps of
// runs find, too. The other chains are slack there. The beams' friction is μ (m g + T sin α) = 102.1 kN.
TEST_CASE("a load on beams in chains: what chains and beams bear at 0.8 g forward") {
  const Vec2 forward(0.8 * k_g, 0.0);
  CHECK(value_under("lorry_long", forward, "rear chains.tension") == doctest::Approx(132.8e3).epsilon(2e-3));
  CHECK(std::abs(value_under("lorry_long", forward, "oak.friction")) == doctest::Approx(102.1e3).epsilon(2e-3));
  StaticMachine lorry(*load_model(file_of("lorry_long")));
  const Probe loose = lorry.without_friction(forward);
  REQUIRE(loose.rest);
  CHECK(lorry.value(loose, "rear chains.tension") == doctest::Approx(262.2e3).epsilon(2e-3)); // μ = 0, with the chain's stretch
}

TEST_CASE("more friction of the beams' load is no hold") {
  StaticProofOptions options;
  options.directions = 0;
  const StaticProof proof = prove_statically(*load_model(file_of("false_hold_static")), one_load({0.8 * k_g, 0.0}), options);
  CHECK(proof.verdict == Verdict::reject);
  CHECK(proof.reason.find("oak.friction") != std::string::npos);
}

// The stops bear m (a − μ g) of the 17 t that slide within the box. Pulled back nothing but friction holds the box: it leaves at 0.3 g.
TEST_CASE("stops in a box that a chain holds on one side") {
  CHECK(std::abs(value_under("stops140", {0.8 * k_g, 0.0}, "stops.force")) == doctest::Approx(17e3 * (0.8 - 0.2) * k_g).epsilon(1e-3));
  StaticMachine boxes(*load_model(file_of("two_boxes")));
  const StaticRay ray = grow_pull(boxes, {-1.0, 0.0}, 0.5 * k_g);
  REQUIRE_FALSE(ray.limits.empty());
  CHECK(ray.limits.back().kind == LimitKind::ends);
  CHECK(ray.is_explained);
  CHECK(ray.limits.back().acceleration == doctest::Approx(0.3 * k_g).epsilon(1e-5));
}

// The feet slide through a play of 2 mm before a stop holds the active part: under a slowly growing pull it arrives there without velocity. At 1 g
// upwards nothing has weight, and at 1 g downwards all couples are zero by symmetry: their rounding is no difference between two paths.
TEST_CASE("a play on the path is no jump, and forces that are zero do not differ") {
  const auto model = load_model(STEPLAP_MODELS "/layouts/three_limb.toml");
  StaticProofOptions options;
  options.directions = 0;
  for (const Vec2& pull : {Vec2(k_g, 0.0), Vec2(0.0, k_g), Vec2(0.0, -k_g)}) {
    const StaticProof proof = prove_statically(*model, one_load(pull), options);
    CHECK_MESSAGE(proof.verdict == Verdict::hold, proof.reason);
  }
}

// Forces of one unit are compared with each other only: 1 N differs by half of 2 N, but by a tenth of a tenth of 100 N.
TEST_CASE("the difference between forces of two paths") {
  const double nan = std::nan("");
  using Groups = std::vector<ForcesOfUnit>;
  CHECK(largest_difference(Groups{{{1.0}}, {{100.0}}}, Groups{{{2.0}}, {{100.0}}}, 0.1) == doctest::Approx(0.5));
  CHECK(largest_difference(Groups{{{1.0, 100.0}}}, Groups{{{2.0, 100.0}}}, 0.1) == doctest::Approx(0.1));
  CHECK(largest_difference(Groups{{{0.0, nan}}}, Groups{{{0.0, nan}}}, 0.1) == 0.0);
  CHECK(std::isinf(largest_difference(Groups{{{nan}}}, Groups{{{1.0}}}, 0.1)));
  CHECK(largest_difference(Groups{{{1e-9}, 1e-6}}, Groups{{{-2e-9}, 1e-6}}, 0.1) == 0.0); // both are rounding
}
