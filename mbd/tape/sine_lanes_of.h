// Implementation for the sources that are compiled for one instruction set each (sine_two.cpp and others). The header contains only
// templates over the number of lanes and calls nothing of the standard library. Otherwise the linker could keep, for all of the program, a
// copy of a library function that was compiled for instructions which the processor lacks.
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/base/sine_series.h"

#include <cstdint>

namespace steplap {

template <int lanes> struct Pack {
  using Doubles __attribute__((vector_size(8 * lanes))) = double;
  using Bits __attribute__((vector_size(8 * lanes))) = std::uint64_t;
};

// Bit patterns of limits for |x|. Read as integers, doubles without sign have the order of their values; ∞ and NaN come last.
constexpr std::uint64_t k_far_bits = 0x412e848000000000;     // portable::k_far
constexpr std::uint64_t k_quarter_bits = 0x3fe921fb54442d18; // π/4, below which no reduction is needed
constexpr std::uint64_t k_tiny_bits = 0x3e30000000000000;    // 2⁻²⁸, below which sin x = x and cos x = 1

template <int lanes> [[gnu::noinline]] inline void sin_cos_one_by_one(const double* x, double* sines, double* cosines) {
  for (int l = 0; l < lanes; ++l) {
    const portable::SinCos of = portable::sin_cos(x[l]);
    sines[l] = of.sin;
    cosines[l] = of.cos;
  }
}

/// Vectorised portable::sin_cos, with selects instead of branches. Lanes with |x| ≤ π/4 subtract zero, which is exact, if another lane
/// needs reduction. If one argument is large or not finite, all lanes are computed one by one.
template <int lanes> inline void sin_cos_of(const double* x, double* sines, double* cosines) {
  using Doubles = typename Pack<lanes>::Doubles;
  using Bits = typename Pack<lanes>::Bits;
  Doubles v;
  __builtin_memcpy(&v, x, sizeof v);
  const Bits size = reinterpret_cast<Bits>(v) & ~(std::uint64_t{1} << 63);
  std::uint64_t largest = size[0];
  for (int l = 1; l < lanes; ++l) largest = size[l] > largest ? size[l] : largest;
  if (largest >= k_far_bits) return sin_cos_one_by_one<lanes>(x, sines, cosines);
  Doubles s, c;
  if (largest <= k_quarter_bits) {
    const auto of = portable::sine_series<Doubles>(v, Doubles{});
    s = of.sin;
    c = of.cos;
  } else {
    const Doubles shifted = v * portable::k_two_over_pi + portable::k_nearest_integer; // its last bits are those of the multiple k
    const auto rest = portable::beyond_multiple<Doubles>(v, shifted - portable::k_nearest_integer);
    const auto of = portable::sine_series<Doubles>(rest.hi, rest.lo);
    const Bits quarter = reinterpret_cast<Bits>(shifted);
    const auto is_odd = (quarter & 1) != 0;
    const Doubles of_sine = is_odd ? of.cos : of.sin, of_cosine = is_odd ? of.sin : of.cos;
    s = reinterpret_cast<Doubles>(reinterpret_cast<Bits>(of_sine) ^ ((quarter & 2) << 62));
    c = reinterpret_cast<Doubles>(reinterpret_cast<Bits>(of_cosine) ^ (((quarter + 1) & 2) << 62));
  }
  const auto is_tiny = size < k_tiny_bits;
  s = is_tiny ? v : s;
  c = is_tiny ? Doubles{} + 1.0 : c;
  __builtin_memcpy(sines, &s, sizeof s);
  __builtin_memcpy(cosines, &c, sizeof c);
}

} // namespace steplap
