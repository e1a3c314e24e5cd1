// Andrews' mechanism reduced to the crank angle β. The pose follows from three circle intersections. Their first and second derivatives
// with respect to β give the effective inertia m(β) and its slope: m β̈ = Q(β) − ½ m' β̇².

#include "andrews.h"
#include "dop853_run.h"

#include <cmath>
#include <numbers>

namespace steplap::peers {
namespace {

// A function of β with its value and first two derivatives.
struct Jet {
  double v, d, dd;
};
inline Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, a.d - b.d, a.dd - b.dd}; }
inline Jet operator*(double s, const Jet& a) { return {s * a.v, s * a.d, s * a.dd}; }
inline Jet operator*(const Jet& a, const Jet& b) { return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2.0 * a.d * b.d + a.v * b.dd}; }
inline Jet inverse(const Jet& a) {
  const double r = 1.0 / a.v;
  const double d = -a.d * r * r;
  return {r, d, -a.dd * r * r - 2.0 * d * a.d * r};
}
inline Jet root(const Jet& a) {
  const double r = std::sqrt(a.v);
  const double half = 0.5 / r;
  const double d = a.d * half;
  return {r, d, (a.dd - 2.0 * d * d) * half};
}

struct Point {
  Jet x, y;
};
inline Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y}; }
inline Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
inline Point operator*(double s, const Point& a) { return {s * a.x, s * a.y}; }
inline Point perp(const Point& a) { return {-1.0 * a.y, a.x}; }
inline Point fixed(double x, double y) { return {{x, 0, 0}, {y, 0, 0}}; }

// Returns the point at distance r from p and s from q, on the given side of the line from p to q.
inline Point intersect(const Point& p, double r, const Point& q, double s, double side) {
  const Point along = q - p;
  const Jet square = along.x * along.x + along.y * along.y;
  const Jet over = inverse(square);
  const Jet share = (r * r - s * s) * over;
  const Jet a = 0.5 * (Jet{1.0, 0.0, 0.0} + share);
  const Jet b = side * root(r * r * over - a * a);
  return {p.x + a * along.x - b * along.y, p.y + a * along.y + b * along.x};
}

struct Body {
  double mass, inertia, cx, cy;
};
constexpr Body k_crank = {0.04325, 2.194e-6, 0.00092, 0.0};
constexpr Body k_2 = {0.00365, 4.410e-7, -0.0115, 0.0};
constexpr Body k_3 = {0.02373, 5.255e-6, 0.01043, -0.01874};
constexpr Body k_4 = {0.00706, 5.667e-7, 0.0, -0.00579};
constexpr Body k_5 = {0.07050, 1.169e-5, 0.02308, 0.00916};
constexpr Body k_6 = {0.00706, 5.667e-7, 0.00579, 0.0};
constexpr Body k_7 = {0.05498, 1.912e-5, -0.00449, -0.01228};
constexpr double k_crank_arm = 0.007;
constexpr double k_torque = 0.033;
constexpr double k_stiffness = 4530.0, k_free_length = 0.07785;
constexpr double k_spring_x = 0.014, k_spring_y = 0.072;
constexpr double k_bx = -0.03635, k_by = 0.03273;
constexpr double k_ax = -0.06934, k_ay = -0.00227;

struct Pose {
  Point f, e, g, h;
  Point axis2, axis3, axis4, axis5, axis6, axis7; // unit vectors of the bodies' x axes
};

inline Pose pose_of(double beta) {
  const double c = k_crank_arm * std::cos(beta);
  const double s = k_crank_arm * std::sin(beta);
  Pose p;
  p.f = {{c, -s, -c}, {s, c, -s}};
  const Point a = fixed(k_ax, k_ay);
  const Point b = fixed(k_bx, k_by);
  p.e = intersect(p.f, 0.028, b, 0.035, 1.0);
  p.g = intersect(a, 0.04, p.e, 0.02, 1.0);
  p.h = intersect(a, 0.04, p.e, 0.02, -1.0);
  p.axis2 = (1.0 / 0.028) * (p.f - p.e);
  p.axis3 = (1.0 / 0.035) * perp(p.e - b); // E is on the negative y axis of K3
  p.axis4 = (1.0 / 0.02) * perp(p.e - p.g);
  p.axis5 = (1.0 / 0.04) * (p.g - a);
  p.axis6 = (1.0 / 0.02) * (p.e - p.h);
  p.axis7 = (1.0 / 0.04) * perp(p.h - a);
  return p;
}

