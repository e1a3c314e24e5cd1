#pragma once

// Integrates a smooth system from 0 to an end time with DOP853: one absolute and relative tolerance, PI step control, no events.

#include "dop853_step.h"

#include <algorithm>

namespace steplap::peers {

struct SmoothCounts {
  long steps = 0;
  long evaluations = 0;
};

template <std::size_t N, class F>
SmoothCounts run_dop853(F rates, std::array<double, N>& y, double end, double first_step, double tolerance) {
  Dop853Step<static_cast<int>(N)> step;
  SmoothCounts counts;
  auto counted = [&](double t, const double* x, double* f) {
    ++counts.evaluations;
    rates(t, x, f);
  };
  double t = 0.0;
  double h = first_step;
  double last_error = 1e-4;
  counted(t, y.data(), step.k[0].data());
  while (t < end) {
    const bool last = t + 1.01 * h >= end;
    if (last) h = end - t;
    step.advance(counted, t, y, h);
    std::array<double, N> weight;
    for (std::size_t i = 0; i < N; ++i) weight[i] = 1.0 / (tolerance * (1.0 + std::max(std::abs(y[i]), std::abs(step.y1[i]))));
    const double error = std::max(step.error(h, weight), 1e-30);
    if (!(error <= 1.0)) { // also true if a trial has left the domain
      h *= std::isfinite(error) ? std::max(0.2, 0.9 * std::pow(error, -0.125)) : 0.2;
      continue;
    }
    ++counts.steps;
    const double factor = 0.9 * std::pow(error, -(0.125 - 0.75 * 0.04)) * std::pow(last_error, 0.04);
    t = last ? end : t + h;
    y = step.y1;
    if (!last) counted(t, y.data(), step.k[0].data());
    last_error = std::max(error, 1e-4);
    h *= std::clamp(factor, 0.2, 6.0);
  }
  return counts;
}

} // namespace steplap::peers
