// Published measurements against the model: what is predicted lies within their scatter, and what is known to miss misses by what
// docs/evidence/experiments.md says. Every bound is a multiple of the measurement's own standard deviation.
#include "tests/physics/experiments.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap::testing;

namespace {

// Standard error of the mean.
double error_of(const Compared& c) { return c.scatter / std::sqrt(static_cast<double>(c.count)); }

// Intervals of a ball that keeps a share of its speed at each bounce and is held back by the air, in closed form: against a drag
// of m g v^2/u^2 it rises for u/g atan(v/u) to u^2/(2 g) ln(1 + v^2/u^2), and falls from a height h to the speed u sqrt(1 -
// exp(-2 g h/u^2)) in u/g artanh(v/u).
std::vector<double> intervals_in_air(double share, double height, double terminal_speed) {
  const double g = 9.81, u = terminal_speed;
  const auto speed_from = [&](double h) { return u * std::sqrt(1.0 - std::exp(-2.0 * g * h / (u * u))); };
  std::vector<double> intervals;
  double speed = speed_from(height);
  for (int bounce = 0; bounce < 8; ++bounce) {
    const double up = share * speed;
    speed = speed_from(u * u / (2.0 * g) * std::log(1.0 + up * up / (u * u)));
    intervals.push_back(u / g * (std::atan(up / u) + std::atanh(speed / u)));
  }
  return intervals;
}

} // namespace

// One value of the contact, from eight intervals after a fall from 1.1 m. A single throw scatters by `scatter`; the prediction,
// which is one throw of a ball without scatter, is to lie within two of it (5 of 100 throws would not), and the 24 together
// without a bias beyond one.
TEST_CASE("a golf ball's bounces from three heights are predicted from those from a fourth") {
  double sum = 0.0;
  int predicted = 0;
  for (const Compared& c : bounces("golf_ball", 1.1)) {
    CAPTURE(c.setting);
    CAPTURE(c.number);
    CHECK(std::abs(c.miss()) < 2.0 * c.scatter);
    if (c.is_fitted) continue;
    sum += c.miss() / c.scatter;
    ++predicted;
  }
  CHECK(predicted == 24);
  CHECK(std::abs(sum / predicted) < 1.0);
}

// The same model does not describe a table tennis ball, whose speed after a bounce falls with the speed before it: the model has
// no air.
TEST_CASE("a table tennis ball's bounces are missed: too long from above the fitted height, too short from below") {
  for (const Compared& c : bounces("table_tennis_ball", 0.18)) {
    CAPTURE(c.setting);
    CAPTURE(c.number);
    if (c.is_fitted) CHECK(std::abs(c.miss()) < 2.0 * c.scatter);
    else if (c.setting > 0.18) CHECK(c.miss() > 2.0 * c.scatter);
    else CHECK(c.miss() < -2.0 * c.scatter);
    CHECK(std::abs(c.miss()) < 0.1 * c.measured);
  }
}

// What is missing is air. A sphere of 40 mm and 2.7 g with a drag coefficient of 0.45 falls at 8.8 m/s at most (general
// knowledge, the mass alone is the source's). With that in a closed form, one share of speed kept, 0.956, comes within 4.1 % of
// all forty intervals; steplap misses by up to 9 %.
TEST_CASE("air drag explains more than half of what is missed of the table tennis ball") {
  const double terminal_speed = std::sqrt(2.0 * 0.0027 * 9.81 / (1.2 * 0.45 * 3.14159265 * 0.02 * 0.02));
  double worst = 0.0, worst_without = 0.0;
  for (const Compared& c : bounces("table_tennis_ball", 0.18)) {
    const double with_air = intervals_in_air(0.956, c.setting, terminal_speed)[static_cast<std::size_t>(c.number - 1)];
    worst = std::max(worst, std::abs(with_air / c.measured - 1.0));
    worst_without = std::max(worst_without, std::abs(c.miss() / c.measured));
  }
  CHECK(worst < 0.041);
  CHECK(worst_without > 2.0 * worst);
}

