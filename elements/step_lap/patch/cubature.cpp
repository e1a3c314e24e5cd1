#include "elements/step_lap/patch/cubature.h"

#include "elements/step_lap/patch/gauss_rule.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

using Two = Eigen::Array2d; // values at two nodes

constexpr int k_most = 10; // largest number of nodes along a side, needed at k_far_ratio radii

/// Nodes in pairs; an odd number is completed by a node with zero weight.
struct PairedRule {
  int count = 0;
  std::array<double, k_most> x{}, w{};
  std::array<Two, k_most / 2> pair_x, pair_w;
};

const std::array<PairedRule, k_most + 1>& rules() {
  static const auto all = [] {
    std::array<PairedRule, k_most + 1> rule;
    for (int n = 1; n <= k_most; ++n) {
      PairedRule& r = rule[n];
      r.count = n;
      gauss_rule(n, r.x.data(), r.w.data());
      for (int i = 0; i < n; i += 2) {
        const bool is_alone = i + 1 == n;
        r.pair_x[i / 2] = {r.x[i], r.x[is_alone ? i : i + 1]};
        r.pair_w[i / 2] = {r.w[i], is_alone ? 0.0 : r.w[i + 1]};
      }
    }
    return rule;
  }();
  return all;
}

/// Returns the smallest n with x^(2n−3−more)/4ⁿ below 2^-57.
int nodes_at(double x, int more) {
  constexpr int bits = 57;
  if (x < 0x1p-57) return 2 + more;
  const int k = quarter_exponent(x);
  const int twice = 4 * bits + (3 + more) * k;
  const int n = (twice + 2 * (k + 4) - 1) / (2 * (k + 4));
  return std::clamp(n, 2 + more, k_most);
}

#if defined(__x86_64__)
const bool has_three_operands = __builtin_cpu_supports("avx") != 0;
#endif

double spin(double a_x, double a_y, double b_x, double b_y) { return a_x * b_y - a_y * b_x; }

