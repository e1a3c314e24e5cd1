// The machines of models/machines against closed forms and independent references.
#include "mbd/rest/modes.h"
#include "tests/machines/machine.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81, k_pi = 3.14159265358979323846;

// Complete elliptic integral of the first kind of modulus k, by the arithmetic-geometric mean.
double elliptic_k(double k) {
  double a = 1.0, b = std::sqrt(1.0 - k * k);
  while (std::abs(a - b) > 1e-15) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 0.5 * k_pi / a;
}

VibrationModes modes_of(const LoadedModel& loaded) {
  State state = equilibrium_of(loaded).state;
  std::fill(state.v.begin(), state.v.end(), 0.0);
  return vibration_modes(*loaded.system, state);
}

bool has_rest(const LoadedModel& loaded) {
  try {
    static_cast<void>(equilibrium_of(loaded));
    return true;
  } catch (const NumericalFailure&) {
    return false;
  }
}

} // namespace

TEST_CASE("every machine of the gallery runs to its end, and its energy balances") {
  for (const std::string name : {"balanced_pendulum", "ball_on_incline", "braking_car", "cradle", "crane_arm", "drawbar_train", "forklift",
                                 "hoist", "ladder", "parachute", "stacked_blocks", "tank_with_lid", "watt_linkage", "wheelie"}) {
    CAPTURE(name);
    const MachineRun r(name);
    CHECK(r.is_complete());
    // Of what went through springs, gravity and drives; tolerances are 1e-8 a step over some thousand steps.
    CHECK(r.run.result.statistics.energy_residual < 1e-5 * r.run.result.statistics.energy_exchanged);
  }
}

// Rolling, m r² + J shares the work of gravity: a = g sin α / (1 + J/(m r²)), 5/7 for a ball, 2/3 for a disc. It sinks
// into the track by m g cos α/k = 6.5 µm, and rolls on a radius that is smaller by so much: 6e-5 of the acceleration.
TEST_CASE("a ball rolls down an incline with 5/7 of g sin a, a disc with 2/3, and both roll, not slide") {
  const double along = k_pi / 9.0, sine = std::sin(along), cosine = std::cos(along), m = 7.0, r = 0.06;
  for (const double share : {0.4, 0.5}) {
    CAPTURE(share);
    const MachineRun run("ball_on_incline", {"body.ball.inertia=" + std::to_string(share * m * r * r)});
    REQUIRE(run.is_complete());
    const auto speed = [&](double t) { return run.at("ball.vx", t) * cosine - run.at("ball.vy", t) * sine; };
    const double a = (speed(1.1) - speed(0.3)) / 0.8, wanted = k_g * sine / (1.0 + share);
    CHECK(std::abs(a - wanted) < 1e-4 * wanted);
    CHECK(std::abs(speed(1.1) + run.at("ball.omega", 1.1) * r) < 2e-4 * speed(1.1)); // clockwise; the radius is 1e-4 smaller
    CHECK(run.at("grip.mode", 1.0) == 1.0);
    // Past the end it falls freely.
    CHECK(std::abs((run.at("ball.vy", 1.6) - run.at("ball.vy", 1.4)) / 0.2 + k_g) < 1e-6);
  }
}

// Couples about the foot: the wall's push is m g/(2 tan α), which the floor's friction must hold under m g.
TEST_CASE("a ladder stands from 0.268 on and slides below") {
  const double least = std::tan(k_pi / 12.0);
  const auto loaded = machine("ladder");
  const Equilibrium rest = equilibrium_of(*loaded);
  const double wall = at_rest(*loaded, rest, "head.force"), floor = at_rest(*loaded, rest, "foot.force");
  CHECK(std::abs(floor - 14.0 * k_g) < 1e-6);
  CHECK(std::abs(wall / floor - least) < 1e-4 * least); // feet of 1e6 N/m give by 0.1 mm of 3.5 m
  REQUIRE(rest.margins.size() == 1);
  CHECK(std::abs(rest.margins[0].used - least / 0.3) < 1e-4);
  CHECK(has_rest(*machine("ladder", {"element.foot friction.static_friction=0.27"})));
  CHECK_FALSE(has_rest(*machine("ladder", {"element.foot friction.static_friction=0.266"})));
  const MachineRun slides("ladder", {"element.foot friction.static_friction=0.25"});
  CHECK(slides.last("ladder.theta") - slides.at("ladder.theta", 0.0) > 0.05);
  const MachineRun stands("ladder");
  CHECK(std::abs(stands.last("ladder.theta") - stands.at("ladder.theta", 0.0)) < 1e-3);
}

