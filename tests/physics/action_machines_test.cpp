// Machines with actions, against an integration written by hand and a closed form.
#include "mbd/rest/start.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81;

Run run_machine(const std::string& name, const std::vector<std::string>& overrides) {
  const Model model = read_model(STEPLAP_MODELS "/machines/" + name + ".toml", transformer_catalog(), overrides);
  Run r;
  r.system = compile(model);
  r.result = simulate(*r.system, start_of(model, *r.system), options_of(model));
  return r;
}

// The trebuchet while its sling is taut, by two angles, of the beam and of the sling from the tip to the ball:
//   (Ja + m L²) θ'' − m L s c φ'' = m L s S φ'² − (M d − m L) g cos θ,   c, S = cos, sin(θ − φ)
//   m s² φ'' − m L s c θ'' = −m L s S θ'² − m s g cos φ
// from T = ½ Ja θ'² + ½ m (L² θ'² + s² φ'² − 2 L s c θ' φ'), V = M g d sin θ + m g (s sin φ − L sin θ).
struct Trebuchet {
  double counterweight = 2000.0, d = 1.0, long_arm = 6.0, m = 20.0, height = 6.0;
  using Motion = std::array<double, 4>; ///< θ, φ, θ', φ'
  Motion z{};
  double s = 0.0, t = 0.0, least_tension = 1e9;

  Trebuchet() {
    const double angle = 40.0 * std::numbers::pi / 180.0, x = -0.6 + long_arm * std::cos(angle),
                 y = 2.0 - height + long_arm * std::sin(angle);
    s = std::hypot(x, y);
    z = {angle, std::atan2(y, x), 0.0, 0.0};
  }
  [[nodiscard]] Motion rate(const Motion& q) const {
    const double c = std::cos(q[0] - q[1]), sine = std::sin(q[0] - q[1]), coupled = m * long_arm * s;
    const double a = 900.0 + counterweight * d * d + m * long_arm * long_arm, b = -coupled * c, e = m * s * s;
    const double p = coupled * sine * q[3] * q[3] - (counterweight * d - m * long_arm) * k_g * std::cos(q[0]);
    const double r = -coupled * sine * q[2] * q[2] - m * s * k_g * std::cos(q[1]), det = a * e - b * b;
    return {q[2], q[3], (e * p - b * r) / det, (a * r - b * p) / det};
  }
  [[nodiscard]] Motion moved(double h) const {
    const auto along = [this](const Motion& k, double by) {
      Motion to = z;
      for (std::size_t i = 0; i < to.size(); ++i) to[i] += by * k[i];
      return to;
    };
    const Motion k1 = rate(z), k2 = rate(along(k1, 0.5 * h)), k3 = rate(along(k2, 0.5 * h)), k4 = rate(along(k3, h));
    Motion to = z;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    return to;
  }
  struct Ball {
    double x, y, vx, vy, tip_y;
  };
  [[nodiscard]] Ball ball(const Motion& q) const {
    const double tip_x = -long_arm * std::cos(q[0]), tip_y = height - long_arm * std::sin(q[0]);
    return {tip_x + s * std::cos(q[1]), tip_y + s * std::sin(q[1]), long_arm * q[2] * std::sin(q[0]) - s * q[3] * std::sin(q[1]),
            -long_arm * q[2] * std::cos(q[0]) + s * q[3] * std::cos(q[1]), tip_y};
  }
  [[nodiscard]] bool is_open(const Motion& q, double slope) const {
    const Ball b = ball(q);
    return b.y > b.tip_y && b.vx > 0.0 && b.vy < slope * b.vx;
  }
  [[nodiscard]] double tension(const Motion& q) const {
    const Motion k = rate(q);
    const double tip_x = long_arm * (k[2] * std::sin(q[0]) + q[2] * q[2] * std::cos(q[0])),
                 tip_y = long_arm * (-k[2] * std::cos(q[0]) + q[2] * q[2] * std::sin(q[0]));
    return m * (s * q[3] * q[3] - tip_x * std::cos(q[1]) - (tip_y + k_g) * std::sin(q[1]));
  }
  /// Up to where the sling opens, by steps of the classical method of Runge and Kutta, the last one halved to rounding.
  void swing(double slope) {
    constexpr double k_step = 2e-5;
    for (Motion next = moved(k_step); !is_open(next, slope) && t < 10.0; next = moved(k_step)) {
      z = next;
      t += k_step;
      least_tension = std::min(least_tension, tension(z));
    }
    double low = 0.0, high = k_step;
    for (int i = 0; i < 60; ++i) (is_open(moved(0.5 * (low + high)), slope) ? high : low) = 0.5 * (low + high);
    z = moved(high);
    t += high;
  }
};

} // namespace

TEST_CASE("a trebuchet lets go where its ball flies as it is told to, and throws it as far as two angles and a parabola say") {
  for (const double direction : {45.0, 30.0}) {
    CAPTURE(direction);
    const Run r = run_machine("trebuchet", {"parameters.direction=" + std::to_string(direction) + " deg", "simulation.tolerance=1e-11"});
    CHECK(r.result.ended_by == "landing");
    Trebuchet by_hand;
    by_hand.swing(std::tan(direction * std::numbers::pi / 180.0));
    CHECK(by_hand.least_tension > 0.0); // a rope does what the rod of the two angles does
    const Trebuchet::Ball b = by_hand.ball(by_hand.z);
    const double flies = (b.vy + std::sqrt(b.vy * b.vy + 2.0 * k_g * (b.y - 2.0))) / k_g;
    REQUIRE(r.event_times("sling opens", "happens").size() == 1);
    // A tolerance of 1e-11 a step, over some hundred steps of a motion of 20 m/s.
    CHECK(std::abs(r.event_times("sling opens", "happens").front() - by_hand.t) < 1e-8);
    CHECK(std::abs(r.times().back() - (by_hand.t + flies)) < 1e-7);
    CHECK(std::abs(r.last("ball.x") - (b.x + b.vx * flies)) < 1e-6);
    CHECK(r.last("ball.x") > 40.0); // it does throw
  }
}

TEST_CASE("a crane that drops its load swings by what the load had bent it, until the load lands") {
  const Run r = run_machine("crane_drops_load", {"simulation.tolerance=1e-11"});
  CHECK(r.result.ended_by == "landing");
  const double k = 4e5, omega = std::sqrt(k / 800.0), bent = 500.0 * k_g / k, rest = 8.0 - 800.0 * k_g / k,
               height = 4.0 - 1300.0 * k_g / k - 0.4;
  const double lands = 2.0 + std::sqrt(2.0 * height / k_g);
  CHECK(std::abs(r.times().back() - lands) < 1e-8);
  const std::vector<double> height_of_head = r.series("jib head.y");
  for (std::size_t i = 0; i < r.times().size(); ++i) {
    const double t = r.times()[i];
    const double swing = t < 2.0 ? -bent : -bent * std::cos(omega * (t - 2.0));
    CHECK(std::abs(height_of_head[i] - (rest + swing)) < 1e-8);
  }
}
