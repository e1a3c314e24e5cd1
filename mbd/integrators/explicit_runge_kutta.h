// Explicit Runge–Kutta methods: one engine, the coefficients are data known at compile time.
//
// A Method has k_stages, k_order, a, b, c as constexpr arrays and two functions of its stages:
// error(...) (adaptive methods) and its dense output, supplied by the derived class.
#pragma once

#include "mbd/integrators/integrator.h"
#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

namespace steplap {

/// Two neighbours in the two halves of a register that every x86-64 has: the operations of either, in their order.
using TwoNumbers [[gnu::vector_size(16)]] = double;

template <class S> STEPLAP_INLINE S numbers_at(const double* from) {
  S numbers;
  std::memcpy(&numbers, from, sizeof numbers);
  return numbers;
}

/// Σ_j coefficient_j k_j, zero coefficients dropped at compile time.
template <class S, auto Coefficient, std::size_t... J>
STEPLAP_INLINE S sum_of_stages(const double* k, int stride, std::index_sequence<J...>) {
  S sum{};
  ((Coefficient(J) != 0.0 ? void(sum += Coefficient(J) * numbers_at<S>(k + static_cast<std::ptrdiff_t>(J) * stride)) : void()), ...);
  return sum;
}

/// out[i] = f(i, Σ_j coefficient_j k_j[i]) for i < n, two at a time.
template <auto Coefficient, std::size_t Count, class F>
STEPLAP_INLINE void for_sums(const double* __restrict k, int stride, int n, double* __restrict out, const F& f) {
  constexpr auto stages = std::make_index_sequence<Count>{};
  int i = 0;
  for (; i + 1 < n; i += 2) {
    const TwoNumbers result = f(i, sum_of_stages<TwoNumbers, Coefficient>(k + i, stride, stages));
    std::memcpy(out + i, &result, sizeof result);
  }
  if (i < n) out[i] = f(i, sum_of_stages<double, Coefficient>(k + i, stride, stages));
}

/// out = y + h Σ_j coefficient_j k_j. Rows is a constexpr array of rows, Row and Count pick the first Count entries of one.
template <const auto& Rows, std::size_t Row, std::size_t Count>
inline void combine(const double* __restrict y, double h, const double* __restrict k, int stride, int n,
                    double* __restrict out) {
  for_sums<[](std::size_t j) { return Rows[Row][j]; }, Count>(
      k, stride, n, out, [=]<class S>(int i, S sum) { return S(numbers_at<S>(y + i) + h * sum); });
}

/// out = Σ_j w_j k_j
template <const auto& Weights, std::size_t Count>
inline void weighted_sum(const double* __restrict k, int stride, int n, double* __restrict out) {
  for_sums<[](std::size_t j) { return Weights[j]; }, Count>(k, stride, n, out, []<class S>(int, S sum) { return sum; });
}

/// The same with one row of an array of rows (a part of an object as argument is more than clang 14 understands).
template <const auto& Rows, std::size_t Row, std::size_t Count>
inline void weighted_row(const double* __restrict k, int stride, int n, double* __restrict out) {
  for_sums<[](std::size_t j) { return Rows[Row][j]; }, Count>(k, stride, n, out, []<class S>(int, S sum) { return sum; });
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
