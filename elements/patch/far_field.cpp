#include "elements/patch/far_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace steplap {

namespace {

// Exact for polynomials of degree 19: the moments of order 18 times a linear traction.
constexpr int k_nodes = 10;

struct GaussRule {
  std::array<double, k_nodes> x{}, w{}; // on [0, 1]
};

/// Nodes by Newton on the Legendre polynomial.
GaussRule gauss_rule() {
  GaussRule rule;
  for (int i = 0; i < k_nodes; ++i) {
    double z = std::cos(std::numbers::pi * (i + 0.75) / (k_nodes + 0.5)), slope = 1;
    for (int pass = 0; pass < 8; ++pass) {
      double p = 1, before = 0;
      for (int n = 1; n <= k_nodes; ++n)
        before = std::exchange(p, ((2 * n - 1) * z * p - (n - 1) * before) / n);
      slope = k_nodes * (z * p - before) / (z * z - 1);
      z -= p / slope;
    }
    rule.x[i] = 0.5 * (1 + z);
    rule.w[i] = 1 / ((1 - z * z) * slope * slope);
  }
  return rule;
}

/// binomial(1/2, j)
constexpr auto k_root = [] {
  std::array<double, FarField::k_order + 1> b{};
  b[0] = 1;
  for (int j = 1; j <= FarField::k_order; ++j)
    b[j] = b[j - 1] * (1.5 - j) / j;
  return b;
}();

/// Highest order that still matters at x = |κ|R ≤ 1/6: x^(n−2), the worst of g and its
/// derivatives, falls below 1e-17.
int needed_order(double x) {
  if (x < 1e-12)
    return 4;
  const int n = 3 + static_cast<int>(39.2 / -std::log(x)); // 39.2 > −ln 1e-17
  return std::min(n, FarField::k_order);
}

} // namespace

FarField::FarField(const PatchEdge* edges, std::size_t count, const Traction& traction,
                   double radius)
    : radius_(radius) {
  // Moments of degree n over the triangle (centroid, edge): 2·area/(n+2) ∫₀¹ on the edge.
  static const GaussRule rule = gauss_rule();
  for (std::size_t e = 0; e < count; ++e) {
    const PatchEdge& edge = edges[e];
    const double twice_area = cross(edge.start, edge.along) * edge.length;
    for (int i = 0; i < k_nodes; ++i) {
      const Vec2 r = edge.start + edge.along * (edge.length * rule.x[i]);
      const double w0 = rule.w[i] * twice_area * traction.at_centroid;
      const double w1 = rule.w[i] * twice_area * traction.gradient.dot(r);
      const double zx = r.x() / radius, zy = r.y() / radius, square = zx * zx + zy * zy;
      double px = 1, py = 0; // z^l
      for (int l = 0; l <= k_order; ++l) {
        double fx = px, fy = py;
        for (int k = 0; l + 2 * k <= k_order; ++k) {
          const int n = l + 2 * k;
          const double w = w0 / (n + 2) + w1 / (n + 3);
          a_[l * k_row + k] += std::complex<double>(w * fx, w * fy);
          fx *= square;
          fy *= square;
        }
        const double turned = px * zx - py * zy;
        py = px * zy + py * zx;
        px = turned;
      }
    }
  }
  std::complex<double> turn = 1; // i^l
  for (int l = 0; l <= k_order; ++l, turn *= std::complex<double>(0, 1))
    for (int k = 0; l + 2 * k <= k_order; ++k)
      a_[l * k_row + k] *= turn * ((l > 0 ? 2 : 1) * k_root[k + l] * k_root[k]);
}

template <bool WithCurvature>
PieceDissipation FarField::evaluate(const Vec2& v, double omega) const {
  const double speed = std::hypot(v.x(), v.y());
  const double cx = v.x() / speed, cy = v.y() / speed;
  const double kappa = omega * radius_ / speed;
  const int order = needed_order(std::abs(kappa));

  std::array<double, k_order + 1> power{}; // κⁿ
  power[0] = 1;
  for (int n = 1; n <= order; ++n)
    power[n] = power[n - 1] * kappa;

  double g = 0, g_k = 0, g_p = 0, g_kk = 0, g_kp = 0, g_pp = 0;
  double ex = 1, ey = 0; // e^{−ilφ}
  for (int l = 0; l <= order; ++l) {
    double r0x = 0, r0y = 0, r1x = 0, r1y = 0, r2x = 0, r2y = 0; // row and its κ-derivatives
    const std::complex<double>* a = &a_[l * k_row];
    for (int n = l; n <= order; n += 2, ++a) {
      const double re = a->real(), im = a->imag();
      r0x += power[n] * re;
      r0y += power[n] * im;
      if (n >= 1) {
        const double p = n * power[n - 1];
        r1x += p * re;
        r1y += p * im;
      }
      if constexpr (WithCurvature)
        if (n >= 2) {
          const double p = n * (n - 1) * power[n - 2];
          r2x += p * re;
          r2y += p * im;
        }
    }
    // Re(e·r) and, for d/dφ, Re(−il e·r) = l Im(e·r)
    const double im0 = ex * r0y + ey * r0x, re0 = ex * r0x - ey * r0y;
    g += re0;
    g_k += ex * r1x - ey * r1y;
    g_p += l * im0;
    if constexpr (WithCurvature) {
      g_kk += ex * r2x - ey * r2y;
      g_kp += l * (ex * r1y + ey * r1x);
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
