#include "scaling.h"

#include <cmath>
#include <cstddef>

namespace steplap::peers {

// --- chain: c the rods' centres, r from the centre to the right end, λ_i on the left end of rod i ----------

ChainByHand::ChainByHand(int rods) : n_(rods) {
  const auto n = static_cast<std::size_t>(rods);
  for (auto* v : {&rx_, &ry_, &px_, &py_, &fx_, &fy_}) v->assign(n + 1, 0.0);
  inverse_.resize(n);
}

std::vector<double> ChainByHand::start() const {
  std::vector<double> y(static_cast<std::size_t>(6 * n_), 0.0);
  for (int i = 0; i < n_; ++i) y[static_cast<std::size_t>(3 * i)] = i + 0.5;
  return y;
}

// Rates of the state. The multipliers λ_i follow from the condition that the left end of rod i coincides with the right end of rod i − 1:
//   D_i λ_i + U_{i−1} λ_{i−1} + U_i λ_{i+1} = −(ω_i² r_i + ω_{i−1}² r_{i−1}), with the weight in the first equation,
//   U_i = n_i n_iᵀ/J − 1/m, D_i = (1/m + n_i n_iᵀ/J) + the same of the rod before, n = ẑ × r.
void ChainByHand::rates(const double* y, double* dy) {
  const auto n = static_cast<std::size_t>(n_);
  const double* v = y + 3 * n;
  constexpr double j = 1.0 / k_rod_inertia;
  for (std::size_t i = 0; i < n; ++i) {
    rx_[i] = 0.5 * std::cos(y[3 * i + 2]);
    ry_[i] = 0.5 * std::sin(y[3 * i + 2]);
  }
  // Eliminates forward; p contains the right-hand sides.
  for (std::size_t i = 0; i < n; ++i) {
    double w = v[3 * i + 2] * v[3 * i + 2];
    double bx = -w * rx_[i], by = -w * ry_[i];
    Block d{1.0 + j * ry_[i] * ry_[i], -j * ry_[i] * rx_[i], 1.0 + j * rx_[i] * rx_[i]};
    if (i == 0) {
      by += k_gravity;
    } else {
      const double x = rx_[i - 1], z = ry_[i - 1];
      w = v[3 * i - 1] * v[3 * i - 1];
      bx -= w * x;
      by -= w * z;
      const Block u{j * z * z - 1.0, -j * z * x, j * x * x - 1.0};
      const Block& q = inverse_[i - 1];
      const double lxx = u.xx * q.xx + u.xy * q.xy, lxy = u.xx * q.xy + u.xy * q.yy;
      const double lyx = u.xy * q.xx + u.yy * q.xy, lyy = u.xy * q.xy + u.yy * q.yy;
      d.xx += 1.0 + j * z * z - (lxx * u.xx + lxy * u.xy);
      d.xy += -j * z * x - (lxx * u.xy + lxy * u.yy);
      d.yy += 1.0 + j * x * x - (lyx * u.xy + lyy * u.yy);
      bx -= lxx * px_[i - 1] + lxy * py_[i - 1];
      by -= lyx * px_[i - 1] + lyy * py_[i - 1];
    }
    const double determinant = 1.0 / (d.xx * d.yy - d.xy * d.xy);
    inverse_[i] = {d.yy * determinant, -d.xy * determinant, d.xx * determinant};
    px_[i] = bx;
    py_[i] = by;
  }
  fx_[n] = fy_[n] = 0.0;
  for (std::size_t i = n; i-- > 0;) {
    const double x = rx_[i], z = ry_[i];
    const double bx = px_[i] - (i + 1 < n ? (j * z * z - 1.0) * fx_[i + 1] - j * z * x * fy_[i + 1] : 0.0);
    const double by = py_[i] - (i + 1 < n ? -j * z * x * fx_[i + 1] + (j * x * x - 1.0) * fy_[i + 1] : 0.0);
    fx_[i] = inverse_[i].xx * bx + inverse_[i].xy * by;
    fy_[i] = inverse_[i].xy * bx + inverse_[i].yy * by;
  }
  for (std::size_t i = 0; i < n; ++i) {
    dy[3 * i] = v[3 * i];
    dy[3 * i + 1] = v[3 * i + 1];
    dy[3 * i + 2] = v[3 * i + 2];
    double* a = dy + 3 * n + 3 * i;
    a[0] = fx_[i] - fx_[i + 1];
    a[1] = fy_[i] - fy_[i + 1] - k_gravity;
    a[2] = -j * (rx_[i] * (fy_[i] + fy_[i + 1]) - ry_[i] * (fx_[i] + fx_[i + 1]));
  }
}

// --- grid ------------------------------------------------------------------------------------------------

std::vector<double> GridByHand::start() const {
  std::vector<double> y(static_cast<std::size_t>(4 * side_ * side_), 0.0);
  for (int r = 0; r < side_; ++r)
    for (int c = 0; c < side_; ++c) {
      y[static_cast<std::size_t>(2 * (r * side_ + c))] = c;
      y[static_cast<std::size_t>(2 * (r * side_ + c) + 1)] = -r;
    }
  return y;
}

// Adds the force of a spring-damper of free length 1 m from mass b to mass a. b < 0: from the ground above a.
void GridByHand::pull(const double* y, double* dy, int a, int b) const {
  const int n = 2 * side_ * side_;
  const double* v = y + n;
  double x = y[2 * a], z = y[2 * a + 1], vx = v[2 * a], vz = v[2 * a + 1];
  if (b < 0) {
    x -= a;
    z -= 1.0;
  } else {
    x -= y[2 * b];
    z -= y[2 * b + 1];
    vx -= v[2 * b];
    vz -= v[2 * b + 1];
  }
  const double length = std::sqrt(x * x + z * z);
  const double ex = x / length, ez = z / length;
  const double f = -k_grid_stiffness * (length - 1.0) - k_grid_damping * (ex * vx + ez * vz);
  dy[n + 2 * a] += f * ex;
  dy[n + 2 * a + 1] += f * ez;
  if (b < 0) return;
  dy[n + 2 * b] -= f * ex;
  dy[n + 2 * b + 1] -= f * ez;
}

void GridByHand::rates(const double* y, double* dy) {
  const int n = 2 * side_ * side_;
  for (int i = 0; i < n; ++i) dy[i] = y[n + i];
  for (int i = 0; i < n; i += 2) {
    dy[n + i] = 0.0;
    dy[n + i + 1] = -k_gravity;
  }
  for (int r = 0; r < side_; ++r)
    for (int c = 0; c < side_; ++c) {
      const int i = r * side_ + c;
      pull(y, dy, i, r == 0 ? -1 : i - side_);
      if (c > 0) pull(y, dy, i, i - 1);
    }
}

// --- classical Runge–Kutta ---------------------------------------------------------------------------------

ScalingResult run_rk4(ByHand& scene, int bodies) {
  std::vector<double> y = scene.start(), z(y.size()), k(y.size()), sum(y.size());
  const std::size_t n = y.size();
  constexpr double h = k_scaling_step;
  ScalingResult result;
  result.evaluations = 4.0;
  result.step_us = least_step_us(bodies, [&](int steps) {
    for (int s = 0; s < steps; ++s) {
      scene.rates(y.data(), k.data());
      for (std::size_t i = 0; i < n; ++i) {
        sum[i] = k[i];
        z[i] = y[i] + 0.5 * h * k[i];
      }
      for (const double share : {0.5, 1.0}) {
        scene.rates(z.data(), k.data());
        for (std::size_t i = 0; i < n; ++i) {
          sum[i] += 2.0 * k[i];
          z[i] = y[i] + share * h * k[i];
        }
      }
      scene.rates(z.data(), k.data());
      for (std::size_t i = 0; i < n; ++i) y[i] += h / 6.0 * (sum[i] + k[i]);
    }
  });
  result.probe = scene.probe(y.data());
  return result;
}

} // namespace steplap::peers
