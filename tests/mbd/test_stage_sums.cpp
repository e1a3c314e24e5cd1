// Sums of the stages of explicit methods: whatever registers they are made in, each number has the bits of the sum written down as a
// loop.
#include "mbd/integrators/explicit_runge_kutta.h"
#include "mbd/integrators/tableau_dop853.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

using namespace steplap;

namespace {

constexpr int k_stride = 19; // no multiple of a register's numbers
constexpr std::size_t k_stages = 16;

// Of sizes from 1e-12 to 1e12, zeros of both signs among them.
std::vector<double> numbers(random::RandomNumber& draw, std::size_t count) {
  std::vector<double> all(count);
  for (double& x : all) {
    x = draw.either(0.1, 1.0) * std::pow(10.0, draw.between(-12.0, 12.0));
    if (draw.chance(0.1)) x = std::copysign(0.0, x);
  }
  return all;
}

bool is_same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

double sum_of(const double* coefficients, const double* k, std::size_t stages) {
  double sum = 0.0;
  for (std::size_t j = 0; j < stages; ++j)
    if (coefficients[j] != 0.0) sum += coefficients[j] * k[j * k_stride];
  return sum;
}

} // namespace

TEST_CASE("sums of stages: the same bits by one, two and four numbers at a time") {
  random::RandomNumber draw(7);
  for (int run = 0; run < 200; ++run) {
    const std::vector<double> k = numbers(draw, k_stages * k_stride), y = numbers(draw, k_stride);
    const double h = std::pow(10.0, draw.between(-9.0, 1.0));
    for (int n = 1; n <= k_stride; ++n) {
      std::vector<double> combined(k_stride, 7.0), weighted(k_stride, 7.0), scaled(k_stride, 7.0), by_two(k_stride, 7.0);
      combine<dop853::a, 12, 12>(y.data(), h, k.data(), k_stride, n, combined.data());
      weighted_sum<dop853::e5, 12>(k.data(), k_stride, n, weighted.data());
      weighted_row<dop853::d, 2, 16>(h, k.data(), k_stride, n, scaled.data());
      put_sums_by_two<[](std::size_t j) { return dop853::e5[j]; }, 12>(k.data(), k_stride, 0, n, by_two.data(), UnchangedSum{});
      bool are_same = true;
      for (int i = 0; i < n; ++i) {
        are_same = are_same && is_same(combined[i], y[i] + h * sum_of(&dop853::a[12][0], &k[i], 12));
        are_same = are_same && is_same(weighted[i], sum_of(&dop853::e5[0], &k[i], 12)) && is_same(by_two[i], weighted[i]);
        are_same = are_same && is_same(scaled[i], h * sum_of(&dop853::d[2][0], &k[i], 16));
      }
      for (int i = n; i < k_stride; ++i) are_same = are_same && combined[i] == 7.0 && weighted[i] == 7.0 && scaled[i] == 7.0;
      CHECK(are_same);
    }
  }
}

TEST_CASE("what is done with each number by itself: the same bits by one, two and four at a time") {
  random::RandomNumber draw(8);
  for (int run = 0; run < 200; ++run) {
    const double factor = draw.either(0.1, 1.0);
    std::vector<double> x = numbers(draw, k_stride), y = numbers(draw, k_stride);
    x[static_cast<std::size_t>(run) % k_stride] = std::numeric_limits<double>::quiet_NaN(); // is not less than anything
    for (int n = 1; n <= k_stride; ++n) {
      std::vector<double> line(k_stride, 7.0), least(k_stride, 7.0);
      for_numbers(
          n, [&]<class S>(int i) __attribute__((always_inline)) {
            S a, b;
            read_numbers(x.data() + i, a);
            read_numbers(y.data() + i, b);
            const S sum = b + factor * (a - b), less = a < b ? a : b;
            std::memcpy(line.data() + i, &sum, sizeof sum);
            std::memcpy(least.data() + i, &less, sizeof less);
          });
      bool are_same = true;
      for (int i = 0; i < n; ++i) {
        const double sum = y[i] + factor * (x[i] - y[i]);
        are_same = are_same && (is_same(line[i], sum) || (std::isnan(line[i]) && std::isnan(sum)));
        are_same = are_same && is_same(least[i], x[i] < y[i] ? x[i] : y[i]);
      }
      for (int i = n; i < k_stride; ++i) are_same = are_same && line[i] == 7.0 && least[i] == 7.0;
      CHECK(are_same);
    }
  }
}
