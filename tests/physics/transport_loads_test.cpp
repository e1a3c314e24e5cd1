// Loads of transport in runs: what a vehicle answers to a road is what its transfer function says, axles follow one another, the
// deck of a vessel moves as the formula of its accelerations has it, and the models of models/loads do what their loads are.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_pi = std::numbers::pi;

double mean_square(const std::vector<double>& series, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (std::size_t k = from; k < to; ++k) sum += series[k] * series[k] / static_cast<double>(to - from);
  return sum;
}

Model load_model(const std::string& name) {
  return read_model(std::string(STEPLAP_MODELS) + "/loads/" + name + ".toml", transformer_catalog());
}

} // namespace

// One mass on a spring and a damper, 1.51 Hz with a damping ratio of 0.16: the variance of its acceleration is ∫ |H|² (2πf)⁴
// Gd(f/v)/v df.
TEST_CASE("the response of a vehicle to roads has the variance that its transfer function gives") {
  constexpr double m = 1000.0, k = 9e4, c = 3e3, v = 11.0, end = 60.0, rough = 256e-6;
  const std::string text =
      body("body", "mass = 1000; inertia = 1; position = [0, 1]") + body("road", "mass = 1; inertia = 1") +
      element("prescribed_motion", "height", "a = 'road'; coordinate = 'y'; signal = 'rough'; as = 'position'") +
      element("spring_damper", "spring", "a = 'body'; b = 'road'; axis = [0, 1]; stiffness = 9e4; damping = 3e3; preload = 9810");
  double measured = 0.0;
  constexpr int k_seeds = 8;
  for (int seed = 1; seed <= k_seeds; ++seed) {
    std::string quoted = text + signal_entry("road", "rough", "class = 'C'; speed = 11; seed = " + std::to_string(seed));
    std::replace(quoted.begin(), quoted.end(), '\'', '"');
    const Run r = run(quoted, {"dop853", 1e-8, end, 0.02});
    const std::vector<double> a = r.series("body.ay");
    measured += mean_square(a, 500, a.size()) / k_seeds; // behind the run-in and what dies away after it
  }
  double exact = 0.0;
  constexpr int k_steps = 20000;
  for (int i = 0; i < k_steps; ++i) {
    const double n = 0.011 + (2.83 - 0.011) * (i + 0.5) / k_steps, w = 2.0 * k_pi * n * v;
    const std::complex<double> h = std::complex<double>(k, c * w) / std::complex<double>(k - m * w * w, c * w);
    exact += std::norm(h) * std::pow(w, 4) * rough * std::pow(n / 0.1, -2) * (2.83 - 0.011) / k_steps;
  }
  // Forces beyond the damper's corner are broad, so 8 roads of 50 s hold more than 2 · 1.5 Hz · 400 s independent values: 3.3 of
  // their standard deviations, √(2/1200), are 13 %.
  CHECK(measured == doctest::Approx(exact).epsilon(0.13));
}

TEST_CASE("the axles of the trailer pass one road, 7 m apart at 40 km/h") {
  const Run r = run(load_model("road_class_c"), {"dop853", 1e-8, 6.0, 0.01});
  const std::vector<double> front = r.series("front road.y"), rear = r.series("rear road.y");
  const std::size_t lag = 63; // 7 m / 11.11 m/s, of samples
  double size = 0.0, apart = 0.0;
  for (std::size_t k = lag; k < front.size(); ++k) {
    size = std::max(size, std::abs(front[k - lag] + 1.3));
    apart = std::max(apart, std::abs(rear[k] - front[k - lag]));
  }
  CHECK(size > 5e-3);  // mm of a class whose r.m.s. is 15 mm
  CHECK(apart < 1e-9); // positions are given
  for (const char* joint : {"front joint", "rear joint", "middle joint"}) CHECK(r.event_times(joint).empty());
}

// The trailer is stiff beside the sea: its supports carry what it weighs in the deck's axes.
TEST_CASE("the barge's deck presses on what it carries by the formula of its accelerations") {
  const Run r = run(load_model("barge"), {"dop853", 1e-8, 30.0, 0.05});
  const std::vector<double> force = r.series("front axles.force"), rear = r.series("rear axles.force"), angle = r.series("barge.theta");
  const double theta = 12.5 * k_pi / 180.0, omega = 2.0 * k_pi / 10.0, heave = 0.2 * 9.80665, mass = 112e3;
  double largest = 0.0, most = 0.0, least = 1e9;
  for (std::size_t k = 0; k < angle.size(); ++k) {
    if (r.times()[k] < 12.0) continue; // grown, and what dies away after it
    largest = std::max(largest, std::abs(angle[k]));
    const double sum = force[k] + rear[k];
    most = std::max(most, sum);
    least = std::min(least, sum);
  }
  CHECK(largest == doctest::Approx(theta).epsilon(1e-3)); // of samples
  // f_y = X θ̈ − Y θ̇² + (g + ḧ) cos θ with X = 20 m and Y = 8 m; its extremes by a search over a period.
  double high = 0.0, low = 1e9;
  for (double t = 0.0; t < 10.0; t += 0.001) {
    const double a = theta * std::sin(omega * t), rate = theta * omega * std::cos(omega * t), turn = -a * omega * omega;
    const double f = 20.0 * turn - 8.0 * rate * rate + (9.81 - heave * std::sin(omega * t)) * std::cos(a);
    high = std::max(high, f);
    low = std::min(low, f);
  }
  CHECK(high > 13.0); // pitch and heave throw the deck up together
  // The trailer's own spring turns it and lets it swing by some per cent of what varies.
  CHECK(std::abs(most - mass * high) < 0.05 * mass * (high - low));
  CHECK(std::abs(least - mass * low) < 0.05 * mass * (high - low));
}

TEST_CASE("the wagon is shaken with the r.m.s. of its table") {
  const Run r = run(load_model("wagon_vibration"), {"dop853", 1e-8, 11.0, 0.004});
  const std::vector<double> a = r.series("wagon.ax"), t = r.times();
  std::vector<double> hold;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (t[k] > 1.0 && t[k] < 11.0) hold.push_back(a[k]);
  const auto part = [](double f0, double f1, double s0, double s1) { // ∫ of a straight line on logarithmic axes
    const double g = std::log(s1 / s0) / std::log(f1 / f0) + 1.0;
    return std::abs(g) < 1e-9 ? s0 * f0 * std::log(f1 / f0) : s0 * f0 * (std::pow(f1 / f0, g) - 1.0) / g;
  };
  const double exact = 9.80665 * 9.80665 * (part(1, 4, 2e-4, 1e-3) + part(4, 16, 1e-3, 1e-3) + part(16, 40, 1e-3, 1e-4));
  CHECK(std::sqrt(exact) == doctest::Approx(0.147 * 9.80665).epsilon(0.01)); // the file says 0.15 g
  // Twice 20 Hz · 10 s independent values: 3.3 √(2/400) are 23 %.
  CHECK(mean_square(hold, 0, hold.size()) == doctest::Approx(exact).epsilon(0.23));
}
