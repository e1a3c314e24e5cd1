// Sines, angles, powers: to the error that portable_math.h states, against 113-bit arithmetic.
#include "mbd/base/portable_math.h"

#include <doctest/doctest.h>
#include <quadmath.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace steplap;

namespace {

using Exact = __float128;

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr int k_count = 20000; // of each kind: half a second in all

// |got − exact| in units in the last place of the exact value; subnormal numbers have that of the least normal ones.
double error_of(double got, Exact exact) {
  const auto nearest = static_cast<double>(exact);
  if (std::isnan(nearest)) return std::isnan(got) ? 0.0 : k_infinity;
  if (std::isinf(nearest) || std::isinf(got)) return nearest == got ? 0.0 : k_infinity;
  int exponent = -1074;
  if (nearest != 0.0) std::frexp(nearest, &exponent);
  const double unit = std::ldexp(1.0, nearest == 0.0 ? -1074 : std::max(exponent - 53, -1074));
  const Exact error = got - exact;
  return static_cast<double>((error < 0 ? -error : error) / unit);
}

bool is_subnormal(Exact x) { return std::abs(static_cast<double>(x)) < std::numeric_limits<double>::min(); }

// Numbers by formula, the same on every machine (<random>'s distributions need not be).
class Numbers {
public:
  double within(double a, double b) { return a + (b - a) * (static_cast<double>(bits_() >> 11) * 0x1p-53); }
  double positive(int low, int high) { // 2^low … 2^high, even in the exponent
    return std::ldexp(within(1.0, 2.0), low + static_cast<int>(bits_() % static_cast<unsigned>(high - low)));
  }
  double any(int low, int high) { return (bits_() & 1 ? 1.0 : -1.0) * positive(low, high); }
  std::uint64_t integer(std::uint64_t below) { return bits_() % below; }

private:
  std::mt19937_64 bits_{7};
};

struct Worst {
  double error = 0.0, x = 0.0, y = 0.0;
  void add(double e, double at_x, double at_y = 0.0) {
    if (!(e <= error)) *this = {e, at_x, at_y};
  }
};
void check(const Worst& worst, double limit) {
  CAPTURE(worst.x);
  CAPTURE(worst.y);
  CHECK(worst.error < limit);
}

template <class Next> void check_sines(Next next) {
  Worst sine, cosine;
  for (int i = 0; i < k_count; ++i) {
    const double x = next();
    const auto [s, c] = portable::sin_cos(x);
    sine.add(error_of(s, sinq(x)), x);
    cosine.add(error_of(c, cosq(x)), x);
  }
  check(sine, 0.8);
  check(cosine, 0.8);
}

template <class Next> void check_powers(Next next) {
  Worst normal, subnormal;
  for (int i = 0; i < k_count; ++i) {
    const auto [x, y] = next();
    const Exact exact = powq(x, y);
    (is_subnormal(exact) ? subnormal : normal).add(error_of(portable::pow(x, y), exact), x, y);
  }
  check(normal, 0.6);
  check(subnormal, 0.8);
}

struct Two {
  double x, y;
};

bool same(double a, double b) { return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b)); }

} // namespace

TEST_CASE("sines and cosines of angles small and large") {
  Numbers n;
  check_sines([&] { return n.within(-0.79, 0.79); });
  check_sines([&] { return n.within(-7.0, 7.0); });
  check_sines([&] { return n.any(-40, 3); });
  check_sines([&] { return n.within(-1.1e6, 1.1e6); }); // both ways of reducing
  check_sines([&] { return n.any(-1074, 1024); });
}

TEST_CASE("sines and cosines next to multiples of a quarter turn, where all but the last digits cancel") {
  Numbers n;
  check_sines([&] {
    const auto multiple = static_cast<double>(n.integer(std::uint64_t{1} << (1 + n.integer(52))));
    const auto x = static_cast<double>(multiple * 2 * atanq(1));
    return n.integer(2) ? x : std::nextafter(x, k_infinity);
  });
  // Of all doubles the one nearest to a multiple of π/2 (J.-M. Muller, Elementary Functions, ch. 11).
  const double nearest = std::ldexp(6381956970095103.0, 797);
  check_sines([&] { return nearest; });
}

TEST_CASE("sines and cosines of what is no ordinary number") {
  for (const double x : {0.0, -0.0, 5e-324, -5e-324, 1e-300}) {
    CHECK(same(portable::sin(x), x));
    CHECK(portable::cos(x) == 1.0);
  }
  for (const double x : {k_infinity, -k_infinity, k_nan}) {
    CHECK(std::isnan(portable::sin(x)));
    CHECK(std::isnan(portable::cos(x)));
  }
}

TEST_CASE("sine is odd and cosine even, to the bit") {
  Numbers n;
  for (int i = 0; i < k_count; ++i) {
    const double x = n.positive(-1074, 1024);
    CHECK(portable::sin(-x) == -portable::sin(x));
    CHECK(portable::cos(-x) == portable::cos(x));
  }
}

TEST_CASE("the angle of a point in all quadrants, at all distances") {
  Numbers n;
  Worst ordinary, everywhere;
  for (int i = 0; i < k_count; ++i) {
    const double x = n.any(-8, 8), y = n.any(-8, 8), far = n.any(-1000, 960), beside = far * n.any(-60, 60);
    ordinary.add(error_of(portable::atan2(y, x), atan2q(y, x)), x, y);
    everywhere.add(error_of(portable::atan2(far, beside), atan2q(far, beside)), beside, far);
    everywhere.add(error_of(portable::atan2(x, far), atan2q(x, far)), far, x);
  }
  check(ordinary, 0.6);
  check(everywhere, 0.6);
}

