#include "elements/step_lap/patch/far_field.h"

#include "elements/step_lap/patch/gauss_rule.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace steplap {

namespace {

// Nodes along an edge: exact for polynomials of degree 19, the moments of order 18 times a linear traction.
constexpr int k_nodes = 10;

/// 1/n.
constexpr auto k_inverse = [] {
  std::array<double, FarField::k_order + 4> inverse{};
  for (int n = 1; n < FarField::k_order + 4; ++n) inverse[n] = 1.0 / n;
  return inverse;
}();

struct EdgeRule {
  std::array<double, k_nodes> x{}, w{};
  EdgeRule() { gauss_rule(k_nodes, x.data(), w.data()); }
};

/// binomial(1/2, j).
constexpr auto k_root = [] {
  std::array<double, FarField::k_order + 1> b{};
  b[0] = 1;
  for (int j = 1; j <= FarField::k_order; ++j) b[j] = b[j - 1] * (1.5 - j) / j;
  return b;
}();

/// Two complex numbers in one vector. Operations and their order are those of scalar doubles, whatever registers the processor has.
using Four [[gnu::vector_size(32)]] = double;
using Two [[gnu::vector_size(16)]] = double;

/// Powers 1, κ, κ² … with first and second derivatives, four copies each; zero beyond `order`.
template <bool WithCurvature> struct Powers {
  std::array<Four, FarField::k_order + 1> p, p1, p2;
  [[gnu::always_inline]] inline Powers(double kappa, int order) {
    p[0] = Four{1.0, 1.0, 1.0, 1.0};
    p1[0] = p2[0] = Four{};
    for (int n = 1; n <= order; ++n) {
      p[n] = p[n - 1] * kappa;
      p1[n] = double(n) * p[n - 1];
      if constexpr (WithCurvature) p2[n] = double(n) * p1[n - 1];
    }
  }
};

/// g with first and second derivatives with respect to κ and φ.
struct Polar {
  double g = 0, k = 0, p = 0, kk = 0, kp = 0, pp = 0;
};

/// Rows l and l + 2 of a_, with derivatives with respect to κ.
struct TwoRows {
  Four r0{}, r1{}, r2{};
};

template <bool WithCurvature>
[[gnu::always_inline]] inline TwoRows sum_rows(const double* a, const Powers<WithCurvature>& power, int l, int order) {
  TwoRows rows;
  for (int n = l; n <= order; n += 2, a += 4) {
    Four two;
    std::memcpy(&two, a, sizeof two);
    rows.r0 += power.p[n] * two;
    rows.r1 += power.p1[n] * two;
    if constexpr (WithCurvature) rows.r2 += power.p2[n] * two;
  }
  return rows;
}

/// e^{−ilφ} for l and l + 2, arranged for multiplication: x, x, … and −y, y, …
struct TwoTurns {
  Four x, y;
  [[gnu::always_inline]] inline TwoTurns(const Two& one, const Two& other)
      : x{one[0], one[0], other[0], other[0]}, y{-one[1], one[1], -other[1], other[1]} {}
};

// Passed by value, because data in memory would be cleared each time, which takes as long as all the sums.
template <bool WithCurvature> [[gnu::always_inline]] inline TwoRows turned(const TwoRows& rows, const TwoTurns& by) {
  TwoRows out{by.x * rows.r0 + by.y * __builtin_shufflevector(rows.r0, rows.r0, 1, 0, 3, 2),
              by.x * rows.r1 + by.y * __builtin_shufflevector(rows.r1, rows.r1, 1, 0, 3, 2), Four{}};
  if constexpr (WithCurvature) out.r2 = by.x * rows.r2 + by.y * __builtin_shufflevector(rows.r2, rows.r2, 1, 0, 3, 2);
  return out;
}

/// For each l the factors 1, l, l², l².
constexpr auto k_degrees = [] {
  std::array<std::array<double, 4>, FarField::k_order + 4> degrees{};
  for (int l = 0; l < FarField::k_order + 4; ++l) degrees[l] = {1.0, double(l), double(l * l), double(l * l)};
  return degrees;
}();

/// Sums over l of g and of its derivatives with respect to φ, Re(−il e·r) = l Im(e·r).
template <bool WithCurvature> class PolarSums {
public:
  /// Adds the row for l (Half = 0) or l + 2 (Half = 1).
  template <int Half> [[gnu::always_inline]] inline void add(const TwoRows& rows, int l) {
    Two by_l, by_square;
    std::memcpy(&by_l, k_degrees[l].data(), sizeof by_l);
    std::memcpy(&by_square, k_degrees[l].data() + 2, sizeof by_square);
    const Two r0 = half<Half>(rows.r0), r1 = half<Half>(rows.r1);
    value_ += by_l * r0;
    by_kappa_ += by_l * r1;
    if constexpr (WithCurvature) {
      twice_by_kappa_ += half<Half>(rows.r2);
      twice_by_phi_ -= by_square * r0;
    }
  }
  [[nodiscard]] Polar sum() const { return {value_[0], by_kappa_[0], value_[1], twice_by_kappa_[0], by_kappa_[1], twice_by_phi_[0]}; }

private:
  template <int Half> [[gnu::always_inline]] static inline Two half(const Four& four) { return Two{four[2 * Half], four[2 * Half + 1]}; }

  Two value_{}, by_kappa_{}, twice_by_kappa_{}, twice_by_phi_{};
};

/// Returns the sums. `row`: length of each pair of rows in a_.
template <bool WithCurvature>
[[gnu::always_inline]] inline Polar sum_polar(const double* a, int row, double kappa, int order, double cx, double cy) {
  const Powers<WithCurvature> power(kappa, order);
  PolarSums<WithCurvature> sums;
  const Two along{cx, cx}, across{cy, -cy};
  const auto next = [&](const Two& e) { return along * e + across * __builtin_shufflevector(e, e, 1, 0); };
  Two e0{1.0, 0.0}; // e^{−ilφ}
  for (int l = 0; l <= order; l += 4, a += 2 * row) {
    const Two e1 = next(e0), e2 = next(e1), e3 = next(e2);
    const TwoRows even = turned<WithCurvature>(sum_rows(a, power, l, order), {e0, e2}),
                  odd = turned<WithCurvature>(sum_rows(a + row, power, l + 1, order), {e1, e3});
    e0 = next(e3);
    sums.template add<0>(even, l);
    if (l + 1 > order) break;
    sums.template add<0>(odd, l + 1);
    if (l + 2 > order) break;
    sums.template add<1>(even, l + 2);
    if (l + 3 > order) break;
    sums.template add<1>(odd, l + 3);
  }
  return sums.sum();
}

/// Adds the moments of a node at z to a.
[[gnu::always_inline]] inline void add_moments(double* a, int row, const Vec2& z, double uniform, double linear) {
  constexpr int k_order = FarField::k_order, k_rows = k_order / 2 + 1;
  std::array<double, k_order + 1> weight;
  std::array<Four, k_rows> square;    // |z|^2k for row l, one power lower for l + 2, whose first entry is zero
  std::array<Two, k_order + 4> power; // z^l
  for (int n = 0; n <= k_order; ++n) weight[n] = uniform * k_inverse[n + 2] + linear * k_inverse[n + 3];
  const double norm = z.squaredNorm();
  double now = 1, before = 0;
  for (Four& s : square) {
    s = Four{now, now, before, before};
    before = now;
    now *= norm;
  }
  power[0] = Two{1, 0};
  const Two by_x{z.x(), z.x()}, by_y{-z.y(), z.y()};
  for (int l = 1; l < k_order + 4; ++l) power[l] = power[l - 1] * by_x + __builtin_shufflevector(power[l - 1], power[l - 1], 1, 0) * by_y;
  for (int first = 0; first <= k_order; first += 4)
    for (int l = first; l < first + 2 && l <= k_order; ++l, a += row) {
      const bool has_second = l + 2 <= k_order; // false: row l + 2 does not exist
      const Two second = has_second ? power[l + 2] : Two{};
      const Four both{power[l][0], power[l][1], second[0], second[1]};
      double* at = a;
      for (int n = l; n <= k_order; n += 2, at += 4) {
        Four moment;
        std::memcpy(&moment, at, sizeof moment);
        moment += weight[n] * square[(n - l) / 2] * both;
        std::memcpy(at, &moment, sizeof moment);
      }
    }
}

#if defined(__x86_64__)
[[gnu::target("avx")]] void add_moments_by_four(double* a, int row, const Vec2& z, double uniform, double linear) {
  add_moments(a, row, z, uniform, linear);
}
template <bool WithCurvature> // compiled for registers of four doubles: the same operations, bit-identical
[[gnu::target("avx")]] Polar sum_polar_by_four(const double* a, int row, double kappa, int order, double cx, double cy) {
  return sum_polar<WithCurvature>(a, row, kappa, order, cx, cy);
}
const bool has_four = __builtin_cpu_supports("avx") != 0;
#endif

template <bool WithCurvature> Polar polar_of(const double* a, int row, double kappa, int order, double cx, double cy) {
#if defined(__x86_64__)
  if (has_four) return sum_polar_by_four<WithCurvature>(a, row, kappa, order, cx, cy);
#endif
  return sum_polar<WithCurvature>(a, row, kappa, order, cx, cy);
}

} // namespace