// Quasi-static, about where the front wheels touch: a = g b/h with the tyres as far in as they are when the front ones
// carry all: truck and load have turned forward about the rear wheel's centre by sin φ = (m g/k)/1.5 m.
TEST_CASE("a forklift's rear wheels leave the floor at a deceleration of g b/h, and it tips onto its forks") {
  const MachineRun r("forklift");
  REQUIRE(r.is_complete());
  double mass = 0.0;
  Vec2 centre = Vec2::Zero();
  for (const Body& body : r.loaded->model.bodies) {
    mass += body.mass;
    centre += body.mass * body.position;
  }
  centre /= mass;
  const double depth = mass * k_g / 2e7, pitch = -std::asin(depth / 1.5);
  const Vec2 wheel(0.0, 0.25), turned = rotated(centre - wheel, pitch), brake = rotated(-wheel, pitch);
  const double ratio = -turned.x() / (turned.y() - brake.y()); // the brake acts at a point of the truck
  const std::vector<double> lifts = r.events("rear wheels", EventKind::opens);
  REQUIRE_FALSE(lifts.empty());
  // The brake reaches 0.6 g within 1 s. Pitching at 6.8 Hz the truck lags behind a ramp by some 2ζ/ω = 10 ms, of 0.9 s.
  CHECK(std::abs(lifts[0] - (0.2 + ratio / 0.6)) < 0.01);
  CHECK(std::abs(ratio / (-centre.x() / centre.y()) - 1.0) < 0.01); // soft tyres change it by less than a hundredth
  CHECK_FALSE(r.events("fork tips", EventKind::closes).empty());
  CHECK(r.last("truck.theta") < -0.5);
  // Braked with 0.3 g its rear wheels keep a quarter of their load, more than pitching takes. (It rolls
  // on, and later off the track's end.)
  const MachineRun gentle("forklift", {"signal.braking.peak=-0.3 gravity", "simulation.end=2.2"});
  CHECK(gentle.events("rear wheels", EventKind::opens).empty());
}

// Levers, from the outer ends in; the feet's 1e8 N/m turn the blocks by less than 1e-4.
TEST_CASE("stacked blocks press on their feet as levers say, and the top one slides as far as Coulomb says") {
  const auto loaded = machine("stacked_blocks");
  const Equilibrium rest = equilibrium_of(*loaded);
  const double top = 150.0 * k_g, middle = 400.0 * k_g, bottom = 800.0 * k_g;
  const auto is = [&](const char* foot, double wanted) { CHECK(std::abs(at_rest(*loaded, rest, foot) - wanted) < 1e-4 * wanted); };
  is("top rear.force", 0.5 * top);
  is("top front.force", 0.5 * top);
  const double front = (middle * 0.4 + top * 0.3) / 0.75;
  is("middle front.force", front);
  is("middle rear.force", middle + top - front);
  const double end = (bottom * 0.5 + middle * 0.65 + top * 0.55) / 1.0;
  is("bottom front.force", end);
  is("bottom rear.force", bottom + middle + top - end);

  const MachineRun r("stacked_blocks");
  REQUIRE(r.is_complete());
  // Relative speed w' = a(t) − μ g from where the brake exceeds μ g until w = 0; midpoint rule, to some 1e-6 m.
  double speed = 0.0, slide = 0.0;
  const double step = 1e-5;
  for (double t = 0.2 + 0.5 * step; t < 1.5; t += step) {
    const double brake = 3.0 * std::max(0.0, std::min({1.0, (t - 0.2) / 0.2, (0.9 - t) / 0.2}));
    speed = std::max(0.0, speed + (brake - 0.2 * k_g) * step);
    slide += speed * step;
  }
  // The stack sways at 39 Hz under the block: behind a ramp of 15 m/s³ its top lags by 15/ω² = 0.25 mm/s for each of the
  // blocks, which the slide keeps for its 0.6 s; and the sway itself is 3/ω² = 50 µm.
  CHECK(std::abs(r.last("top friction.slide") - slide) < 5e-4);
  CHECK(std::abs(r.last("middle friction.slide")) < 1e-8);
  CHECK(std::abs(r.last("bottom friction.slide")) < 1e-8);
}