TEST_CASE("the angle of points on the axes, in the middle between them, at infinity") {
  constexpr double special[] = {0.0, 5e-324, 1e-310, 1.0, 1.7e308, k_infinity, k_nan};
  for (const double a : special)
    for (const double b : special)
      for (const double x : {a, -a})
        for (const double y : {b, -b}) {
          CAPTURE(x);
          CAPTURE(y);
          CHECK(same(portable::atan2(y, x), static_cast<double>(atan2q(y, x))));
        }
}

TEST_CASE("the distance of a point") {
  Numbers n;
  Worst worst, tiny;
  for (int i = 0; i < k_count; ++i) {
    const double x = n.any(-1074, 1023), y = n.integer(2) ? x * n.any(-60, 60) : n.any(-1074, 1023);
    const Exact exact = hypotq(x, y);
    (is_subnormal(exact) ? tiny : worst).add(error_of(portable::hypot(x, y), exact), x, y);
  }
  check(worst, 0.6);
  check(tiny, 0.8);
  for (double scale : {1.0, 0x1p-1074, 0x1p-600, 0x1p600, 0x1p1010}) {
    CHECK(portable::hypot(3 * scale, -4 * scale) == 5 * scale);
    CHECK(portable::hypot(-20 * scale, 21 * scale) == 29 * scale);
  }
  CHECK(portable::hypot(0.0, -0.0) == 0.0);
  CHECK(portable::hypot(k_nan, -k_infinity) == k_infinity);
  CHECK(portable::hypot(k_infinity, 1.0) == k_infinity);
  CHECK(std::isnan(portable::hypot(k_nan, 1.0)));
  CHECK(portable::hypot(1.7e308, 1.7e308) == k_infinity);
}

TEST_CASE("powers: contacts', step size controllers', and all there are") {
  Numbers n;
  check_powers([&] { return Two{n.positive(-60, 3), 1.5}; });
  check_powers([&] { return Two{n.positive(-40, 40), n.within(-1.0, 1.0)}; });
  check_powers([&] { return Two{n.positive(-1074, 1024), n.any(-10, 10)}; });
  // Results over the whole range of doubles: here an error of the logarithm counts most.
  const auto to_reach = [&n](double x) { return Two{x, n.within(-744.0, 709.7) / std::log(x)}; };
  check_powers([&] { return to_reach(n.positive(-1074, 1024)); });
  check_powers([&] { return to_reach(n.within(0.5, 2.0)); });
  check_powers([&] { return to_reach(1.0 + n.any(-52, -2)); });
}

TEST_CASE("powers that are doubles are exact") {
  Numbers n;
  for (int i = 0; i < 2000; ++i) {
    const auto root = static_cast<double>(n.integer(100000)) + 1.0;
    CHECK(portable::pow(root, 2.0) == root * root);
    CHECK(portable::pow(-root, 3.0) == -root * root * root);
    CHECK(portable::pow(root * root, 1.5) == root * root * root);
    const double x = n.any(-1074, 1024);
    CHECK(portable::pow(x, 1.0) == x);
    CHECK(portable::pow(x, 0.0) == 1.0);
  }
  for (int e = -1074; e < 1024; ++e) CHECK(portable::pow(2.0, e) == std::ldexp(1.0, e));
  for (int e = 0; e <= 22; ++e) CHECK(portable::pow(10.0, e) == std::stod("1e" + std::to_string(e)));
}

TEST_CASE("powers grow with their base and exponent") {
  Numbers n;
  for (int i = 0; i < k_count; ++i) {
    const double x = n.within(1e-6, 1e-2), exponent = n.within(1.0, 3.0);
    CHECK(portable::pow(std::nextafter(x, 1.0), exponent) >= portable::pow(x, exponent));
    CHECK(portable::pow(x, std::nextafter(exponent, 9.0)) <= portable::pow(x, exponent));
  }
}

TEST_CASE("powers of and to what is no ordinary number") {
  constexpr double special[] = {0.0, 5e-324, 0.5, 1.0, 2.0, 2.5, 3.0, 0x1p53, 1e300, k_infinity, k_nan};
  for (const double a : special)
    for (const double b : special)
      for (const double x : {a, -a})
        for (const double y : {b, -b}) {
          CAPTURE(x);
          CAPTURE(y);
          CHECK(same(portable::pow(x, y), std::pow(x, y)));
        }
}

TEST_CASE("decimal logarithms") {
  Numbers n;
  Worst all, near_one;
  for (int i = 0; i < k_count; ++i) {
    const double x = n.positive(-1074, 1024), y = 1.0 + n.any(-52, -1);
    all.add(error_of(portable::log10(x), log10q(x)), x);
    near_one.add(error_of(portable::log10(y), log10q(y)), y);
  }
  check(all, 0.6);
  check(near_one, 0.6);
  for (int e = 0; e <= 22; ++e) CHECK(portable::log10(std::stod("1e" + std::to_string(e))) == e);
  CHECK(portable::log10(0.0) == -k_infinity);
  CHECK(portable::log10(k_infinity) == k_infinity);
  CHECK(std::isnan(portable::log10(-1.0)));
  CHECK(std::isnan(portable::log10(k_nan)));
}