// Returns the order n for which x^(n−2), the largest term of g and its derivatives, is below 2^-57.
int FarField::needed_order(double x) {
  constexpr int bits = 57;
  if (x < 0x1p-57) return 3;
  const int k = quarter_exponent(x);
  return k > 0 ? std::min(2 + (4 * bits + k - 1) / k, k_order) : k_order;
}

FarField::FarField(const PatchEdge* edges, std::size_t count, const Traction& traction, double radius) : FarField(radius) {
  add(edges, count, traction, Vec2::Zero());
  finish();
}

FarField::FarField(double radius) : radius_(radius) { a_.fill(0.0); }

void FarField::add(const PatchEdge* edges, std::size_t count, const Traction& traction, const Vec2& shift) {
  const double at_centre = traction.at_centroid - traction.gradient.dot(shift);
  // Moments of degree n over the triangle (centre, edge) are 2·area/(n+2) ∫₀¹ along the edge.
  static const EdgeRule rule;
  for (std::size_t e = 0; e < count; ++e) {
    const PatchEdge& edge = edges[e];
    const Vec2 start = edge.start + shift;
    const double twice_area = cross(start, edge.along) * edge.length;
    for (int i = 0; i < k_nodes; ++i) {
      const Vec2 r = start + edge.along * (edge.length * rule.x[i]);
      const double w = rule.w[i] * twice_area;
      add_node(r / radius_, w * at_centre, w * traction.gradient.dot(r));
    }
  }
}