/// Sums integrals over quadrilaterals for one twist about the piece's centroid.
template <bool WithCurvature> class Integral {
public:
  Integral(const Traction& traction, double radius, const Vec2& v, double omega)
      : traction_(traction), v_(v), omega_(omega),
        by_half_length_(std::abs(omega) / (std::sqrt(v.squaredNorm()) - std::abs(omega) * radius)),
        more_(traction.gradient.isZero(0) ? 0 : 1) {}

  /// Adds a ring of `count` corners; corner(i) is relative to the centre.
  template <class Corner> void add_ring(std::size_t count, Corner corner) {
    const Vec2 first = corner(0);
    for (std::size_t i = 1; i + 1 < count; i += 2) add(first, corner(i), corner(i + 1), corner(std::min(i + 2, count - 1)));
  }

  [[nodiscard]] PieceDissipation sum() {
    out_.value = out_.fx * v_.x() + out_.fy * v_.y() + out_.m * omega_;
    return out_;
  }

private:
  void add(const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3) {
#if defined(__x86_64__)
    if (has_three_operands) return more_ == 0 ? add_by_three_operands<true>(p0, p1, p2, p3) : add_by_three_operands<false>(p0, p1, p2, p3);
#endif
    more_ == 0 ? add_quadrilateral<true>(p0, p1, p2, p3) : add_quadrilateral<false>(p0, p1, p2, p3);
  }

#if defined(__x86_64__)
  // add() compiled for AVX, whose three-operand instructions save copies; results are bit-identical.
  template <bool IsUniform>
  [[gnu::target("avx")]] void add_by_three_operands(const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3) {
    add_quadrilateral<IsUniform>(p0, p1, p2, p3);
  }
#endif

  template <bool IsUniform>
  [[gnu::always_inline]] inline void add_quadrilateral(const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3) {
    const Vec2 bottom = p1 - p0, top = p2 - p3;
    const PairedRule& along = rule_for(bottom, top);
    const PairedRule& across = rule_for(p3 - p0, p2 - p1);
    for (int i = 0; i < along.count; ++i) {
      const double s = along.x[i];
      const Vec2 p = p0 + s * bottom, d = (p3 + s * top) - p;
      const double j0 = along.w[i] * cross(bottom, d), j1 = along.w[i] * cross(top, d) - j0;
      add_row<IsUniform>(p, d, j0, j1, across);
    }
  }

  [[gnu::always_inline]] inline const PairedRule& rule_for(const Vec2& one, const Vec2& other) const {
    const double length = std::sqrt(std::max(one.squaredNorm(), other.squaredNorm()));
    return rules()[static_cast<std::size_t>(nodes_at(0.5 * length * by_half_length_, more_))];
  }

  /// Adds a row of nodes r = p + t d with Jacobian j0 + t j1. A uniform traction is not summed, so that it enters exactly.
  template <bool IsUniform>
  [[gnu::always_inline]] inline void add_row(const Vec2& p, const Vec2& d, double j0, double j1, const PairedRule& rule) {
    const double ax = v_.x() - omega_ * p.y(), ay = v_.y() + omega_ * p.x();
    const double bx = -omega_ * d.y(), by = omega_ * d.x();
    const double w0 = traction_.at_centroid + (IsUniform ? 0.0 : traction_.gradient.dot(p)),
                 w1 = IsUniform ? 0.0 : traction_.gradient.dot(d);
    Two s0 = Two::Zero(), s1 = s0, s2 = s0, c0 = s0, c1 = s0, c2 = s0;
    for (int i = 0; 2 * i < rule.count; ++i) {
      const Two t = rule.pair_x[i];
      const Two x = ax + t * bx, y = ay + t * by;
      const Two square = x * x + y * y;
      Two traction = Two::Constant(w0);
      if constexpr (!IsUniform) traction += t * w1;
      const Two share = rule.pair_w[i] * (j0 + t * j1) * traction / square.sqrt();
      const Two st = share * t;
      s0 += share;
      s1 += st;
      s2 += st * t;
      if constexpr (WithCurvature) {
        const Two bend = share / square, bt = bend * t;
        c0 += bend;
        c1 += bt;
        c2 += bt * t;
      }
    }
    const double m0 = s0[0] + s0[1], m1 = s1[0] + s1[1], m2 = s2[0] + s2[1];
    const double fx = ax * m0 + bx * m1, fy = ay * m0 + by * m1;
    out_.fx += fx;
    out_.fy += fy;
    out_.m += spin(p.x(), p.y(), fx, fy) + spin(d.x(), d.y(), ax * m1 + bx * m2, ay * m1 + by * m2);
    if constexpr (WithCurvature) add_curvature({ax, ay}, {bx, by}, p.dot(v_), d.dot(v_), c0.sum(), c1.sum(), c2.sum());
  }

  // Adds e⊥e⊥ᵀ/|V| with e⊥ = ẑ×V/|V|, and for ω e⊥·(ẑ×r) = r·v/|V|. V = a + t b, r·v = r0 + t r1.
  void add_curvature(const Vec2& a, const Vec2& b, double r0, double r1, double c0, double c1, double c2) {
    const double x0 = a.x() * c0 + b.x() * c1, x1 = a.x() * c1 + b.x() * c2; // sums over nodes of V_x and V_x t
    const double y0 = a.y() * c0 + b.y() * c1, y1 = a.y() * c1 + b.y() * c2;
    out_.xx += a.y() * y0 + b.y() * y1;
    out_.xy -= a.x() * y0 + b.x() * y1;
    out_.yy += a.x() * x0 + b.x() * x1;
    out_.xw -= r0 * y0 + r1 * y1;
    out_.yw += r0 * x0 + r1 * x1;
    out_.ww += r0 * (r0 * c0 + r1 * c1) + r1 * (r0 * c1 + r1 * c2);
  }

  Traction traction_;
  Vec2 v_;
  double omega_;
  double by_half_length_; // x of a side divided by its half length
  int more_;
  PieceDissipation out_;
};

} // namespace

template <bool WithCurvature>
PieceDissipation integrate_far(const PatchEdge* edges, std::size_t count, const Traction& traction, double radius, const Vec2& v,
                               double omega) {
  Integral<WithCurvature> integral(traction, radius, v, omega);
  for (std::size_t first = 0, end = 0; first < count; first = end) {
    for (end = first + 1; end < count && !edges[end].opens_ring; ++end) {}
    integral.add_ring(end - first, [edges, first](std::size_t i) { return edges[first + i].start; });
  }
  return integral.sum();
}

PieceDissipation integrate_far(const Polygon& polygon, const Vec2& centre, const Traction& traction, double radius, const Vec2& v,
                               double omega) {
  Integral<false> integral(traction, radius, v, omega);
  const auto add = [&](const Ring& ring) { integral.add_ring(ring.size(), [&](std::size_t i) { return Vec2(ring[i] - centre); }); };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  return integral.sum();
}

template PieceDissipation integrate_far<false>(const PatchEdge*, std::size_t, const Traction&, double, const Vec2&, double);
template PieceDissipation integrate_far<true>(const PatchEdge*, std::size_t, const Traction&, double, const Vec2&, double);

} // namespace steplap