// The mean of 20 runs against a prediction that has the standard error of the 20 runs that the slope was found from.
TEST_CASE("flywheels that turn slow a trolley as their measured mass and size say") {
  const std::vector<Compared> both = flywheel_trolley();
  const Compared &free = both[0], &locked = both[1];
  CHECK(std::abs(free.miss()) < 1e-6);
  const double error = std::hypot(error_of(locked), error_of(free) / free.measured * locked.predicted);
  CHECK(std::abs(locked.miss()) < 2.0 * error);
  CHECK(locked.predicted - free.predicted > 100.0 * error); // what is predicted is not the slope
}

// Slope and way are known to 0.3 % of the acceleration (heights and places to 1 mm each), so the time to 0.15 %, and the clock
// reads to 0.01 s.
TEST_CASE("a rubber ball rolls down a rail with 5/7 of g sin a, and a metal ball does not") {
  const std::vector<Compared> balls = balls_on_rail();
  const Compared &rubber = balls[0], &metal = balls[1], &rolling = balls[2];
  CHECK(std::abs(rubber.miss()) < 2.0 * std::hypot(error_of(rubber), 0.0015 * rubber.predicted, 0.01 / std::sqrt(12.0)));
  CHECK(rolling.miss() > 5.0 * rolling.scatter);
  CHECK(metal.setting == doctest::Approx(0.075).epsilon(0.02)); // friction that it slides with: the one that the page gives
}

// Runs of a cylinder scatter by 5 to 20 %. What was found from the first twenty describes a single later run within its scatter.
// The mean of the third body's later runs is three standard errors off: its friction changed while it was measured.
TEST_CASE("friction of a cylinder's first runs describes its last ones within their scatter, not always within that of their mean") {
  const std::vector<Compared> all = cylinders_on_rail();
  std::vector<double> drift;
  for (std::size_t i = 1; i < all.size(); i += 2) {
    CAPTURE(all[i].what);
    CHECK(std::abs(all[i].miss()) < 2.0 * all[i].scatter);
    drift.push_back(all[i].miss() / std::hypot(error_of(all[i]), error_of(all[i - 1])));
  }
  CHECK(drift[0] < 2.0);
  CHECK(drift[1] < 2.0);
  CHECK(drift[2] > 2.5);
}

TEST_CASE("a trolley on an air track is missed from masses alone, and predicted once its start and its drag are known from two "
          "of five masses") {
  for (const Compared& c : air_track(true)) CHECK(c.miss() > 10.0 * c.scatter); // all 4 to 6 % slower than measured: it moves already
  for (const Compared& c : air_track(false)) {
    CAPTURE(c.setting);
    if (c.is_fitted) CHECK(std::abs(c.miss()) < 1e-4); // a tenth of the clock's digit
    else CHECK(std::abs(c.miss()) < 2.0 * c.scatter);
  }
}

// 770 kg by 3.5 mph and 950 kg by 3.1 mph differ by 8.5 %, more than the digits written allow (3 % together): the measured
// momentum is not kept, and no model that keeps it meets both. By half of the difference, 4.3 %, one of them must be missed; 5 %
// is asked for.
TEST_CASE("two cars: the change of speed of the one that strikes lies within the prediction, that of the one struck is missed by "
          "what momentum lacks") {
  const std::vector<Compared> low = car_to_car(0.2),
                              high = car_to_car(0.4); // ends of the published range of the coefficient of restitution
  CHECK(770.0 * low[0].measured / (950.0 * low[1].measured) == doctest::Approx(1.0 - 0.085).epsilon(1e-3));
  for (const Compared& c : low) CHECK(std::abs(c.miss()) < 0.05 * c.measured);
  CHECK(low[1].predicted < low[1].measured);
  CHECK(high[1].predicted > high[1].measured);
  CHECK(low[0].miss() > 2.0 * low[0].scatter);
  CHECK(high[0].miss() > 0.2 * high[0].measured);
}

