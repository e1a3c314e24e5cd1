#include "elements/patch/far_field.h"

#include "elements/patch/gauss_rule.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Exact for polynomials of degree 19: the moments of order 18 times a linear traction.
constexpr int k_nodes = 10;

/// 1/n
constexpr auto k_inverse = [] {
  std::array<double, FarField::k_order + 4> inverse{};
  for (int n = 1; n < FarField::k_order + 4; ++n)
    inverse[n] = 1.0 / n;
  return inverse;
}();

struct EdgeRule {
  std::array<double, k_nodes> x{}, w{};
  EdgeRule() { gauss_rule(k_nodes, x.data(), w.data()); }
};

/// binomial(1/2, j)
constexpr auto k_root = [] {
  std::array<double, FarField::k_order + 1> b{};
  b[0] = 1;
  for (int j = 1; j <= FarField::k_order; ++j)
    b[j] = b[j - 1] * (1.5 - j) / j;
  return b;
}();

/// 1, κ, κ² … with first and second derivatives, each twice: what they multiply are pairs. Beyond `order` nothing.
template <bool WithCurvature> struct Powers {
  using Pair = Eigen::Array2d;
  std::array<Pair, FarField::k_order + 1> p, p1, p2;
  Powers(double kappa, int order) {
    p[0].setOnes();
    p1[0].setZero();
    p2[0].setZero();
    for (int n = 1; n <= order; ++n) {
      p[n] = p[n - 1] * kappa;
      p1[n] = n * p[n - 1];
      if constexpr (WithCurvature) p2[n] = n * p1[n - 1];
    }
  }
};

} // namespace

// x^(n−2), the worst of g and its derivatives, is to fall below 2^-57. From the binary exponent of
// x⁴: x < 2^(-k/4).
int FarField::needed_order(double x) {
  constexpr int bits = 57;
  if (x < 0x1p-57) return 3;
  const int k = -1 - std::ilogb(x * x * x * x);
  return std::min(2 + (4 * bits + k - 1) / k, k_order);
}

FarField::FarField(const PatchEdge* edges, std::size_t count, const Traction& traction, double radius)
    : FarField(radius) {
  add(edges, count, traction, Vec2::Zero());
  finish();
}

FarField::FarField(double radius) : radius_(radius) { a_.fill(Pair::Zero()); }

void FarField::add(const PatchEdge* edges, std::size_t count, const Traction& traction, const Vec2& shift) {
  const double at_centre = traction.at_centroid - traction.gradient.dot(shift);
  // Moments of degree n over the triangle (centre, edge): 2·area/(n+2) ∫₀¹ on the edge.
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
      Pair& a = a_[l * k_row + k];
      a *= (l > 0 ? 2 : 1) * k_root[k + l] * k_root[k];
      if (l % 4 >= 2) // iˡ
        a = -a;
      if (l % 2 == 1) a = Pair(-a[1], a[0]);
    }
}

void FarField::add_node(const Vec2& z, double uniform, double linear) {
  std::array<double, k_order + 1> weight{};
  std::array<double, k_row> square{};
  for (int n = 0; n <= k_order; ++n)
    weight[n] = uniform * k_inverse[n + 2] + linear * k_inverse[n + 3];
  square[0] = 1;
  for (int k = 1; k < k_row; ++k)
    square[k] = square[k - 1] * z.squaredNorm();
  Pair power(1, 0); // z^l
  for (int l = 0; l <= k_order; ++l) {
    Pair* row = &a_[l * k_row];
    for (int k = 0; l + 2 * k <= k_order; ++k)
      row[k] += weight[l + 2 * k] * square[k] * power;
    power = Pair(power[0] * z.x() - power[1] * z.y(), power[0] * z.y() + power[1] * z.x());
  }
}

template <bool WithCurvature>
PieceDissipation FarField::evaluate(const Vec2& v, double omega) const {
  const double speed = std::sqrt(v.x() * v.x() + v.y() * v.y());
  const double cx = v.x() / speed, cy = v.y() / speed;
  const double kappa = omega * radius_ / speed;
  const int order = needed_order(std::abs(kappa));

  const Powers<WithCurvature> power(kappa, order);

  double g = 0, g_k = 0, g_p = 0, g_kk = 0, g_kp = 0, g_pp = 0;
  double ex = 1, ey = 0; // e^{−ilφ}
  for (int l = 0; l <= order; ++l) {
    Pair r0 = Pair::Zero(), r1 = Pair::Zero(), r2 = Pair::Zero(); // row, its κ-derivatives
    const Pair* a = &a_[l * k_row];
    for (int n = l; n <= order; n += 2, ++a) {
      r0 += power.p[n] * *a;
      r1 += power.p1[n] * *a;
      if constexpr (WithCurvature) r2 += power.p2[n] * *a;
    }
    // Re(e·r) and, for d/dφ, Re(−il e·r) = l Im(e·r)
    const double im0 = ex * r0[1] + ey * r0[0], re0 = ex * r0[0] - ey * r0[1];
    g += re0;
    g_k += ex * r1[0] - ey * r1[1];
    g_p += l * im0;
    if constexpr (WithCurvature) {
      g_kk += ex * r2[0] - ey * r2[1];
      g_kp += l * (ex * r1[1] + ey * r1[0]);
      g_pp -= l * l * re0;
    }
    const double turned = ex * cx + ey * cy;
    ey = ey * cx - ex * cy;
    ex = turned;
  }

  // h = s g(ωR/s, φ): polar derivatives along v̂ (s), across it (φ/s) and in ω.
  PieceDissipation out;
  const double along = g - kappa * g_k;
  out.value = speed * g;
  out.fx = along * cx - g_p * cy;
  out.fy = along * cy + g_p * cx;
  out.m = radius_ * g_k;
  if constexpr (WithCurvature) {
    const double ss = kappa * kappa * g_kk / speed, sp = -kappa * g_kp / speed;
    const double pp = (g_pp + along) / speed;
    const double sw = -kappa * g_kk * radius_ / speed, pw = g_kp * radius_ / speed;
    out.xx = ss * cx * cx - 2 * sp * cx * cy + pp * cy * cy;
    out.yy = ss * cy * cy + 2 * sp * cx * cy + pp * cx * cx;
    out.xy = (ss - pp) * cx * cy + sp * (cx * cx - cy * cy);
    out.xw = sw * cx - pw * cy;
    out.yw = sw * cy + pw * cx;
    out.ww = g_kk * radius_ * radius_ / speed;
  }
  return out;
}

template PieceDissipation FarField::evaluate<false>(const Vec2&, double) const;
template PieceDissipation FarField::evaluate<true>(const Vec2&, double) const;

} // namespace steplap
