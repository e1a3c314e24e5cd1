// The pulse of two wagons that meet: momentum, energy, closed forms, end stops, and what is refused.
#include "mbd/model/shunting_signal.h"

#include "elements/catalog.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

using namespace steplap;

namespace {

constexpr double k_pi = std::numbers::pi;

struct ShuntingCase {
  double m = 87e3, other = 80e3, v = 2.0, other_v = 0.0;
  std::string curves = "buffer = [[0, 0], [0.3, 1.68e6]]";
  double start = 0.1;
};

Signal pulse_of(const ShuntingCase& g) {
  const auto n = [](double x) { return std::to_string(x); };
  const Model model =
      parse_model("[[signal]]\nname = 'meeting'\nkind = 'shunting'\nmass = " + n(g.m) + "\nother_mass = " + n(g.other) +
                      "\nspeed = " + n(g.v) + "\nother_speed = " + n(g.other_v) + "\nstart = " + n(g.start) + "\n" + g.curves +
                      "\n[[body]]\nname = 'wagon'\nmass = 1\ninertia = 1\n[[element]]\nkind = 'load'\nname = 'push'\nat = 'wagon'\nforce_x "
                      "= 'meeting'\n",
                  "shunting.toml", element_catalog());
  for (const SignalEntry& entry : model.signals)
    if (entry.definition->name == "meeting") return entry.kind->build(*entry.definition);
  return {};
}

double end_of(const Signal& s) { return s.breakpoints().back(); }
double velocity_change(const Signal& s) { return s.mean(0.0, end_of(s)) * end_of(s); }
double reduced(const ShuntingCase& g) { return g.m * g.other / (g.m + g.other); }

// What the wagons part with, of the energy of their closing.
double given_back(const ShuntingCase& g, const Signal& s) {
  const double closing = g.v - g.other_v, parting = closing + velocity_change(s) * g.m / reduced(g);
  return parting * parting / (closing * closing);
}

// Closing x as a function of time, from the pulse alone: ẍ = a m/μ.
double closed(const ShuntingCase& g, const Signal& s, double t) {
  return (g.v - g.other_v) * t + s.drive(g.start + t, DriveLevel::acceleration).value * g.m / reduced(g);
}

} // namespace

// Two ends in series, two buffers each: all together as stiff as one of them, k. μ ẍ = −k x: a half sine of peak v √(k μ)/m that
// lasts π √(μ/k).
TEST_CASE("linear buffers make a half sine") {
  for (const double v : {2.0, -1.5}) {
    ShuntingCase g;
    if (v > 0.0) g.v = v;
    else g.v = 0.0, g.other_v = -v;
    const double k = 1.68e6 / 0.3, mu = reduced(g), duration = k_pi * std::sqrt(mu / k), peak = -v * std::sqrt(k * mu) / g.m;
    const Signal s = pulse_of(g);
    CHECK(s.breakpoints().front() == 0.1);
    CHECK(end_of(s) == doctest::Approx(0.1 + duration).epsilon(1e-8));
    for (int i = 1; i < 40; ++i)
      CHECK(s.value(0.1 + duration * i / 40) == doctest::Approx(peak * std::sin(k_pi * i / 40)).epsilon(1e-7).scale(std::abs(peak)));
    CHECK(s.value(0.1 + 1.01 * duration) == 0.0);
    // Elastic: equal masses would change speeds; the wagon loses 2 μ/m of the closing speed.
    CHECK(velocity_change(s) == doctest::Approx(-2.0 * mu / g.m * v).epsilon(1e-8));
  }
}

// A constant force: uniform deceleration until they move together, then they are pushed apart by the share η of it: they part with
// √η of the closing speed.
TEST_CASE("a constant force with hysteresis is known in closed form") {
  ShuntingCase g;
  g.curves = "buffer = [[0, 4e5], [0.3, 4e5]]\nunloading = [[0, 1e5], [0.3, 1e5]]";
  const Signal s = pulse_of(g);
  const double mu = reduced(g), force = 8e5, stop = mu * g.v / force; // two buffers beside each other
  CHECK(s.value(0.1 + 0.5 * stop) == doctest::Approx(-force / g.m).epsilon(1e-12));
  CHECK(s.value(0.1 + 1.5 * stop) == doctest::Approx(-force / 4.0 / g.m).epsilon(1e-12));
  CHECK(end_of(s) == doctest::Approx(0.1 + stop + 2.0 * stop).epsilon(1e-9)); // a quarter of the force, half the speed: twice the time
  CHECK(given_back(g, s) == doctest::Approx(0.25).epsilon(1e-9));
}

