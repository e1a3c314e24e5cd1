// Explicit Runge–Kutta methods: one engine, the coefficients are data known at compile time.
//
// A Method has k_stages, k_order, a, b, c as constexpr arrays and two functions of its stages:
// error(...) (adaptive methods) and its dense output, supplied by the derived class.
#pragma once

#include "mbd/integrators/integrator.h"
#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap {

/// out = y + h Σ_j coefficient_j k_j, zero coefficients dropped at compile time. Rows is a constexpr
/// array of rows, Row and Count pick the first Count entries of one.
template <const auto& Rows, std::size_t Row, std::size_t Count>
inline void combine(const double* __restrict y, double h, const double* __restrict k, int stride, int n,
                    double* __restrict out) {
  [&]<std::size_t... J>(std::index_sequence<J...>) {
    for (int i = 0; i < n; ++i) {
      double sum = 0.0;
      ((Rows[Row][J] != 0.0 ? void(sum += Rows[Row][J] * k[J * stride + i]) : void()), ...);
      out[i] = y[i] + h * sum;
    }
  }(std::make_index_sequence<Count>{});
}

/// out = Σ_j w_j k_j
template <const auto& Weights, std::size_t Count>
inline void weighted_sum(const double* __restrict k, int stride, int n, double* __restrict out) {
  [&]<std::size_t... J>(std::index_sequence<J...>) {
    for (int i = 0; i < n; ++i) {
      double sum = 0.0;
      ((Weights[J] != 0.0 ? void(sum += Weights[J] * k[J * stride + i]) : void()), ...);
      out[i] = sum;
    }
  }(std::make_index_sequence<Count>{});
}

/// The same with one row of an array of rows (a part of an object as argument is more than clang 14 understands).
template <const auto& Rows, std::size_t Row, std::size_t Count>
inline void weighted_row(const double* __restrict k, int stride, int n, double* __restrict out) {
  [&]<std::size_t... J>(std::index_sequence<J...>) {
    for (int i = 0; i < n; ++i) {
      double sum = 0.0;
      ((Rows[Row][J] != 0.0 ? void(sum += Rows[Row][J] * k[J * stride + i]) : void()), ...);
      out[i] = sum;
    }
  }(std::make_index_sequence<Count>{});
}

/// The adaptive loop around a pair: PI control after Hairer & Wanner, Solving ODEs II, IV.2.
struct StepControl {
  int order = 5;          ///< of the error estimate + 1: err = O(h^order)
  double safety = 0.9;
  double largest = 6.0, smallest = 0.2;
  double beta = 0.04;
  double previous_error = 1e-4;

  [[nodiscard]] double factor(double error, bool is_after_rejection) {
    const double alpha = 1.0 / order - 0.75 * beta;
    double f = error > 0.0
                   ? safety * portable::pow(error, -alpha) * portable::pow(previous_error, beta)
                   : largest;
    f = std::clamp(f, smallest, is_after_rejection ? 1.0 : largest);
    previous_error = std::max(error, 1e-4);
    return f;
  }
};

} // namespace steplap
