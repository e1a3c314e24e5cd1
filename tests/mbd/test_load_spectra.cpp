// Spectra of roads and random vibrations, over 100 seeds: by Welch's method, against their laws within chi-square's bounds.
#include "mbd/model/signal.h"
#include "tests/mbd/made_signal.h"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr int k_seeds = 100;

// One-sided density at `frequency` of the stretch of `length` from `start` on, by a window of Hann.
double periodogram(const Signal& signal, double frequency, double start, double length, int samples) {
  std::complex<double> sum = 0.0;
  const double dt = length / samples;
  for (int i = 0; i < samples; ++i) {
    const double t = (i + 0.5) * dt, window = 0.5 - 0.5 * std::cos(2.0 * k_pi * t / length);
    sum += window * signal.value(start + t) * std::polar(1.0, -2.0 * k_pi * frequency * t);
  }
  return 2.0 * std::norm(sum * dt) / (0.375 * length); // 3/8: the mean square of the window
}

// Quantiles of chi-square by the cube root of Wilson and Hilferty, within 1 % for 16 degrees of freedom and more.
double chi_square(double freedom, double z) {
  return freedom * std::pow(1.0 - 2.0 / (9.0 * freedom) + z * std::sqrt(2.0 / (9.0 * freedom)), 3);
}

struct Spread {
  double mean = 0.0;    ///< of all estimates, over the law
  double outside = 0.0; ///< share of those of one seed outside of the range of 95 %
};

// `estimate(seed, part)`: a density over its law, `parts` of them independent for each seed.
template <class Estimate> Spread spread_of(int parts, const Estimate& estimate) {
  const double freedom = 2.0 * parts, low = chi_square(freedom, -1.96) / freedom, high = chi_square(freedom, 1.96) / freedom;
  Spread spread;
  for (int seed = 1; seed <= k_seeds; ++seed) {
    double sum = 0.0;
    for (int k = 0; k < parts; ++k) sum += estimate(seed, k) / parts;
    spread.mean += sum / k_seeds;
    if (sum < low || sum > high) spread.outside += 1.0 / k_seeds;
  }
  return spread;
}

// All estimates together: a range of 99.9 %. Of a seed alone one in twenty may be outside; more than 14 in 100 once in 5000
// times.
void check(const Spread& spread, int parts) {
  const double freedom = 2.0 * parts * k_seeds;
  CHECK(spread.mean > chi_square(freedom, -3.29) / freedom);
  CHECK(spread.mean < chi_square(freedom, 3.29) / freedom);
  CHECK(spread.outside < 0.145);
}

double mean_square(const std::vector<Signal::Harmonic>& waves, bool is_rate) {
  double sum = 0.0;
  for (const Signal::Harmonic& h : waves) sum += 0.5 * std::pow(h.amplitude * (is_rate ? h.frequency : 1.0), 2);
  return sum;
}

} // namespace

// 14 waves to a window, so that it resolves resonances of 5 % damping; places far enough apart for the waves of a band to be out
// of step.
TEST_CASE("the spectrum of a road is its class's, within the confidence of the estimate") {
  constexpr double k_roughness = 256e-6, k_waves = 14.0, k_apart = 200.0;
  constexpr int k_parts = 8, k_samples = 448; // 32 to a wave: what shorter waves fold onto it is below 0.5 %
  std::vector<Signal> roads;
  for (long seed = 1; seed <= k_seeds; ++seed)
    roads.push_back(made_signal("road", {{"class", std::string("C")}, {"speed", 1.0}, {"seed", seed}, {"run_in", 1.0}}));
  for (const double n : {0.02, 0.15, 0.6, 2.3}) {
    CAPTURE(n);
    check(spread_of(k_parts,
                    [&](int seed, int k) {
                      const double x = 1.0 + k * (k_waves + k_apart) / n;
                      return periodogram(roads[seed - 1], n, x, k_waves / n, k_samples) / (k_roughness * std::pow(n / 0.1, -2));
                    }),
          k_parts);
  }
}

