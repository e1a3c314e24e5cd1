// Linear combinations of stages for explicit Runge–Kutta methods. The coefficients are compile-time constants, so that zeros cost nothing
// and loops are vectorised.
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/integrators/integrator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

namespace steplap {

/// SIMD registers of two and four doubles. Each lane performs the same operations in the same order as scalar code. All x86-64 processors
/// have two, most have four.
using TwoNumbers [[gnu::vector_size(16)]] = double;
using FourNumbers [[gnu::vector_size(32)]] = double;

/// Reads as many numbers as S holds. (Output by reference, because the register that would return S depends on the processor.)
template <class S> STEPLAP_INLINE void read_numbers(const double* from, S& numbers) { std::memcpy(&numbers, from, sizeof numbers); }

/// Calls f.operator()<S>(i) for all numbers i … n − 1, in blocks of two and a single last one.
template <class F> STEPLAP_INLINE void for_numbers_by_two(int i, int n, const F& f) {
  for (; i + 1 < n; i += 2) f.template operator()<TwoNumbers>(i);
  if (i < n) f.template operator()<double>(i);
}

#if defined(__x86_64__)
template <class F> [[gnu::target("avx")]] void for_numbers_by_four(int n, const F& f) {
  int i = 0;
  for (; i + 3 < n; i += 4) f.template operator()<FourNumbers>(i);
  for_numbers_by_two(i, n, f);
}
inline const bool has_registers_of_four = __builtin_cpu_supports("avx") != 0;
#endif

template <class F> inline void for_numbers(int n, const F& f) {
#if defined(__x86_64__)
  if (has_registers_of_four) return for_numbers_by_four(n, f);
#endif
  for_numbers_by_two(0, n, f);
}

/// sum += coefficient · k.
template <class S> STEPLAP_INLINE void add_stage(double coefficient, const double* k, S& sum) {
  S numbers;
  read_numbers(k, numbers);
  sum += coefficient * numbers;
}

/// sum = Σ_j coefficient_j k_j; zero coefficients are dropped at compile time.
template <class S, auto Coefficient, std::size_t... J>
STEPLAP_INLINE void sum_stages_into(S& sum, const double* k, int stride, std::index_sequence<J...>) {
  sum = S{};
  ((Coefficient(J) != 0.0 ? add_stage(Coefficient(J), k + static_cast<std::ptrdiff_t>(J) * stride, sum) : void()), ...);
}

/// Stores sums Σ_j coefficient_j k_j[i …] of a block of the size of S to out[i …], after modification by f(i, sum).
template <class S, auto Coefficient, std::size_t Count, class F>
STEPLAP_INLINE void put_sums(const double* k, int stride, int i, double* out, const F& f) {
  S sum;
  sum_stages_into<S, Coefficient>(sum, k + i, stride, std::make_index_sequence<Count>{});
  f(i, sum);
  std::memcpy(out + i, &sum, sizeof sum);
}

/// put_sums() for `i` … n − 1 in blocks of two.
template <auto Coefficient, std::size_t Count, class F>
STEPLAP_INLINE void put_sums_by_two(const double* __restrict k, int stride, int i, int n, double* __restrict out, const F& f) {
  for (; i + 1 < n; i += 2) put_sums<TwoNumbers, Coefficient, Count>(k, stride, i, out, f);
  if (i < n) put_sums<double, Coefficient, Count>(k, stride, i, out, f);
}

#if defined(__x86_64__)
template <auto Coefficient, std::size_t Count, class F>
[[gnu::target("avx")]] void put_sums_by_four(const double* __restrict k, int stride, int n, double* __restrict out, const F& f) {
  int i = 0;
  for (; i + 3 < n; i += 4) put_sums<FourNumbers, Coefficient, Count>(k, stride, i, out, f);
  put_sums_by_two<Coefficient, Count>(k, stride, i, n, out, f);
}
#endif

/// put_sums() for all i < n, in the largest blocks that the processor has.
template <auto Coefficient, std::size_t Count, class F> inline void for_sums(const double* k, int stride, int n, double* out, const F& f) {
#if defined(__x86_64__)
  if (has_registers_of_four) return put_sums_by_four<Coefficient, Count>(k, stride, n, out, f);
#endif
  put_sums_by_two<Coefficient, Count>(k, stride, 0, n, out, f);
}

/// Functor that leaves the sum unchanged.
struct UnchangedSum {
  template <class S> STEPLAP_INLINE void operator()(int, S&) const {}
};

/// out = y + h Σ_j coefficient_j k_j, with the first Count entries of row `Row` of the constexpr array Rows.
template <const auto& Rows, std::size_t Row, std::size_t Count>
inline void combine(const double* __restrict y, double h, const double* __restrict k, int stride, int n, double* __restrict out) {
  for_sums<[](std::size_t j) { return Rows[Row][j]; }, Count>(
      k, stride, n, out, [=]<class S>(int i, S& sum) __attribute__((always_inline)) {
        S before;
        read_numbers(y + i, before);
        sum = before + h * sum;
      });
}

/// out = Σ_j w_j k_j.
template <const auto& Weights, std::size_t Count>
inline void weighted_sum(const double* __restrict k, int stride, int n, double* __restrict out) {
  for_sums<[](std::size_t j) { return Weights[j]; }, Count>(k, stride, n, out, UnchangedSum{});
}

/// out = h Σ_j w_j k_j with one row of an array. (clang 14 does not accept the row itself as template argument.)
template <const auto& Rows, std::size_t Row, std::size_t Count>
inline void weighted_row(double h, const double* __restrict k, int stride, int n, double* __restrict out) {
  for_sums<[](std::size_t j) { return Rows[Row][j]; }, Count>(
      k, stride, n, out, [h]<class S>(int, S& sum) __attribute__((always_inline)) { sum = h * sum; });
}

/// PI control of the step length, after Hairer & Wanner, Solving ODEs II, IV.2.
struct StepControl {
  int order = 5; ///< p in err = O(h^p)
  double safety = 0.9;
  double largest = 6.0, smallest = 0.2;
  double beta = 0.04;
  double previous_error = 1e-4;

  /// Returns the ratio of the next step length to the present one for an error norm `error`.
  [[nodiscard]] double factor(double error, bool is_after_rejection) {
    const double alpha = 1.0 / order - 0.75 * beta;
    double f = error > 0.0 ? safety * portable::pow(error, -alpha) * portable::pow(previous_error, beta) : largest;
    f = std::clamp(f, smallest, is_after_rejection ? 1.0 : largest);
    previous_error = std::max(error, 1e-4);
    return f;
  }
};

} // namespace steplap