// An impact oscillator with damping: x = v/ω_d e^{−ζωt} sin ω_d t while the buffers push.
TEST_CASE("a damped buffer follows the damped oscillator and does not pull") {
  ShuntingCase g;
  const double k = 5.6e6, mu = reduced(g), zeta = 0.3, omega = std::sqrt(k / mu), omega_d = omega * std::sqrt(1.0 - zeta * zeta);
  g.curves += "\ndamping = " + std::to_string(2.0 * zeta * omega * mu); // of one buffer: as of all together
  const Signal s = pulse_of(g);
  for (int i = 0; i < 30; ++i) {
    const double t = 0.04 / omega + i * 0.08 / omega, decay = std::exp(-zeta * omega * t), sine = std::sin(omega_d * t),
                 cosine = std::cos(omega_d * t);
    const double x = g.v / omega_d * decay * sine, rate = g.v * decay * (cosine - zeta * omega / omega_d * sine);
    CHECK(s.value(0.1 + t) == doctest::Approx(-(k * x + 2.0 * zeta * omega * mu * rate) / g.m).epsilon(1e-7));
  }
  for (double t = 0.0; t < 0.5; t += 1e-3) CHECK(s.value(t) <= 0.0);
  CHECK(given_back(g, s) < 1.0);
}

TEST_CASE("an end stop is met at its travel and pushes with its stiffness") {
  ShuntingCase g;
  g.v = 3.0;
  g.curves = "buffer = [[0, 0], [0.1, 5e5]]\nstop_stiffness = 5e7";
  const Signal s = pulse_of(g);
  const double mu = reduced(g), k = 5e6, stop_k = 5.5e7; // the stop adds to the last slope
  const double left = g.v * g.v - k * 0.2 * 0.2 / mu;    // of the closing speed's square where the stop is met
  const double omega = std::sqrt(stop_k / mu), at_stop = 1e6 / mu;
  double peak = 0.0, t_peak = 0.0;
  for (double t = 0.0; t < 0.3; t += 1e-5)
    if (s.value(0.1 + t) < peak) peak = s.value(0.1 + t), t_peak = t;
  // 2 f = 1 MN at the stop, then a circle: F² = F_s² + stiffness μ v².
  CHECK(peak == doctest::Approx(-mu / g.m * std::sqrt(at_stop * at_stop + omega * omega * left)).epsilon(1e-6));
  CHECK(closed(g, s, t_peak) > 0.2);
  CHECK(given_back(g, s) == doctest::Approx(1.0).epsilon(1e-7)); // all of it is elastic
}

// Momentum and energy for any curves: what is given back is what the unloading curve holds under the travel reached.
TEST_CASE("energy and momentum balance for random buffers") {
  std::mt19937 random(28);
  // Of three decimals, which the text of the model holds.
  const auto between = [&random](double low, double high) {
    return std::round(1e3 * (low + (high - low) * (static_cast<double>(random()) / 4294967295.0))) / 1e3;
  };
  for (int i = 0; i < 200; ++i) {
    ShuntingCase g;
    g.m = between(2e4, 2e5);
    g.other = between(2e4, 2e5);
    g.v = between(0.5, 3.0);
    g.other_v = between(-0.4, 0.4);
    const double share = between(0.2, 1.0), middle = between(0.03, 0.08), f1 = between(5e4, 2e5), f2 = f1 * between(1.0, 4.0),
                 f0 = between(0.0, 3e4);
    const auto curve = [&](double by) {
      return "[[0, " + std::to_string(by * f0) + "], [" + std::to_string(middle) + ", " + std::to_string(by * f1) + "], [0.105, " +
             std::to_string(by * f2) + "]]";
    };
    g.curves = "buffer = " + curve(1.0) + "\nunloading = " + curve(share) + "\nstop_stiffness = 6e7";
    const Signal s = pulse_of(g);
    double most = 0.0;
    for (double t = 0.0; t < end_of(s) - g.start; t += 1e-4) most = std::max(most, closed(g, s, t));
    const double back = given_back(g, s);
    CAPTURE(i);
    if (most < 0.21) CHECK(back == doctest::Approx(share).epsilon(1e-7)); // the same shape, less high
    else {                                                                // the stop gives all back
      CHECK(back >= share * (1.0 - 1e-6));
      CHECK(back <= 1.0 + 1e-9);
    }
    CHECK(velocity_change(s) < 0.0);
    for (std::size_t k = 1; k < s.breakpoints().size(); ++k) CHECK(s.breakpoints()[k] > s.breakpoints()[k - 1]);
  }
}