struct Inertia {
  double value, half_slope;
};

inline void add(Inertia& total, const Body& body, const Point& pin, const Point& axis) {
  const Point c = pin + body.cx * axis + body.cy * perp(axis);
  const double turn = axis.x.v * axis.y.d - axis.y.v * axis.x.d;
  const double turn2 = axis.x.v * axis.y.dd - axis.y.v * axis.x.dd;
  total.value += body.mass * (c.x.d * c.x.d + c.y.d * c.y.d) + body.inertia * turn * turn;
  total.half_slope += body.mass * (c.x.d * c.x.dd + c.y.d * c.y.dd) + body.inertia * turn * turn2;
}

double angle(const Point& axis) { return std::atan2(axis.y.v, axis.x.v); }

} // namespace

void andrews_reduced_rates(const double* y, double* dydt) {
  const Pose p = pose_of(y[0]);
  const Point a = fixed(k_ax, k_ay);
  const Point b = fixed(k_bx, k_by);
  Inertia total = {k_crank.inertia + k_crank.mass * k_crank.cx * k_crank.cx, 0.0};
  add(total, k_2, p.f, p.axis2);
  add(total, k_3, b, p.axis3);
  add(total, k_4, p.g, p.axis4);
  add(total, k_5, a, p.axis5);
  add(total, k_6, p.h, p.axis6);
  add(total, k_7, a, p.axis7);
  const Point d = b + 0.02 * p.axis3 + -0.018 * perp(p.axis3);
  const double dx = d.x.v - k_spring_x;
  const double dy = d.y.v - k_spring_y;
  const double length = std::sqrt(dx * dx + dy * dy);
  const double pull = k_stiffness * (length - k_free_length) / length;
  const double force = k_torque - pull * (dx * d.x.d + dy * d.y.d);
  dydt[0] = y[1];
  dydt[1] = (force - total.half_slope * y[1] * y[1]) / total.value;
}

AndrewsAngles assemble_andrews(double beta) {
  const Pose p = pose_of(beta);
  double theta = angle(p.axis2) - beta;
  const double delta = angle(p.axis5);
  const double epsilon = angle(p.axis7);
  return {beta, theta, angle(p.axis3), angle(p.axis4) - delta, delta, angle(p.axis6) - epsilon, epsilon};
}

double andrews_start(AndrewsVariant variant) {
  if (variant == AndrewsVariant::a03) return -0.0620;
  // For Θ = 0, E = −3 F, and E is on the circle of radius 0.035 m about B.
  const double r = 0.028 - k_crank_arm;
  const double square = k_bx * k_bx + k_by * k_by;
  const double cosine = (r * r + square - 0.035 * 0.035) / (2.0 * r * std::sqrt(square));
  const double towards = std::atan2(k_by, k_bx) + std::numbers::pi;
  const double one = std::remainder(towards + std::acos(cosine), 2.0 * std::numbers::pi);
  const double two = std::remainder(towards - std::acos(cosine), 2.0 * std::numbers::pi);
  return std::abs(one + 0.0617) < std::abs(two + 0.0617) ? one : two;
}

AndrewsResult run_andrews_dop853(AndrewsVariant variant, double tolerance) {
  std::array<double, 2> y = {andrews_start(variant), 0.0};
  auto rates = [](double, const double* x, double* f) { andrews_reduced_rates(x, f); };
  const SmoothCounts counts = run_dop853(rates, y, k_andrews_end[static_cast<int>(variant)], 1e-3 * std::pow(tolerance, 0.125), tolerance);
  return {assemble_andrews(y[0]), counts.steps, counts.evaluations};
}

} // namespace steplap::peers
