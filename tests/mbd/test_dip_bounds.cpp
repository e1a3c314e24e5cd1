// Tests the bounds of a function between its nodes (PartPolynomial, EventNodes) on thousands of sums of harmonics whose minimum is known: no
// sum with a negative minimum may be reported as positive.
#include "mbd/base/part_polynomial.h"
#include "mbd/integrators/event_nodes.h"
#include "mbd/integrators/tableau_dop853.h"
#include "mbd/integrators/tableau_tsit5.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace steplap;
using random::RandomNumber;

namespace {

constexpr int k_cases = 4000;
constexpr double k_turn = 1.6; // rad, of the fastest harmonic in a step
constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();

// Σ A cos(ω x + φ) + c, x in [0, 1].
struct Wave {
  std::vector<double> amplitude, omega, phase;
  double c = 0.0;

  [[nodiscard]] double at(double x) const {
    double sum = c;
    for (std::size_t i = 0; i < amplitude.size(); ++i) sum += amplitude[i] * std::cos(omega[i] * x + phase[i]);
    return sum;
  }
  [[nodiscard]] double slope(double x) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < amplitude.size(); ++i) sum -= amplitude[i] * omega[i] * std::sin(omega[i] * x + phase[i]);
    return sum;
  }
};

// Least value and its place in [0, 1], to rounding.
double least_of(const Wave& f, double& at) {
  constexpr int k_grid = 100;
  double least = std::min(f.at(0.0), f.at(1.0));
  at = f.at(0.0) < f.at(1.0) ? 0.0 : 1.0;
  for (int i = 0; i < k_grid; ++i) {
    double a = static_cast<double>(i) / k_grid, b = static_cast<double>(i + 1) / k_grid;
    if (!(f.slope(a) < 0.0 && f.slope(b) >= 0.0)) continue;
    for (int k = 0; k < 60; ++k) (f.slope(0.5 * (a + b)) < 0.0 ? a : b) = 0.5 * (a + b);
    if (f.at(b) < least) {
      least = f.at(b);
      at = b;
    }
  }
  return least;
}

Wave random_wave(RandomNumber& random) {
  Wave f;
  const int count = 1 + random.below(3);
  const double turn = random.decades(-1.5, std::log10(k_turn));
  for (int i = 0; i < count; ++i) {
    f.amplitude.push_back(random.either(0.1, 1.0));
    f.omega.push_back(i == 0 ? turn : turn * random.between(0.1, 1.0));
    f.phase.push_back(random.between(0.0, 6.283185307179586));
  }
  return f;
}

// A wave whose bottom lies inside the step, `depth` of its range below zero.
Wave random_dip(RandomNumber& random, double depth, double& bottom) {
  for (;;) {
    Wave f = random_wave(random);
    const double least = least_of(f, bottom);
    if (bottom <= 0.0 || bottom >= 1.0) continue;
    const double range = std::max(f.at(0.0), f.at(1.0)) - least;
    f.c -= least + depth * range;
    return f;
  }
}

PartPolynomial polynomial_of(const Wave& f) {
  PartPolynomial::Values values;
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = f.at(PartPolynomial::node(k));
  PartPolynomial p;
  p.fit(values);
  return p;
}

bool is_positive_at_places(const Wave& f) {
  for (std::size_t k = 0; k <= PartPolynomial::k_order; ++k)
    if (!(f.at(PartPolynomial::node(k)) > 0.0)) return false;
  return true;
}

template <class Places> EventNodes nodes_of(const Wave& f, const Places& places) {
  EventNodes nodes(1);
  for (const double x : places) {
    const double value = f.at(x);
    nodes.add(x, &value, true);
  }
  const double start = f.at(0.0), end = f.at(1.0);
  nodes.close(&start, &end);
  return nodes;
}

EventStep watched(const Wave& f, bool has_slopes, bool is_merged = false) {
  return {0, is_merged, false, {f.at(0.0), has_slopes ? f.slope(0.0) : k_unknown}, {f.at(1.0), has_slopes ? f.slope(1.0) : k_unknown}};
}

