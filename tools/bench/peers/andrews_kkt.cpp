// Andrews' mechanism with seven absolute angles and the three loop closures at E
// as six acceleration constraints (index 1): one KKT solve per evaluation,
//   [M Gᵀ; G 0] (α̈, λ) = (f, γ), by the dense Schur complement G M⁻¹ Gᵀ.

#include "andrews.h"

#include <Eigen/Dense>

#include <cmath>

namespace steplap::peers {
namespace {

using Vector2 = Eigen::Vector2d;
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// A body that is pinned to its parent, or to the ground, at the parent's point `pin`.
struct Body {
  double mass, inertia;
  Vector2 centre; // centre of gravity in the body's frame, whose origin is the pin
  int parent;     // index of the parent; −1: ground
  Vector2 pin;    // position of the pin in the parent's frame
  Vector2 e;      // position of E in the body's frame (unused for the crank)
};

const std::array<Body, 7> k_bodies = {{
    {0.04325, 2.194e-6, {0.00092, 0.0}, -1, {0.0, 0.0}, {0.0, 0.0}},
    {0.00365, 4.410e-7, {-0.0115, 0.0}, 0, {0.007, 0.0}, {-0.028, 0.0}},
    {0.02373, 5.255e-6, {0.01043, -0.01874}, -1, {-0.03635, 0.03273}, {0.0, -0.035}},
    {0.00706, 5.667e-7, {0.0, -0.00579}, 4, {0.04, 0.0}, {0.0, -0.02}},
    {0.07050, 1.169e-5, {0.02308, 0.00916}, -1, {-0.06934, -0.00227}, {0.0, 0.0}},
    {0.00706, 5.667e-7, {0.00579, 0.0}, 6, {0.0, -0.04}, {0.02, 0.0}},
    {0.05498, 1.912e-5, {-0.00449, -0.01228}, -1, {-0.06934, -0.00227}, {0.0, 0.0}},
}};
constexpr int k_chain_ends[3] = {1, 3, 5}; // bodies that share point E with K3
constexpr int k_triangle = 2;
constexpr double k_torque = 0.033, k_stiffness = 4530.0, k_free_length = 0.07785;

struct Equations {
  Eigen::Matrix<double, 7, 7> mass;
  Eigen::Matrix<double, 6, 7> g;
  Vector7 force;
  Vector6 gamma;
};

Vector2 perp(const Vector2& a) { return {-a.y(), a.x()}; }

Equations equations(const double* y) {
  Equations eq;
  eq.mass.setZero();
  eq.g.setZero();
  eq.force.setZero();
  double c[7], s[7];
  for (int i = 0; i < 7; ++i) {
    c[i] = std::cos(y[i]);
    s[i] = std::sin(y[i]);
  }
  const double* rate = y + 7;
  auto turn = [&](int i, const Vector2& a) { return Vector2(c[i] * a.x() - s[i] * a.y(), s[i] * a.x() + c[i] * a.y()); };
  for (int i = 0; i < 7; ++i) {
    const Body& b = k_bodies[i];
    const Vector2 centre = turn(i, b.centre);
    eq.mass(i, i) += b.inertia + b.mass * centre.squaredNorm();
    if (b.parent < 0) continue;
    const int a = b.parent;
    const Vector2 pin = turn(a, b.pin);
    eq.mass(a, a) += b.mass * pin.squaredNorm();
    eq.mass(a, i) = eq.mass(i, a) = b.mass * pin.dot(centre);
    // r̈ = pin⊥ α̈a + centre⊥ α̈i − pin α̇a² − centre α̇i²
    const Vector2 bias = -pin * rate[a] * rate[a] - centre * rate[i] * rate[i];
    eq.force[a] -= b.mass * perp(pin).dot(bias);
    eq.force[i] -= b.mass * perp(centre).dot(bias);
  }
  eq.force[0] += k_torque;
  const Vector2 arm = turn(k_triangle, {0.02, -0.018});
  const Vector2 stretch = k_bodies[k_triangle].pin + arm - Vector2(0.014, 0.072);
  const double length = stretch.norm();
  eq.force[k_triangle] -= k_stiffness * (length - k_free_length) / length * stretch.dot(perp(arm));
  const Vector2 meeting = turn(k_triangle, k_bodies[k_triangle].e);
  for (int loop = 0; loop < 3; ++loop) {
    const int i = k_chain_ends[loop];
    const int a = k_bodies[i].parent;
    const Vector2 pin = turn(a, k_bodies[i].pin);
    const Vector2 tip = turn(i, k_bodies[i].e);
    eq.g.block<2, 1>(2 * loop, a) = perp(pin);
    eq.g.block<2, 1>(2 * loop, i) = perp(tip);
    eq.g.block<2, 1>(2 * loop, k_triangle) = -perp(meeting);
    eq.gamma.segment<2>(2 * loop) = pin * rate[a] * rate[a] + tip * rate[i] * rate[i] - meeting * rate[k_triangle] * rate[k_triangle];
  }
  return eq;
}

} // namespace

// Solves the KKT system. M has a 2 × 2 block for each body with its parent, and a 1 × 1 block for the triangle.
void andrews_kkt_rates(const double* y, double* dydt, double* lambda) {
  const Equations eq = equations(y);
  Vector7 free;                        // M⁻¹ f
  Eigen::Matrix<double, 7, 6> reached; // M⁻¹ Gᵀ
  for (const int i : k_chain_ends) {
    const int a = k_bodies[i].parent;
    const double over = 1.0 / (eq.mass(a, a) * eq.mass(i, i) - eq.mass(a, i) * eq.mass(a, i));
    const double aa = eq.mass(i, i) * over;
    const double ii = eq.mass(a, a) * over;
    const double ai = -eq.mass(a, i) * over;
    free[a] = aa * eq.force[a] + ai * eq.force[i];
    free[i] = ai * eq.force[a] + ii * eq.force[i];
    reached.row(a) = aa * eq.g.col(a) + ai * eq.g.col(i);
    reached.row(i) = ai * eq.g.col(a) + ii * eq.g.col(i);
  }
  const double over = 1.0 / eq.mass(k_triangle, k_triangle);
  free[k_triangle] = eq.force[k_triangle] * over;
  reached.row(k_triangle) = eq.g.col(k_triangle) * over;
  const Eigen::Matrix<double, 6, 6> schur = eq.g * reached;
  const Vector6 multiplier = schur.llt().solve(eq.g * free - eq.gamma);
  const Vector7 acceleration = free - reached * multiplier;
  for (int i = 0; i < 7; ++i) {
    dydt[i] = y[7 + i];
    dydt[7 + i] = acceleration[i];
  }
  if (lambda == nullptr) return;
  for (int i = 0; i < 6; ++i) lambda[i] = multiplier[i];
}

void andrews_kkt_residual(const double* y, const double* a, const double* lambda, double* residual) {
  const Equations eq = equations(y);
  const Eigen::Map<const Vector7> acceleration(a);
  const Eigen::Map<const Vector6> multiplier(lambda);
  Eigen::Map<Vector7> dynamics(residual);
  Eigen::Map<Vector6> constraint(residual + 7);
  dynamics = eq.mass * acceleration + eq.g.transpose() * multiplier - eq.force;
  constraint = eq.g * acceleration - eq.gamma;
}

} // namespace steplap::peers