// The servo's law, the couples of all weights beyond a joint, and the rope's tension, at the pose that it rests in.
TEST_CASE("a crane's motors carry the weights beyond their joints, its load swings as a double pendulum") {
  const auto loaded = machine("crane_arm");
  const Equilibrium rest = equilibrium_of(*loaded);
  const auto of = [&](const std::string& channel) { return at_rest(*loaded, rest, channel); };
  const double boom = of("boom.theta"), jib = of("jib.theta");
  const double elbow = 5.0 * std::cos(boom), tip = elbow + 3.0 * std::cos(jib);
  const double lifted = k_g * (200.0 * (of("jib.x") - elbow) + 500.0 * (tip - elbow));
  const double carried = k_g * (600.0 * of("boom.x") + 200.0 * of("jib.x") + 500.0 * tip);
  CHECK(std::abs(of("elbow motor.couple") - lifted) < 1e-8 * lifted);
  CHECK(std::abs(of("shoulder motor.couple") - carried) < 1e-8 * carried);
  const double boom_given = 0.92729521800161223; // 3-4-5
  CHECK(std::abs(of("shoulder motor.couple") - (4.7e4 - 2e6 * (boom - boom_given))) < 1e-6 * carried);
  CHECK(std::abs(of("elbow motor.couple") - (1.8e4 - 8e5 * (jib - boom + boom_given))) < 1e-6 * carried);
  CHECK(std::abs(of("hoist rope.tension") - 500.0 * k_g) < 1e-6);

  // Rope of length l over the load's centre at e: (m l², m l e; m l e, J + m e²) and (m g l, m g e). The jib's tip, 4 m above
  // the shoulder, gives by (4 m)²/(2e6 N m) of a force along x, which is a spring in series with m g/l: 0.65 % of the slow
  // frequency. What is left out has the square of that and the angle of the arm under way, for the fast one all of it.
  const double m = 500.0, l = 3.0 + m * k_g / 4e5, e = 0.4, j = 40.0;
  const double a = m * l * l * (j + m * e * e) - m * m * l * l * e * e, c = m * k_g * l * m * k_g * e;
  const double b = m * l * l * m * k_g * e + (j + m * e * e) * m * k_g * l;
  const double slow = std::sqrt((b - std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a)) / (2.0 * k_pi);
  const double fast = std::sqrt((b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a)) / (2.0 * k_pi);
  const VibrationModes modes = modes_of(*loaded);
  const auto nearest = [&](double frequency) {
    double off = 1e9;
    for (const VibrationMode& mode : modes.modes) off = std::min(off, std::abs(mode.natural_frequency() / frequency - 1.0));
    return off;
  };
  CHECK(nearest(slow * (1.0 - 0.5 * (m * k_g / l) * 16.0 / 2e6)) < 2e-3);
  CHECK(nearest(fast) < 1e-2);
}