const std::vector<std::vector<double>> k_places = {{dop853::c.begin() + 1, dop853::c.begin() + 11},
                                                   {tsit5::c.begin() + 1, tsit5::c.begin() + 5},
                                                   {0.27639320225002106, 0.72360679774997894},
                                                   {0.5}};

} // namespace

TEST_CASE("a polynomial of order 6 is what it goes through, and up to order 4 certain of it") {
  RandomNumber random(1);
  for (int i = 0; i < 200; ++i) {
    std::vector<double> c;
    for (int k = 0; k <= 6; ++k) c.push_back(random.either(0.1, 1.0));
    const int degree = random.below(7);
    const auto f = [&](double x) {
      double sum = 0.0;
      for (int k = degree; k >= 0; --k) sum = sum * x + c[static_cast<std::size_t>(k)];
      return sum;
    };
    PartPolynomial::Values values;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = f(PartPolynomial::node(k));
    PartPolynomial p;
    p.fit(values);
    for (double x = 0.0; x <= 1.0; x += 0.01) CHECK(std::abs(p.at(x) - f(x)) < 1e-14 * 7.0);
    if (degree <= 4) CHECK(p.error() < 1e-14 * 7.0);
    else CHECK(p.error() > 0.0);
    const double least = p.at(p.lowest(0, 6));
    for (double x = 0.0; x <= 1.0; x += 0.01) CHECK(f(x) > least - 1e-8); // of a section of a hundredth, forty times golden
  }
}

TEST_CASE("no dip of a sum of harmonics is clear by the polynomial through its places, however slight") {
  RandomNumber random(2);
  int dips = 0, clear = 0, above = 0;
  for (int i = 0; i < k_cases; ++i) {
    double bottom = 0.0;
    const double depth = random.decades(-13.0, -0.5);
    const Wave dip = random_dip(random, depth, bottom);
    if (is_positive_at_places(dip)) {
      ++dips;
      CHECK(polynomial_of(dip).first_uncertain_gap(0.0, 0, 6) >= 0);
    }
    // The other way about: what is above zero by more than the polynomial may be off is clear, or there would be no end.
    const Wave miss = random_dip(random, -depth, bottom);
    const PartPolynomial p = polynomial_of(miss);
    double at = 0.0;
    if (least_of(miss, at) <= 2.1 * p.error() + 1e-14) continue;
    ++above;
    if (p.first_uncertain_gap(0.0, 0, 6) < 0) ++clear;
  }
  CHECK(dips > k_cases / 2);
  CHECK(above > k_cases / 4);
  CHECK(clear == above);
}

TEST_CASE("a bottom that is a place of both parts beside it is not between them") {
  RandomNumber random(3);
  for (int i = 0; i < k_cases; ++i) {
    // The algorithm by itself: divided at the polynomial's bottom until a place is below zero or all is clear.
    double bottom = 0.0;
    const double depth = random.decades(-12.0, -1.0) * (random.chance(0.5) ? 1.0 : -1.0);
    const Wave f = random_dip(random, depth, bottom);
    std::vector<std::pair<double, double>> parts{{0.0, 1.0}};
    bool is_found = f.at(0.0) < 0.0 || f.at(1.0) < 0.0;
    int divided = 0;
    while (!parts.empty() && !is_found) {
      const auto [begin, end] = parts.back();
      parts.pop_back();
      PartPolynomial::Values values;
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = f.at(begin + PartPolynomial::node(k) * (end - begin));
        is_found = is_found || values[k] < 0.0;
      }
      PartPolynomial p;
      p.fit(values);
      if (is_found || p.first_uncertain_gap(0.0, 0, 6) < 0) continue;
      const double cut = begin + std::clamp(p.lowest(0, 6), 0.1, 0.9) * (end - begin);
      parts.push_back({begin, cut});
      parts.push_back({cut, end});
      REQUIRE(++divided < 60);
    }
    CHECK(is_found == (depth > 0.0));
  }
}

