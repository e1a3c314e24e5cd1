#include "mbd/base/portable_math.h"

#include "mbd/base/double_double.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace steplap::portable {

namespace {

constexpr DoubleDouble k_pi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr DoubleDouble k_half_pi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

// atan(k/8), k = 0 … 8.
constexpr DoubleDouble k_arc[9] = {{0.0, 0.0},
                                   {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                   {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                   {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                   {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                   {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                   {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                   {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                   {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};

// Returns atan(a/b) for 2⁻¹⁰⁰ ≤ a ≤ b, b in [1, 4), as atan(k/8) + atan u with u = (8a − kb)/(8b + ka), |u| ≤ 1/15. The first omitted term
// of the series is u¹⁹/19.
DoubleDouble arc_of(double a, double b) {
  const double k = static_cast<double>(static_cast<int>(8.0 * a / b + 0.5));
  const DoubleDouble kb = two_product(k, b), ka = two_product(k, a);
  const DoubleDouble above = two_sum(8.0 * a, -kb.hi), below = two_sum(8.0 * b, ka.hi);
  const DoubleDouble u = DoubleDouble{above.hi, above.lo - kb.lo} / DoubleDouble{below.hi, below.lo + ka.lo};
  const double z = u.hi * u.hi, z2 = z * z;
  const double p = (-1.0 / 3 + z * (1.0 / 5)) +
                   z2 * ((-1.0 / 7 + z * (1.0 / 9)) + z2 * ((-1.0 / 11 + z * (1.0 / 13)) + z2 * (-1.0 / 15 + z * (1.0 / 17))));
  const DoubleDouble& at = k_arc[static_cast<int>(k)];
  const DoubleDouble sum = two_sum(at.hi, u.hi);
  return {sum.hi, sum.lo + (at.lo + (u.lo * (1.0 - z) + u.hi * z * p))};
}

double from(const DoubleDouble& c, double sign, const DoubleDouble& a) { // c ± a
  const DoubleDouble sum = two_sum(c.hi, sign * a.hi);
  return sum.hi + (sum.lo + (c.lo + sign * a.lo));
}

// Returns 2^−e for a normal x in [2^e, 2^(e+1)), limited to normal results.
double binary_scale(double x) {
  const auto e = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(x) >> 52);
  return std::bit_cast<double>(std::clamp<std::int64_t>(2046 - e, 1, 2046) << 52);
}

// Returns the angle of the point (x, y), given |x| and y, both positive and finite. `is_left`: x is negative, so the result is π minus the
// angle of (|x|, y).
double first_quadrant(double y, double x, bool is_left) {
  double large = std::max(x, y), small = std::min(x, y);
  if (large < 0x1p-1000) large *= 0x1p80, small *= 0x1p80;
  const double scale = binary_scale(large);
  large *= scale, small *= scale;
  if (small < 0x1p-100) { // the angle with the nearer axis is the quotient
    if (y < x && !is_left) return y / x;
    return y < x ? k_pi.hi : k_half_pi.hi;
  }
  const DoubleDouble arc = arc_of(small, large);
  if (y <= x) return is_left ? from(k_pi, -1.0, arc) : arc.hi + arc.lo;
  return from(k_half_pi, is_left ? 1.0 : -1.0, arc);
}

// Returns the angle of (x, y) if a coordinate is zero or infinite; arguments as for first_quadrant().
double along_axes(double y, double x, bool is_left) {
  if (std::isinf(x) && std::isinf(y)) return is_left ? 3.0 * (k_half_pi.hi / 2.0) : k_half_pi.hi / 2.0;
  if (y == 0.0 || std::isinf(x)) return is_left ? k_pi.hi : 0.0;
  return k_half_pi.hi;
}

} // namespace

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return x + y;
  const double ax = std::abs(x), ay = std::abs(y);
  const bool is_axis = ax == 0.0 || ay == 0.0 || std::isinf(x) || std::isinf(y);
  const double angle = is_axis ? along_axes(ay, ax, std::signbit(x)) : first_quadrant(ay, ax, std::signbit(x));
  return std::copysign(angle, y);
}

// Returns √s for s = x² + y², both in double-double arithmetic: the rounded root with one Newton correction.
double hypot(double x, double y) {
  if (std::isinf(x) || std::isinf(y)) return std::numeric_limits<double>::infinity();
  double large = std::abs(x), small = std::abs(y);
  if (!(large >= small)) std::swap(large, small);
  if (!(small > large * 0x1p-54)) return large + small;
  double scale = 1.0;
  if (large > 0x1p500) scale = 0x1p-600;
  if (small < 0x1p-400) scale = 0x1p600;
  large *= scale, small *= scale;
  const DoubleDouble a = two_product(large, large), b = two_product(small, small);
  const DoubleDouble square = quick_two_sum(a.hi, b.hi);
  const double root = std::sqrt(square.hi);
  const DoubleDouble back = two_product(root, root);
  return (root + ((square.hi - back.hi) - back.lo + (square.lo + (a.lo + b.lo))) / (2.0 * root)) / scale;
}

} // namespace steplap::portable
