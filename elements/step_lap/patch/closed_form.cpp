#include "elements/step_lap/patch/closed_form.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace steplap {

namespace {

/// An edge relative to c: distance of its line, abscissae of its ends from the foot of the perpendicular, their distances, and the
/// differences that the antiderivatives need.
struct EdgeView {
  double d, s1, s2, rho1, rho2;
  double log_term; ///< Λ = ∫ ds/ρ
  double d_rho;    ///< ρ₂ − ρ₁
};

/// Returns 2 atanh(x) = 2x (1 + x²/3 + x⁴/5 …) for |x| ≤ (√2−1)/(√2+1) = 0.1716. Terms are summed in pairs to shorten the dependency chain.
/// The first omitted term is x²⁰/21 < 3e-17 relative.
constexpr double k_series_limit = 0.1715;
double twice_atanh(double x) {
  const double y = x * x, y2 = y * y, y4 = y2 * y2;
  const double low = (1 + y * (1.0 / 3)) + y2 * (1.0 / 5 + y * (1.0 / 7));
  const double high = (1.0 / 9 + y * (1.0 / 11)) + y2 * (1.0 / 13 + y * (1.0 / 15));
  return 2 * x * (low + y4 * (high + y4 * (1.0 / 17 + y * (1.0 / 19))));
}

/// A positive normal number as 2^exponent × mantissa, mantissa in [1, 2).
struct Binary {
  std::int64_t exponent;
  double mantissa;
  explicit Binary(double value) {
    const auto bits = std::bit_cast<std::int64_t>(value);
    exponent = bits >> 52;
    mantissa = std::bit_cast<double>((bits & 0xfffffffffffff) | 0x3ff0000000000000);
  }
};

/// Returns log(above/below) with one division and no call, bit-identical on every machine: powers of two are separated, the rest is
/// log(a/b) = 2 atanh((a−b)/(a+b)), where a − b is exact.
double log_ratio(double above, double below) {
  const Binary a(above), b(below);
  const bool large = a.mantissa > std::numbers::sqrt2 * b.mantissa;
  const bool small = b.mantissa > std::numbers::sqrt2 * a.mantissa;
  const double ma = a.mantissa * (small ? 2.0 : 1.0), mb = b.mantissa * (large ? 2.0 : 1.0);
  const auto twos = static_cast<double>(a.exponent - b.exponent + large - small);
  return twos * std::numbers::ln2 + twice_atanh((ma - mb) / (ma + mb));
}

/// Returns Λ without subtracting nearly equal numbers, for any position of the ends relative to the foot: asinh(s/|d|) = ±log((|s| +
/// ρ)/|d|).
double log_term(const EdgeView& e) {
  const double p1 = std::abs(e.s1) + e.rho1, p2 = std::abs(e.s2) + e.rho2;
  const bool foot_between = e.s1 < 0 && e.s2 > 0;
  const double above = foot_between ? p1 * p2 : (e.s1 >= 0 ? p2 : p1);
  const double below = foot_between ? e.d * e.d : (e.s1 >= 0 ? p1 : p2);
  return log_ratio(above, below);
}

void complete(EdgeView& e, double length) {
  const double sum = e.rho1 + e.rho2;
  const double x = length / sum;
  e.d_rho = x * (e.s1 + e.s2);
  e.log_term = x < k_series_limit ? twice_atanh(x) : log_term(e);
}

/// Components of ∬(I−uuᵀ)/|r| in the axes of the edge (m, t).
struct EdgeCurvature {
  double mm, mt, tt;
};

void add_turned(CentreIntegrals& out, const Vec2& t, const EdgeCurvature& k) {
  const double mx = t.y(), my = -t.x(), tx = t.x(), ty = t.y();
  out.xx += k.mm * mx * mx + 2 * k.mt * mx * tx + k.tt * tx * tx;
  out.yy += k.mm * my * my + 2 * k.mt * my * ty + k.tt * ty * ty;
  out.xy += k.mm * mx * my + k.mt * (mx * ty + my * tx) + k.tt * tx * ty;
}

/// Adds the uniform part of the traction: w × integrals of degree 1, 0, −1.
template <bool WithCurvature> void add_uniform(CentreIntegrals& out, const EdgeView& e, const Vec2& t, double length, double w) {
  const double d = e.d, wd = w * d, s = e.s1 + e.s2;
  const double s_rho = 0.5 * (e.d_rho * s + length * (e.rho1 + e.rho2)); // s₂ρ₂ − s₁ρ₁
  out.distance += wd * (1.0 / 6) * (s_rho + d * d * e.log_term);
  const double along = 0.5 * wd * e.d_rho, outward = 0.5 * wd * d * e.log_term;
  out.direction.x() += along * t.x() + outward * t.y();
  out.direction.y() += along * t.y() - outward * t.x();
  if constexpr (WithCurvature) {
    const double both = 1 / (e.rho1 * e.rho2);
    const double q = (e.s2 * e.rho1 - e.s1 * e.rho2) * both; // Δ(s/ρ)
    const double i = -e.d_rho * both;                        // Δ(1/ρ)
    add_turned(out, t, {wd * (e.log_term - q), wd * d * i, wd * q});
  }
}

/// Adds the part of the traction proportional to β·r, with r from c: degrees 2, 1, 0.
template <bool WithCurvature> void add_linear(CentreIntegrals& out, const EdgeView& e, const Vec2& t, double length, const Vec2& beta) {
  const double d = e.d;
  const double bm = d * (beta.x() * t.y() - beta.y() * t.x()), bt = beta.dot(t);
  const double s_rho = 0.5 * (e.d_rho * (e.s1 + e.s2) + length * (e.rho1 + e.rho2));
  const double rho = 0.5 * (s_rho + d * d * e.log_term);                                    // ∫ρ ds
  const double s2_over = 0.5 * (s_rho - d * d * e.log_term);                                // ∫s²/ρ ds
  const double rho_s = e.d_rho * (e.rho1 * e.rho1 + e.rho1 * e.rho2 + e.rho2 * e.rho2) / 3; // ∫sρ ds
  out.distance += 0.25 * d * (bm * rho + bt * rho_s);
  const double outward = d / 3 * d * (bm * e.log_term + bt * e.d_rho);
  const double along = d / 3 * (bm * e.d_rho + bt * s2_over);
  out.direction.x() += along * t.x() + outward * t.y();
  out.direction.y() += along * t.y() - outward * t.x();
  if constexpr (WithCurvature) {
    const double q = e.s2 / e.rho2 - e.s1 / e.rho1;
    const double i = -e.d_rho / (e.rho1 * e.rho2);
    const double k0 = q, k1 = -d * d * i, k2 = e.log_term - q, k3 = e.d_rho + d * d * i;
    add_turned(out, t, {0.5 * d * (bm * k2 + bt * k3), -0.5 * d * (bm * k1 / d + bt * d * k2), 0.5 * d * (bm * k0 + bt * k1)});
  }
}

} // namespace