TEST_CASE("the r.m.s. of a road's height and of its rate are the integrals of the band") {
  const double v = 40.0 / 3.6, g = 256e-6 * 0.01, from = 0.011, to = 2.83;
  for (long seed = 1; seed <= 5; ++seed) {
    const Signal road = made_signal("road", {{"class", std::string("C")}, {"speed", v}, {"seed", seed}});
    const std::vector<Signal::Harmonic>& waves = road.pieces().back().harmonics;
    CHECK(mean_square(waves, false) == doctest::Approx(g * (1.0 / from - 1.0 / to)).epsilon(1e-12));
    // Wave numbers are drawn within bands of 1.25 %: 0.36 % each, over the root of 100 that count.
    CHECK(mean_square(waves, true) == doctest::Approx(g * std::pow(2.0 * k_pi * v, 2) * (to - from)).epsilon(2e-3));
  }
  // What a run sees: 100 roads, each at 8 places; a mean square of half a dozen long waves is known to a quarter from one of
  // them.
  double height = 0.0, rate = 0.0;
  for (long seed = 1; seed <= k_seeds; ++seed) {
    const Signal road = made_signal("road", {{"class", std::string("C")}, {"speed", v}, {"seed", seed}});
    for (int k = 0; k < 8; ++k) {
      const SignalJet jet = road.drive(100.0 + 977.0 * k, DriveLevel::position);
      height += std::pow(jet.value + road.value(0.0), 2) / (8.0 * k_seeds);
      rate += std::pow(jet.rate, 2) / (8.0 * k_seeds);
    }
  }
  const double tolerance = 3.3 * std::sqrt(2.0 / 800.0); // of chi-square with 800 degrees of freedom
  CHECK(height == doctest::Approx(g * (1.0 / from - 1.0 / to)).epsilon(tolerance));
  CHECK(rate == doctest::Approx(g * std::pow(2.0 * k_pi * v, 2) * (to - from)).epsilon(tolerance));
}

namespace {

const std::vector<double> k_frequencies{5.0, 20.0, 40.0, 60.0}, k_densities{0.002, 0.02, 0.02, 0.0005};

double tabled(double f) {
  std::size_t i = 1;
  while (f > k_frequencies[i]) ++i;
  const double slope = std::log(k_densities[i] / k_densities[i - 1]) / std::log(k_frequencies[i] / k_frequencies[i - 1]);
  return k_densities[i - 1] * std::pow(f / k_frequencies[i - 1], slope);
}

Signal vibration(long seed) {
  return made_signal("random", {{"frequencies", k_frequencies},
                                {"densities", k_densities},
                                {"factor", 9.80665},
                                {"duration", 14.0},
                                {"rise", 1.0},
                                {"fall", 1.0},
                                {"seed", seed}});
}

} // namespace

TEST_CASE("the spectrum of a random vibration is its table's, its r.m.s. the integral, its values Gaussian") {
  constexpr double k_length = 1.2; // s, of a window: two of its resolutions are 2.4 Hz, within which the table is nearly straight
  constexpr int k_parts = 10, k_samples = 240;
  std::vector<Signal> vibrations;
  for (long seed = 1; seed <= k_seeds; ++seed) vibrations.push_back(vibration(seed));
  for (const double f : {10.0, 33.0, 50.0}) {
    CAPTURE(f);
    check(spread_of(k_parts,
                    [&](int seed, int k) {
                      return periodogram(vibrations[seed - 1], f, 1.0 + k * k_length, k_length, k_samples) /
                             (tabled(f) * std::pow(9.80665, 2));
                    }),
          k_parts);
  }
  double exact = 0.0;
  constexpr int k_steps = 20000; // the midpoint rule: 1e-8
  for (int i = 0; i < k_steps; ++i) exact += tabled(5.0 + 55.0 * (i + 0.5) / k_steps) * 55.0 / k_steps * std::pow(9.80665, 2);
  double second = 0.0, fourth = 0.0;
  constexpr int k_looks = 60;
  for (const Signal& signal : vibrations)
    for (int k = 0; k < k_looks; ++k) {
      const double x = signal.value(1.1 + 0.19 * k);
      second += x * x / (k_looks * k_seeds);
      fourth += std::pow(x, 4) / (k_looks * k_seeds);
    }
  // Looks 0.19 s apart are independent: the band is 30 Hz wide. Variances of the estimates: 2/n and 96/n of a Gaussian's 1 and 3.
  const double count = k_looks * k_seeds;
  CHECK(second == doctest::Approx(exact).epsilon(3.3 * std::sqrt(2.0 / count)));
  CHECK(std::abs(fourth / (second * second) - 3.0) < 3.3 * std::sqrt(24.0 / count));
}
