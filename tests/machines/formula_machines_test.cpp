// Machines with forces by formula and states of their own, against a closed form and an integration written by hand.
#include "tests/machines/machine.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81;

// Downwards from rest with drag: v = u tanh(g t/u); from v0 > u on v = u coth(g t/u + c), coth c = v0/u.
struct Fall {
  double fallen, speed;
};

Fall from_rest(double u, double t) { return {u * u / k_g * std::log(std::cosh(k_g * t / u)), u * std::tanh(k_g * t / u)}; }

Fall braked(double u, double v0, double t) {
  const double c = std::atanh(u / v0), x = k_g * t / u + c;
  return {u * u / k_g * (std::log(std::sinh(x)) - std::log(std::sinh(c))), u / std::tanh(x)};
}

// A cart and a rod with a motor of 4 mH and a filter of 2 ms: (x, x', θ, θ', current, filtered angle).
using Balance = std::array<double, 6>;

Balance rate_of(const Balance& z) {
  constexpr double k_cart = 1.2, k_rod = 0.4, k_inertia = 0.012, k_half = 0.3, k_pull = 2.5;
  const double s = std::sin(z[2]), c = std::cos(z[2]), push = k_pull * z[4];
  // (M + m) x'' - m l c θ'' = F - m l s θ'²,  (J + m l²) θ'' - m l c x'' = m g l s
  const double a = k_cart + k_rod, b = -k_rod * k_half * c, d = k_inertia + k_rod * k_half * k_half;
  const double p = push - k_rod * k_half * s * z[3] * z[3], q = k_rod * k_g * k_half * s, det = a * d - b * b;
  const double wanted = 8.0 * z[0] + 14.0 * z[1] - 60.0 * z[5] - 10.0 * z[3];
  return {z[1],
          (d * p - b * q) / det,
          z[3],
          (a * q - b * p) / det,
          (std::clamp(wanted, -24.0, 24.0) - 0.4 * z[4] - 2.5 * z[1]) / 0.004,
          (z[2] - z[5]) / 0.002};
}

// The classical method of Runge and Kutta.
Balance balanced(double end, long steps) {
  const double h = end / static_cast<double>(steps), angle = 6.0 * std::numbers::pi / 180.0;
  Balance z = {0.0, 0.0, angle, 0.0, 0.0, angle};
  const auto moved = [](const Balance& from, const Balance& rate, double by) {
    Balance to = from;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += by * rate[i];
    return to;
  };
  for (long n = 0; n < steps; ++n) {
    const Balance k1 = rate_of(z), k2 = rate_of(moved(z, k1, 0.5 * h)), k3 = rate_of(moved(z, k2, 0.5 * h)), k4 = rate_of(moved(z, k3, h));
    for (std::size_t i = 0; i < z.size(); ++i) z[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  }
  return z;
}

} // namespace

TEST_CASE("a load on a parachute falls by tanh until it opens, and by coth after, also where a parameter is set") {
  for (const double opens : {12.0, 8.0}) {
    CAPTURE(opens);
    const MachineRun r("parachute", {"parameters.opens=" + std::to_string(opens) + " s", "simulation.tolerance=1e-10"});
    REQUIRE(r.is_complete());
    const double weight = 120.0 * k_g, bare = std::sqrt(weight / (0.5 * 1.225 * 0.6)), canopy = std::sqrt(weight / (0.5 * 1.225 * 60.0));
    const Fall first = from_rest(bare, opens);
    for (const double t : {2.0, 7.0, 12.5, 20.0, 60.0}) {
      CAPTURE(t);
      Fall now = from_rest(bare, std::min(t, opens));
      if (t > opens) {
        now = braked(canopy, first.speed, t - opens);
        now.fallen += first.fallen;
      }
      // A tolerance of 1e-10 a step, of 1500 m and 60 m/s.
      CHECK(std::abs(r.at("load.y", t) - (1500.0 - now.fallen)) < 1e-6);
      CHECK(std::abs(r.at("load.vy", t) + now.speed) < 1e-7);
    }
    const std::vector<double> kinks = r.events("drag", EventKind::passes_kink);
    CHECK(std::any_of(kinks.begin(), kinks.end(), [&](double t) { return std::abs(t - opens) < 1e-9; }));
  }
}

TEST_CASE("a cart balances a rod as its equations with current and filter say, integrated by hand") {
  for (const double t : {0.1, 1.0, 3.0}) {
    CAPTURE(t);
    const MachineRun r("balanced_pendulum", {"simulation.end=" + std::to_string(t), "simulation.tolerance=1e-10"});
    REQUIRE(r.is_complete());
    // Steps of 5 µs, a four hundredth of the filter's time: 1e-10 each, and as much where the voltage leaves its limit within one.
    const Balance exact = balanced(t, static_cast<long>(t / 5e-6));
    CHECK(std::abs(r.last("cart.x") - exact[0]) < 1e-7);
    CHECK(std::abs(r.last("rod.theta") - exact[2]) < 1e-7);
    CHECK(std::abs(r.last("current.value") - exact[4]) < 1e-5);
    CHECK(std::abs(r.last("leaning.value") - exact[5]) < 1e-7);
  }
  CHECK(std::abs(MachineRun("balanced_pendulum").last("cart.x")) < 1e-3);
}
