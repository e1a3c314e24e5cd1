// Small independent integrations for models that other programs test with: equations of motion in minimal
// coordinates, Runge and Kutta's method of order four at fixed small steps. Nothing here uses the library.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace steplap::testing {

template <std::size_t n> using Unknowns = std::array<double, n>;

template <std::size_t n> Unknowns<n> plus(Unknowns<n> y, double factor, const Unknowns<n>& rate) {
  for (std::size_t i = 0; i < n; ++i) y[i] += factor * rate[i];
  return y;
}

/// One step; `rate(t, y)` gives the derivative.
template <std::size_t n, class Rate> Unknowns<n> rk4_step(const Rate& rate, double t, const Unknowns<n>& y, double h) {
  const Unknowns<n> a = rate(t, y), b = rate(t + 0.5 * h, plus(y, 0.5 * h, a)), c = rate(t + 0.5 * h, plus(y, 0.5 * h, b)),
                    d = rate(t + h, plus(y, h, c));
  Unknowns<n> next = y;
  for (std::size_t i = 0; i < n; ++i) next[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  return next;
}

template <std::size_t n, class Rate> Unknowns<n> integrate(const Rate& rate, Unknowns<n> y, double end, int steps) {
  const double h = end / steps;
  for (int i = 0; i < steps; ++i) y = rk4_step<n>(rate, i * h, y, h);
  return y;
}

/// Piecewise smooth motion: `mode(y)` numbers the branch, `rate(mode, y)` is smooth within one. A step in which
/// the mode changes is cut by bisection at the change, and the branch beyond holds from there.
template <std::size_t n, class Mode, class Rate>
Unknowns<n> integrate_piecewise(const Mode& mode, const Rate& rate, Unknowns<n> y, double end, int steps) {
  int now = mode(y);
  double t = 0.0;
  const auto step = [&](double h) { return rk4_step<n>([&](double, const Unknowns<n>& x) { return rate(now, x); }, t, y, h); };
  while (t < end) {
    const double h = std::min(end / steps, end - t);
    Unknowns<n> next = step(h);
    if (mode(next) == now) {
      y = next;
      t = h < end / steps ? end : t + h;
      continue;
    }
    double before = 0.0, after = h;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (before + after);
      (mode(step(middle)) == now ? before : after) = middle;
    }
    next = step(after);
    t += after;
    now = mode(next);
    y = next;
  }
  return y;
}

/// A function of one coordinate with its first two derivatives.
struct Jet2 {
  double v = 0.0, d = 0.0, dd = 0.0;
};
inline Jet2 operator+(Jet2 a, Jet2 b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
inline Jet2 operator*(double f, Jet2 a) { return {f * a.v, f * a.d, f * a.dd}; }
inline Jet2 operator-(Jet2 a, Jet2 b) { return a + -1.0 * b; }
inline Jet2 operator*(Jet2 a, Jet2 b) { return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2.0 * a.d * b.d + a.v * b.dd}; }
inline Jet2 of(Jet2 a, double f, double f1, double f2) { return {f, f1 * a.d, f2 * a.d * a.d + f1 * a.dd}; }
inline Jet2 sqrt(Jet2 a) {
  const double r = std::sqrt(a.v);
  return of(a, r, 0.5 / r, -0.25 / (a.v * r));
}
inline Jet2 inverse(Jet2 a) { return of(a, 1.0 / a.v, -1.0 / (a.v * a.v), 2.0 / (a.v * a.v * a.v)); }

struct PathPoint {
  Jet2 x, y;
};
inline PathPoint operator+(PathPoint a, PathPoint b) { return {a.x + b.x, a.y + b.y}; }
inline PathPoint operator-(PathPoint a, PathPoint b) { return {a.x - b.x, a.y - b.y}; }
inline PathPoint operator*(double f, PathPoint a) { return {f * a.x, f * a.y}; }
inline PathPoint operator*(Jet2 f, PathPoint a) { return {f * a.x, f * a.y}; }
inline Jet2 dot(PathPoint a, PathPoint b) { return a.x * b.x + a.y * b.y; }
inline PathPoint left_of(PathPoint a) { return {-1.0 * a.y, a.x}; }
inline PathPoint fixed(double x, double y) { return {{x}, {y}}; }
/// Unit vector at the angle q, the coordinate itself.
inline PathPoint direction(double q) {
  const double c = std::cos(q), s = std::sin(q);
  return {{c, -s, -c}, {s, c, -s}};
}
inline PathPoint unit(PathPoint a) { return inverse(sqrt(dot(a, a))) * a; }

/// What carries kinetic energy w|p'|²q̇²/2: a mass at its place (gravity acts on it), or, as |e'| = |θ'| of a
/// unit vector e, an inertia at a direction fixed in its body (gravity does not).
struct Weight {
  double weight;
  PathPoint at;
  bool heavy;
};

struct OneFreedom {
  std::function<std::vector<Weight>(double)> weights;
  double gravity_x = 0.0, gravity_y = -9.81;
  std::function<double(double)> damping = [](double) { return 0.0; }; ///< generalised force over −q̇
};

/// Lagrange's equation of one degree of freedom: I q̈ + I'q̇²/2 = Σ m g·p' − d q̇ with I = Σ w |p'|².
inline Unknowns<2> rate_of(const OneFreedom& m, const Unknowns<2>& y) {
  double inertia = 0.0, half_slope = 0.0, force = -m.damping(y[0]) * y[1];
  for (const Weight& w : m.weights(y[0])) {
    inertia += w.weight * (w.at.x.d * w.at.x.d + w.at.y.d * w.at.y.d);
    half_slope += w.weight * (w.at.x.d * w.at.x.dd + w.at.y.d * w.at.y.dd);
    if (w.heavy) force += w.weight * (m.gravity_x * w.at.x.d + m.gravity_y * w.at.y.d);
  }
  return {y[1], (force - half_slope * y[1] * y[1]) / inertia};
}

inline double integrate(const OneFreedom& m, double q, double rate, double end, int steps) {
  return integrate<2>([&m](double, const Unknowns<2>& y) { return rate_of(m, y); }, {q, rate}, end, steps)[0];
}

/// Where a rod of length `a` from A and one of length `b` from B meet, on the left (1) or right (−1) of AB.
inline PathPoint meeting(PathPoint from, double a, PathPoint to, double b, double side) {
  const PathPoint chord = to - from;
  const Jet2 square = dot(chord, chord);
  const Jet2 along = 0.5 * (Jet2{1.0} + (a * a - b * b) * inverse(square));
  const Jet2 across = sqrt(a * a * inverse(square) - along * along);
  return from + along * chord + side * (across * left_of(chord));
}

} // namespace steplap::testing
