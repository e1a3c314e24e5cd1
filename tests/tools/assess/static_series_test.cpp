// Frictions in series: the search for rest puts the whole pull on at once, and can pass the rest of a pull that grows. Friction forces beyond
// that are no proof; what holds the machine next to friction is on the safe side.
#include "tests/tools/assess/static_scene.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <random>

using namespace steplap;
using namespace steplap::assess;
using steplap::testing::machine;
using steplap::testing::one_load;

namespace {

constexpr double k_g = 9.81;

// One box in the other, the outermost on the ground. Each stands on two feet with friction and has a stop with play on both sides.
struct Nest {
  std::vector<double> mass, friction, play, stiffness;
  double limit = 0.0; ///< of the friction of the outermost floor, N; 0: none
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
            "']\nstatic_friction = " + n(nest.friction[i]) + "\n";
    const std::string at_floor = ", at = [0, " + n(0.1 * static_cast<double>(i)) + "] }\n"; // so that tilting does not move the stop
    text += "[[element]]\nkind = 'spring_damper'\nname = 'stop " + id + "'\na = { body = '" + box + "'" + at_floor + "b = { body = '" +
            outer + "'" + at_floor + "axis = [1, 0]\nstiffness = " + n(nest.stiffness[i]) + "\ndamping = 1e4\ngap = " + n(nest.play[i]) +
            "\n[[acceptance]]\nname = 'stop " + id + "'\nchannel = 'stop " + id + ".force'\nwithin = 1e9\n";
    if (nest.limit > 0.0 && i == 0)
      text += "[[acceptance]]\nname = 'floor'\nchannel = 'floor 0.friction'\nwithin = " + n(nest.limit) + "\n";
  }
  return text;
}

Nest random_nest(std::mt19937& random) {
  const auto between = [&random](double low, double high) { return low + (high - low) * (static_cast<double>(random()) / 4294967295.0); };
  Nest nest;
  const std::size_t boxes = 1 + random() % 3;
  for (std::size_t i = 0; i < boxes; ++i) {
    nest.mass.push_back(between(1e3, 2e4));
    nest.friction.push_back(between(0.1, 0.4));
    nest.play.push_back(between(0.0, 5e-3));
    nest.stiffness.push_back(std::pow(10.0, between(7.0, 8.3)));
  }
  return nest;
}

StaticProof proof_of(const LoadedModel& loaded, const Vec2& pull) {
  StaticProofOptions options;
  options.directions = 0;
  return prove_statically(loaded, one_load(pull), options);
}

} // namespace

// Floor i carries the weight of M, all boxes from i inwards, and M a goes through floor and stop together. Friction that slides forward
// carries μ M g, the stop the rest: M (a − μ g), or nothing where the floor holds. STEPLAP_SERIES_MACHINES is the number of machines.
TEST_CASE("frictions in series: a limit on a friction force is never held by mistake, and stops carry at least what a growing pull asks") {
  const char* const asked = std::getenv("STEPLAP_SERIES_MACHINES");
  const int count = asked ? std::atoi(asked) : 60;
  std::mt19937 random(43); // its numbers are the same everywhere
  int held = 0, held_limits = 0;
  for (int k = 0; k < count; ++k) {
    Nest nest = random_nest(random);
    const double a = (k % 2 == 0 ? 1.0 : -1.0) * 0.5 * k_g;
    CAPTURE(k);
    double mass = 0.0;
    for (const double each : nest.mass) mass += each;
    const double floor = mass * std::min(std::abs(a), nest.friction[0] * k_g); // friction of the outermost floor under a growing pull
    const StaticProof proof = proof_of(*machine(text_of(nest)), {a, 0.0});
    held += proof.verdict == Verdict::hold ? 1 : 0;
    const std::vector<CriterionResult>& criteria = proof.cases.front().criteria;
    double inner = 0.0;
    for (std::size_t i = nest.mass.size(); i-- > 0 && !criteria.empty();) { // empty: no rest was found, which is no hold
      inner += nest.mass[i];
      const double slides = inner * nest.friction[i] * k_g, pressed = std::max(0.0, inner * std::abs(a) - slides);
      CAPTURE(i);
      CHECK(std::abs(*criteria.at(i).value) >= pressed * (1.0 - 2e-3) - 1e-6 * slides); // accuracy of a rest's forces
    }
    nest.limit = floor * (0.3 + 0.65 * static_cast<double>(random()) / 4294967295.0);
    CHECK(proof_of(*machine(text_of(nest)), {a, 0.0}).verdict != Verdict::hold);
    nest.limit = 1.1 * mass * nest.friction[0] * k_g; // more than the floor can carry
    held_limits += proof_of(*machine(text_of(nest)), {a, 0.0}).verdict == Verdict::hold ? 1 : 0;
  }
  CHECK(held > count / 2);
  CHECK(held_limits == held);
  MESSAGE(held << " of " << count << " hold");
}

// Oak beams on a deck, held by chains over the load: under 0.8 g the beams' fixing bears μ (m g + T sin α) = 102.1 kN, more than the 95 kN
// that it may. The search for rest passes that rest and finds 82 kN.
TEST_CASE("a friction force that the search has passed is no hold") {
  const auto loaded = load_model(STEPLAP_TEST_DATA "/static_way/false_hold_static.toml");
  const StaticProof proof = proof_of(*loaded, {0.8 * k_g, 0.0});
  CHECK(proof.verdict == Verdict::open);
  CHECK(proof.reason.find("'oak.friction' is not known: 'oak' has slid") != std::string::npos);
}