// From inputs alone the brick lies after 0.33 s; measured was 0.4 to 0.5 s, the whole of it by ear and hand. Turning about its
// edge with J it obeys J a = m g r sin p, which takes 0.335 s by quadrature: the model is not what misses.
TEST_CASE("a toppling brick falls faster than was measured") {
  const Compared brick = toppling_brick().front();
  CHECK(brick.predicted == doctest::Approx(0.335).epsilon(0.02));
  CHECK(brick.miss() < -brick.scatter);
}

// "approximately 0.97", written to 0.01: within 0.02, and below Housner's value, as measured.
TEST_CASE("a base found from a slender rocking block moves a short one's loss the right way, by about half of what was measured") {
  for (const double tilt : {0.3, 0.5, 0.8}) {
    CAPTURE(tilt);
    const std::vector<Compared> all = rocking_blocks(tilt);
    CHECK(std::abs(all[0].miss()) < 1e-4);
    CHECK(std::abs(all[1].miss()) < 1e-4);
    CHECK(std::abs(all[2].miss()) < 0.02);
    CHECK(all[2].predicted > all[2].measured);
    CHECK(all[2].predicted < 0.99);
  }
}

// Theory: an impact without rebound keeps angular momentum about the corner that it meets, which leaves 1 - 3/2 sin^2 a of the
// angular velocity. A compliant corner spreads the impact over a time of sqrt(m/k), in which the weight acts, and sinks by m g/k,
// over which it takes energy.
TEST_CASE("a damped corner that becomes stiff loses what Housner's formula says") {
  for (const double aspect : {3.0, 5.0})
    for (const double damping_ratio : {0.3, 1.0}) {
      CAPTURE(aspect);
      CAPTURE(damping_ratio);
      double worst_before = 1.0;
      for (const double stiffness : {1e7, 1e8, 1e9}) {
        const RockingBlock block{.height = 0.2 * aspect, .stiffness = stiffness, .damping_ratio = damping_ratio};
        double worst = 0.0;
        for (const double ratio : rocking_ratios(block, 4)) worst = std::max(worst, std::abs(ratio / housner_ratio(block) - 1.0));
        CHECK(worst < 0.4 * worst_before);
        worst_before = worst;
      }
      // Sampled every millisecond, the largest angle is known to g/(8 r) dt^2, 2e-6 of it; what is left is m g/(k w) and the time
      // of the impact.
      CHECK(worst_before < 1e-4);
    }
}

// Where the corner rebounds, a slender block comes to the same in the end, since it has time to end its bounces within a swing. A
// short one has not: it meets the next impact still bouncing, and no ratio describes it.
TEST_CASE("a corner that rebounds: slender blocks still lose what Housner says, short ones do not") {
  const auto spread = [](double aspect) {
    const RockingBlock block{.height = 0.2 * aspect, .stiffness = 1e9, .damping_ratio = 0.02};
    double worst = 0.0;
    for (const double ratio : rocking_ratios(block, 4)) worst = std::max(worst, std::abs(ratio / housner_ratio(block) - 1.0));
    return worst;
  };
  CHECK(spread(5.0) < 0.002);
  CHECK(spread(2.0) > 0.3);
}

// Coulomb friction that does not know the speed, and slack. Two amplitudes at 0.25 Hz give both values of a set; the third amplitude, and
// up to four times the speed, follow within 14 %, where cycles of a test differ by 1 to 2 %. At eight times the speed the prediction is 8 to
// 23 % too large: friction falls with speed, which the law leaves out.
TEST_CASE("a friction damper's energy per cycle is met within 14 % up to four times the speed, and missed at eight times") {
  int slow = 0, fast = 0;
  for (const Compared& c : friction_damper()) {
    CAPTURE(c.number);
    CAPTURE(c.what);
    CAPTURE(c.setting);
    const double miss = c.miss() / c.measured;
    if (c.is_fitted) {
      CHECK(std::abs(miss) < 0.003); // the connection gives by up to 0.02 mm, which the fit leaves out
    } else if (c.what.find(" 2 Hz") == std::string::npos) {
      CHECK(std::abs(miss) < 0.14);
      ++slow;
    } else {
      CHECK(miss > 0.05);
      CHECK(miss < 0.25);
      ++fast;
    }
  }
  CHECK(slow == 21);
  CHECK(fast == 3);
}