template <bool WithCurvature>
CentreIntegrals integrate_about(const PatchEdge* edges, std::size_t count, const Traction& traction, const Vec2& c) {
  // Edges whose line passes c within this distance are skipped: their contribution is below the range of a double.
  constexpr double no_foot = 1e-140;
  CentreIntegrals out;
  const double w = traction.at_centroid + traction.gradient.dot(c); // traction at c
  const bool uniform = traction.gradient.isZero(0);
  double rho = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const PatchEdge& edge = edges[k];
    const double ax = edge.start.x() - c.x(), ay = edge.start.y() - c.y();
    EdgeView e{};
    e.s1 = ax * edge.along.x() + ay * edge.along.y();
    e.d = ax * edge.along.y() - ay * edge.along.x();
    e.s2 = e.s1 + edge.length;
    e.rho1 = edge.opens_ring ? std::sqrt(e.d * e.d + e.s1 * e.s1) : rho;
    e.rho2 = rho = std::sqrt(e.d * e.d + e.s2 * e.s2);
    if (std::abs(e.d) < no_foot) continue;
    complete(e, edge.length);
    add_uniform<WithCurvature>(out, e, edge.along, edge.length, w);
    if (!uniform) add_linear<WithCurvature>(out, e, edge.along, edge.length, traction.gradient);
  }
  return out;
}

template CentreIntegrals integrate_about<false>(const PatchEdge*, std::size_t, const Traction&, const Vec2&);
template CentreIntegrals integrate_about<true>(const PatchEdge*, std::size_t, const Traction&, const Vec2&);

} // namespace steplap