// A pendulum's quarter swing from 30° is K(sin 15°)/ω. Its first blow comes a hair beyond: gaps of 0.1 mm at 0.81 m/s.
TEST_CASE("Newton's cradle: the last ball takes what the first brought, and half swings last 2 K/omega") {
  const MachineRun r("cradle");
  REQUIRE(r.is_complete());
  const double omega = std::sqrt(k_g / 0.25), quarter = elliptic_k(std::sin(k_pi / 12.0)) / omega;
  const double fastest = 2.0 * omega * std::sin(k_pi / 12.0) * 0.25, gap = 1e-4;
  const std::vector<double> first = r.events("1 on 2", EventKind::closes), last = r.events("4 on 5", EventKind::closes);
  REQUIRE(first.size() >= 2);
  REQUIRE(last.size() >= 2);
  // The gap's way is known to what the arc is longer than its chord, 1e-8; the time of the event to its own error.
  CHECK(std::abs(first[0] - (quarter + gap / fastest)) < 1e-7);
  const std::vector<double> leaves = r.events("4 on 5", EventKind::opens);
  // Where a ball stands when it is struck depends on gaps and on the little swings that blows leave: two of them either side.
  CHECK(std::abs(last[1] - leaves[0] - 2.0 * quarter) < 4.0 * gap / fastest);
  const std::vector<double> x1 = r.series("ball 1.x"), x3 = r.series("ball 3.x"), x5 = r.series("ball 5.x");
  // It climbs as far as the first fell: the others keep (their gaps over their way)² of the energy, 1e-6.
  const double far = *std::max_element(x5.begin(), x5.end());
  CHECK(std::abs(far - (0.1002 + 0.125)) < 1e-5);
  CHECK(*std::min_element(x1.begin(), x1.end()) >= -0.2252 - 1e-9);
  for (const double x : x3) CHECK(std::abs(x) < 10.0 * gap);
}

// The path from the equations of the loop: angles of the arms for which the link keeps its length, by Newton's method.
TEST_CASE("Watt's linkage leads its hub as its loop's equations say, and swings with the reduced mass") {
  const auto off_straight = [](double y) {
    double p = y / 0.4, q = p; // angles of the arms
    for (int i = 0; i < 60; ++i) {
      const Vec2 d(-0.8 + 0.4 * std::cos(p) + 0.4 * std::cos(q), 0.2 + 0.4 * std::sin(p) - 0.4 * std::sin(q));
      const double f = 0.2 * (std::sin(p) + std::sin(q)) - y, h = d.squaredNorm() - 0.04;
      const double fp = 0.2 * std::cos(p), fq = 0.2 * std::cos(q);
      const double hp = 0.8 * (-d.x() * std::sin(p) + d.y() * std::cos(p)), hq = 0.8 * (-d.x() * std::sin(q) - d.y() * std::cos(q));
      const double determinant = fp * hq - fq * hp;
      p -= (f * hq - fq * h) / determinant;
      q -= (fp * h - hp * f) / determinant;
    }
    return 0.2 * (std::cos(p) - std::cos(q));
  };
  CHECK(std::abs(off_straight(0.05)) == doctest::Approx(6.2e-6).epsilon(0.01)); // as the model says
  const MachineRun r("watt_linkage");
  REQUIRE(r.is_complete());
  const std::vector<double> x = r.series("link.x"), y = r.series("link.y");
  double furthest = 0.0, off = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    furthest = std::max(furthest, std::abs(y[i]));
    off = std::max(off, std::abs(x[i] - off_straight(y[i])));
  }
  CHECK(furthest > 0.08);
  CHECK(off < 1e-9); // joints are kept to 1e-12, magnified by where the link is steep
  const double reduced = 60.0 + 2.0 * (4.0 / 3.0), damping = 400.0, k = 3e4; // arms: m l²/3 about their pivots
  const VibrationModes modes = modes_of(*machine("watt_linkage"));
  REQUIRE(modes.modes.size() == 1);
  CHECK(modes.modes[0].natural_frequency() == doctest::Approx(std::sqrt(k / reduced) / (2.0 * k_pi)).epsilon(1e-9));
  CHECK(modes.modes[0].damping_ratio() == doctest::Approx(0.5 * damping / std::sqrt(k * reduced)).epsilon(1e-9));
}
