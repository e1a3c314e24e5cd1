// Tops of polynomials through their values at the points of Chebyshev and Lobatto, against the same polynomials looked at in ten
// thousand places: whichever gap between points the top lies in, and whatever is higher beside it.
#include "mbd/simulation/node_polynomial.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;

namespace {

constexpr int k_places = 10'000;
// Between two of so many places a polynomial of the eighth degree on [0, 1] exceeds both by at most |p''| / 8 of their distance's
// square, and |p''| ≤ n² (n² − 1) / 3 · 4 · max |p| (Markov): 5376/8 · 1e-8 · 2.3 of the largest value at the points.
constexpr double k_between = 2e-5;
struct Dense {
  double top = 0.0, at = 0.0;
};

Dense top_of(const NodePolynomial& p) {
  Dense dense{p.at(0.0), 0.0};
  for (int i = 1; i <= k_places; ++i) {
    const double theta = static_cast<double>(i) / k_places, value = p.at(theta);
    if (value > dense.top) dense = {value, theta};
  }
  return dense;
}

int gap_of(double theta, int level) {
  int gap = 0;
  for (int place = NodePolynomial::spacing(level); place < NodePolynomial::k_last && NodePolynomial::theta(place) < theta;
       place += NodePolynomial::spacing(level))
    ++gap;
  return gap;
}

} // namespace

TEST_CASE("a polynomial's top is found in whichever gap between its points it lies") {
  random::RandomNumber random(41);
  int elsewhere = 0;
  for (int i = 0; i < 900; ++i) {
    const int level = 1 + i % NodePolynomial::k_levels, n = 1 << level;
    CAPTURE(i);
    NodePolynomial::Values values{};
    for (int k = 0; k <= n; ++k) values[k] = random.between(-1.0, 1.0);
    const NodePolynomial p(level, values);
    const Dense dense = top_of(p);
    const int highest = static_cast<int>(std::max_element(values.begin(), values.begin() + n + 1) - values.begin());
    const int gap = gap_of(dense.at, level);
    if (gap != highest && gap != highest - 1) ++elsewhere;
    const auto top = p.top_above(-2.0, 1e-9);
    REQUIRE(top);
    CHECK(top->value >= dense.top - 1e-9);
    CHECK(top->value <= dense.top + k_between);
    CHECK(std::abs(p.at(top->theta) - top->value) < 1e-12); // rounding of nine terms
    // Asked for more than there is it says so; asked for a little less it has it.
    CHECK(!p.top_above(top->value + 1e-8, 1e-9));
    CHECK(p.top_above(top->value - 1e-6, 1e-9));
  }
  CHECK(elsewhere > 10); // what a look beside the highest point would have missed
}

TEST_CASE("a polynomial that exceeds its points most is not taken for lower") {
  // Values by the signs of Lagrange's polynomials where the sum of their sizes is largest.
  for (int level = 1; level <= NodePolynomial::k_levels; ++level) {
    const int n = 1 << level, step = NodePolynomial::spacing(level);
    double most = 0.0;
    for (int place = 0; place <= 400; ++place) {
      const double theta = place / 400.0;
      NodePolynomial::Values values{};
      for (int i = 0; i <= n; ++i) {
        double basis = 1.0;
        for (int k = 0; k <= n; ++k)
          if (k != i)
            basis *= (theta - NodePolynomial::theta(k * step)) / (NodePolynomial::theta(i * step) - NodePolynomial::theta(k * step));
        values[i] = basis < 0.0 ? -1.0 : 1.0;
      }
      const NodePolynomial p(level, values);
      const double value = p.at(theta);
      most = std::max(most, value);
      const auto top = p.top_above(value - 1e-6, 1e-9);
      REQUIRE(top);
      CHECK(top->value >= value - 1e-9);
    }
    CHECK(most == doctest::Approx(level == 1 ? 1.25 : level == 2 ? 1.7988 : 2.2747).epsilon(1e-3)); // Lebesgue's constants
  }
}

// With the parabolas' own values a curve is at most as high as they show: the top of one that opens downwards, in closed form.
TEST_CASE("whether parabolas through points may exceed a limit") {
  random::RandomNumber random(43);
  for (int i = 0; i < 3000; ++i) {
    const int level = 1 + i % NodePolynomial::k_levels, n = 1 << level, step = NodePolynomial::spacing(level);
    const double bend = random.decades(-3.0, 1.0), vertex = random.between(-0.2, 1.2), height = random.between(-1.0, 1.0),
                 sign = random.chance(0.5) ? 1.0 : -1.0;
    NodePolynomial::Values values{};
    double best = -1e300;
    for (int k = 0; k <= n; ++k) {
      const double off = NodePolynomial::theta(k * step) - vertex, value = height - bend * off * off;
      values[k] = sign * value;
      best = std::max(best, value);
    }
    const double inside = std::clamp(vertex, 0.0, 1.0) - vertex, top = height - bend * inside * inside;
    const double error = random.chance(0.5) ? 0.0 : random.decades(-6.0, -2.0);
    CAPTURE(i);
    CHECK(NodePolynomial::may_exceed(top + error - 1e-9, error, level, values, sign, best));
    // What is shown beyond the highest point counts twice.
    CHECK(!NodePolynomial::may_exceed(best + 2.0 * (top - best) + error + 1e-9, error, level, values, sign, best));
  }
}

TEST_CASE("weights of a level at the points of the next one give the polynomial's value there") {
  random::RandomNumber random(44);
  for (int level = 1; level < NodePolynomial::k_levels; ++level)
    for (int gap = 0; gap < 1 << level; ++gap) {
      const int n = 1 << level, step = NodePolynomial::spacing(level);
      NodePolynomial::Values values{};
      for (int k = 0; k <= n; ++k) values[k] = random.between(-1.0, 1.0);
      const double theta = NodePolynomial::theta(gap * step + step / 2);
      const NodePolynomial::Weights& weights = NodePolynomial::weights_at(level, theta);
      double sum = 0.0;
      for (int k = 0; k <= n; ++k) sum += weights.of[k] * values[k];
      CHECK(sum / weights.sum == NodePolynomial(level, values).at(theta)); // the same operations
    }
}