TEST_CASE("what is not two wagons is refused with one error") {
  const auto refused = [](const ShuntingCase& g, const std::string& part) {
    try {
      static_cast<void>(pulse_of(g));
      FAIL(part);
    } catch (const ModelError& error) {
      CHECK_MESSAGE(error.diagnostics().size() == 1, std::string(error.what()));
      CHECK_MESSAGE(std::string(error.what()).find(part) != std::string::npos, std::string(error.what()));
    }
  };
  const auto with = [](const std::string& curves) {
    ShuntingCase g;
    g.curves = curves;
    return g;
  };
  ShuntingCase same;
  same.other_v = same.v;
  refused(same, "never meet");
  refused(with("buffer = [[0, 0]]"), "two points or more");
  refused(with("buffer = [[0.01, 0], [0.1, 1e5]]"), "begin at travel 0");
  refused(with("buffer = [[0, 0], [0.1, 1e5], [0.1, 2e5]]"), "ascend");
  refused(with("buffer = [[0, -5], [0.1, 1e5]]"), "negative");
  refused(with("buffer = [[0, 0], [0.1, 0]]"), "no force");
  refused(with("buffer = [[0, 0], [0.1, 1e5]]\nunloading = [[0, 0], [0.2, 1e5]]"), "same travel");
  refused(with("buffer = [[0, 0], [0.1, 1e5]]\nunloading = [[0, 0], [0.05, 9e4], [0.1, 1e5]]"), "give back more");
  refused(with("buffer = [[0, 0], [0.1, 1e5]]"), "J are left: give the 'stop_stiffness'");
  refused(with(""), "buffer");
  ShuntingCase light;
  light.m = 0.0;
  refused(light, "mass");
}

// The other way to the same pulse: two bodies and a contact as stiff as the four buffers, run by the equations of motion.
TEST_CASE("the pulse is that of two wagons that are simulated") {
  ShuntingCase g;
  const Signal s = pulse_of(g);
  const Model model =
      parse_model("gravity = [0, 0]\n[simulation]\nend = 0.5\n[[body]]\nname = 'wagon'\nmass = 87e3\ninertia = 1\nvelocity = [2, 0]\n"
                  "[[body]]\nname = 'other'\nmass = 80e3\ninertia = 1\nposition = [5, 0]\n"
                  "[[element]]\nkind = 'unilateral_contact'\nname = 'buffers'\na = 'wagon'\nb = { body = 'other', at = [0.2, 0] }\nnormal "
                  "= [-1, 0]\nstiffness = 5.6e6\n",
                  "wagons.toml", element_catalog());
  const auto system = compile(model);
  SimulationOptions options;
  options.end = 0.5;
  options.integrator = "dop853";
  options.settings.tolerance = 1e-11;
  options.output_step = 1e-3;
  const RunResult run = simulate(*system, system->initial_state(), options);
  const std::vector<double>& times = run.trajectory->times();
  const std::vector<double> ax = run.trajectory->series("wagon.ax");
  // They meet when 0.2 m are closed at 2 m/s: at 0.1 s, as the pulse begins.
  for (std::size_t i = 0; i < times.size(); ++i) CHECK(std::abs(ax[i] - s.value(times[i])) < 1e-6 * 12.0);
}