void FarField::finish() {
  for (int l = 0; l <= k_order; ++l)
    for (int k = 0; l + 2 * k <= k_order; ++k) {
      double &re = a_[place(l, k)], &im = a_[place(l, k) + 1];
      const double factor = (l > 0 ? 2 : 1) * k_root[k + l] * k_root[k];
      re *= factor;
      im *= factor;
      if (l % 4 >= 2) // iˡ
        re = -re, im = -im;
      if (l % 2 == 1) re = std::exchange(im, re), re = -re;
    }
}

void FarField::add_node(const Vec2& z, double uniform, double linear) {
#if defined(__x86_64__)
  if (has_four) return add_moments_by_four(a_.data(), 4 * k_row, z, uniform, linear);
#endif
  add_moments(a_.data(), 4 * k_row, z, uniform, linear);
}

template <bool WithCurvature> PieceDissipation FarField::evaluate(const Vec2& v, double omega) const {
  const double speed = std::sqrt(v.x() * v.x() + v.y() * v.y());
  const double cx = v.x() / speed, cy = v.y() / speed;
  const double kappa = omega * radius_ / speed;
  const int order = needed_order(std::abs(kappa));

  const Polar sum = polar_of<WithCurvature>(a_.data(), 4 * k_row, kappa, order, cx, cy);

  // h = s g(ωR/s, φ): derivatives along v̂ (with respect to s), across v̂ (with respect to φ, divided by s), and with respect to ω.
  PieceDissipation out;
  const double along = sum.g - kappa * sum.k;
  out.value = speed * sum.g;
  out.fx = along * cx - sum.p * cy;
  out.fy = along * cy + sum.p * cx;
  out.m = radius_ * sum.k;
  if constexpr (WithCurvature) {
    const double ss = kappa * kappa * sum.kk / speed, sp = -kappa * sum.kp / speed;
    const double pp = (sum.pp + along) / speed;
    const double sw = -kappa * sum.kk * radius_ / speed, pw = sum.kp * radius_ / speed;
    out.xx = ss * cx * cx - 2 * sp * cx * cy + pp * cy * cy;
    out.yy = ss * cy * cy + 2 * sp * cx * cy + pp * cx * cx;
    out.xy = (ss - pp) * cx * cy + sp * (cx * cx - cy * cy);
    out.xw = sw * cx - pw * cy;
    out.yw = sw * cy + pw * cx;
    out.ww = sum.kk * radius_ * radius_ / speed;
  }
  return out;
}

template PieceDissipation FarField::evaluate<false>(const Vec2&, double) const;
template PieceDissipation FarField::evaluate<true>(const Vec2&, double) const;

} // namespace steplap