TEST_CASE("a fall through zero is single if it is, and not certain if it is none") {
  RandomNumber random(4);
  int certain = 0, falls = 0;
  for (int i = 0; i < k_cases; ++i) {
    const Wave f = [&random] {
      Wave w = random_wave(random);
      w.c -= w.at(random.between(0.0, 1.0));
      return w;
    }();
    const PartPolynomial p = polynomial_of(f);
    for (std::size_t gap = 0; gap < 6; ++gap) {
      const double a = PartPolynomial::node(gap), b = PartPolynomial::node(gap + 1);
      if (!(f.at(a) > 0.0 && f.at(b) < 0.0)) continue;
      ++falls;
      int crossings = 0;
      for (int m = 0; m < 200; ++m) {
        const double x0 = a + (b - a) * m / 200.0, x1 = a + (b - a) * (m + 1) / 200.0;
        if ((f.at(x0) > 0.0) != (f.at(x1) > 0.0)) ++crossings;
      }
      if (!p.falls_once(0.0, gap)) continue;
      ++certain;
      CHECK(crossings == 1);
    }
  }
  CHECK(falls > k_cases / 4);
  CHECK(certain > falls / 2);
}

TEST_CASE("no dip of a sum of harmonics is certain or far by the places of any method's step") {
  RandomNumber random(5);
  for (const std::vector<double>& places : k_places)
    for (int i = 0; i < k_cases; ++i) {
      double bottom = 0.0;
      const Wave f = random_dip(random, random.decades(-13.0, -0.5), bottom);
      if (f.at(0.0) < 0.0 || f.at(1.0) < 0.0) continue;
      const EventNodes nodes = nodes_of(f, places);
      CAPTURE(places.size());
      CAPTURE(i);
      CHECK(2.0 * nodes.low(0) <= nodes.high(0));
      CHECK_FALSE(nodes.is_proven_positive(watched(f, random.chance(0.5))));
    }
}

TEST_CASE("a dip before a crossing is not taken for a single crossing") {
  RandomNumber random(6);
  for (const std::vector<double>& places : k_places) {
    int single = 0, certain = 0;
    for (int i = 0; i < k_cases / 4; ++i) {
      Wave f = random_wave(random);
      f.c -= f.at(random.between(0.0, 1.0)) + (random.chance(0.5) ? random.decades(-12.0, -2.0) : 0.0);
      if (!(f.at(0.0) > 0.0 && f.at(1.0) < 0.0)) continue;
      std::vector<double> crossings;
      for (int m = 0; m < 400; ++m)
        if ((f.at(m / 400.0) > 0.0) != (f.at((m + 1) / 400.0) > 0.0)) crossings.push_back(m / 400.0);
      const bool is_certain = nodes_of(f, places).crosses_once(watched(f, random.chance(0.5)));
      single += crossings.size() == 1 ? 1 : 0;
      certain += is_certain ? 1 : 0;
      if (crossings.size() > 1) { // unless a place between the first two has seen it
        const bool is_seen =
            std::any_of(places.begin(), places.end(), [&](double x) { return f.at(x) < 0.0 && x < crossings[1] + 1.0 / 400.0; });
        CHECK((is_seen || !is_certain));
      }
    }
    CHECK(single > k_cases / 32);
    CHECK((places.size() == 1 || certain > single / 2)); // of three places nothing is certain
  }
}

TEST_CASE("values of merged joints are judged by the places that have looked at them") {
  // A dip in the middle that two looks straddle. What stages without a look show is the value of the look before.
  Wave f;
  f.amplitude = {1.0};
  f.omega = {1.6};
  f.phase = {3.141592653589793 - 1.6 * 0.46};
  f.c = 1.0 - 1e-3;
  EventNodes nodes(1);
  double last = f.at(0.0);
  for (std::size_t s = 1; s < 11; ++s) {
    const bool is_look = s == 4 || s == 8;
    if (is_look) last = f.at(dop853::c[s]);
    nodes.add(dop853::c[s], &last, is_look);
  }
  const double start = f.at(0.0), end = f.at(1.0);
  nodes.close(&start, &end);
  CHECK(nodes.low(0) > 0.0);
  CHECK(f.at(0.46) < 0.0);
  CHECK_FALSE(nodes.is_proven_positive(watched(f, false, true)));
}
