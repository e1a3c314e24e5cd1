// The text is the same as that of std::to_chars: fixed or scientific notation, whichever is shorter, fixed if equal. The digits are found
// as in Schubfach (R. Giulietti, The Schubfach way to render doubles, 2020), but with a single product that is accurate to 2^-60 of the
// seventeenth digit. In the rare cases in which this is not accurate enough, fmt's Dragonbox is used.
#include "mbd/base/number_text.h"

#define FMT_HEADER_ONLY // its shared object would be loaded at every start
#define FMT_USE_FULL_CACHE_DRAGONBOX 1
// fmt is included in a namespace of this file, because spdlog contains another fmt with a smaller table of the same name, and the linker
// would keep only one of the two.
#define FMT_BEGIN_NAMESPACE                                                                                                                \
  namespace fmt {                                                                                                                          \
  inline namespace full_cache {
#define FMT_END_NAMESPACE                                                                                                                  \
  }                                                                                                                                        \
  }
#include <fmt/format-inl.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace steplap {

namespace {

constexpr auto k_powers = [] {
  std::array<std::uint64_t, 20> powers{};
  std::uint64_t power = 1;
  for (std::uint64_t& p : powers) {
    p = power;
    power *= 10;
  }
  return powers;
}();

static_assert(std::endian::native == std::endian::little, "characters are put together in words");
__extension__ typedef unsigned __int128 Sixteen;

/// Decimal digits of a positive number.
struct Decimal {
  std::uint64_t first; ///< first sixteen digits; the leading one is not 0
  unsigned last;       ///< seventeenth digit; no double needs more
  int exponent;        ///< decimal exponent of the leading digit
};

/// Returns the number of decimal digits; 0 for 0.
int digit_count(std::uint64_t value) {
  const int bits = 64 - __builtin_clzll(value | 1);
  const int about = bits * 1233 >> 12; // log₁₀ 2, rounded down
  return about + (value >= k_powers[static_cast<std::size_t>(about)] ? 1 : 0);
}

[[gnu::noinline]] Decimal decimal_by_dragonbox(double value) {
  const auto [digits, exponent] = fmt::detail::dragonbox::to_decimal(value);
  const int count = digit_count(digits);
  if (count > 16) return {digits / 10, static_cast<unsigned>(digits % 10), exponent + count - 1};
  return {digits * k_powers[static_cast<std::size_t>(16 - count)], 0, exponent + count - 1};
}

/// Returns the shortest decimal number in the rounding interval of `value` (between the midpoints to its neighbouring doubles); of several,
/// the nearest to `value`.
Decimal decimal_of(double value) {
  constexpr std::uint64_t k_fraction = (std::uint64_t{1} << 52) - 1, k_one = std::uint64_t{1} << 60, k_half = std::uint64_t{1} << 63;
  constexpr std::uint64_t k_sure = 8, k_sure_of_half = 64; // at least three times the error of the products below
  constexpr std::uint64_t k_sixteen_digits = 1000000000000000;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const int biased = static_cast<int>(bits >> 52);
  // Powers of two, where the spacing of doubles changes, and subnormal numbers need the general algorithm.
  if ((bits & k_fraction) == 0 || biased == 0) return decimal_by_dragonbox(value);
  const int q = biased - 1075;
  const int k = q * 1262611 >> 22;            // ⌊log₁₀ 2^q⌋
  const int h = q + (-k * 1741647 >> 19) + 1; // 2^q 10^-k = 2^h g / 2^128 lies in [1, 10); 1 ≤ h ≤ 4
  const auto g = fmt::detail::dragonbox::cache_accessor<double>::get_cached_power(-k);
  const std::uint64_t c = ((bits & k_fraction) | (k_fraction + 1)) << h;
  const Sixteen scaled = Sixteen(g.high()) * c + static_cast<std::uint64_t>(Sixteen(g.low()) * c >> 64);  // 10^-k value, in units of 2^-64
  const auto whole = static_cast<std::uint64_t>(scaled >> 64), part = static_cast<std::uint64_t>(scaled); // sixteen or seventeen digits
  std::uint64_t tens = whole / 10;
  const std::uint64_t ones = whole - 10 * tens;
  // Distances within the last digit, in units of 2^-60: to the midpoint of neighbouring doubles (reach), and to the next multiples of ten
  // below and above. At most one of these multiples lies within reach.
  const std::uint64_t reach = g.high() >> (5 - h), down = ones * k_one + (part >> 4), up = 10 * k_one - down;
  const bool is_down = down < reach, is_up = up < reach;
  if (down - reach + k_sure < 2 * k_sure || up - reach + k_sure < 2 * k_sure || part - k_half + k_sure_of_half < 2 * k_sure_of_half)
      [[unlikely]]
    return decimal_by_dragonbox(value);
  const unsigned last = is_down || is_up ? 0U : static_cast<unsigned>(ones + (part >> 63)); // at most 9: from 9.5 on, ten is within reach
  tens += is_up ? 1 : 0;
  if (tens >= k_sixteen_digits) return {tens, last, k + 16};
  return {10 * tens + last, 0, k + 15};
}

/// Sixteen digits, one byte each; the first digit is the lowest byte of `low`.
struct Digits {
  std::uint64_t low, high;
};

#if defined(__SSE2__)
// Splits all digits in parallel: two groups of eight digits become four of four, eight of two and sixteen of one.
Digits digits_of(std::uint64_t value) {
  const auto all = [](int x) { return _mm_set1_epi32(x); };
  const auto each = [](short x) { return _mm_set1_epi16(x); };
  const std::uint64_t eights = value / 100000000;
  const __m128i eight = _mm_unpacklo_epi64(_mm_cvtsi64_si128(static_cast<long long>(eights)),
                                           _mm_cvtsi64_si128(static_cast<long long>(value - eights * 100000000)));
  const __m128i fours = _mm_srli_epi64(_mm_mul_epu32(eight, all(static_cast<int>(3518437209U))), 45); // / 10000
  const __m128i four = _mm_or_si128(fours, _mm_slli_epi64(_mm_sub_epi32(eight, _mm_mul_epu32(fours, all(10000))), 32));
  const __m128i twos = _mm_srli_epi16(_mm_mulhi_epu16(four, each(10486)), 4); // / 100
  const __m128i two = _mm_or_si128(twos, _mm_slli_epi32(_mm_sub_epi16(four, _mm_mullo_epi16(twos, each(100))), 16));
  const __m128i tens = _mm_mulhi_epu16(two, each(6554)); // / 10
  const __m128i one = _mm_or_si128(tens, _mm_slli_epi16(_mm_sub_epi16(two, _mm_mullo_epi16(tens, each(10))), 8));
  const __m128i text = _mm_or_si128(one, _mm_set1_epi8('0'));
  return {static_cast<std::uint64_t>(_mm_cvtsi128_si64(text)),
          static_cast<std::uint64_t>(_mm_cvtsi128_si64(_mm_unpackhi_epi64(text, text)))};
}
#else
/// Splits eight digits: two groups of four in one word, four of two, eight of one.
std::uint64_t eight(std::uint64_t value) {
  const std::uint64_t high = value / 10000, fours = high | (value - high * 10000) << 32;
  const std::uint64_t hundreds = (fours * 10486 >> 20) & 0x0000007f0000007f; // for each four digits, the upper two
  const std::uint64_t twos = hundreds | (fours - hundreds * 100) << 16;
  const std::uint64_t tens = (twos * 103 >> 10) & 0x000f000f000f000f, ones = tens | (twos - tens * 10) << 8;
  return ones + 0x3030303030303030;
}
Digits digits_of(std::uint64_t value) { return {eight(value / 100000000), eight(value % 100000000)}; }
#endif

constexpr std::uint64_t k_zeros = 0x3030303030303030;

/// Returns the number of digits without trailing zeros; the first digit must not be 0.
int without_zeros(const Digits& d) {
  const std::uint64_t high = d.high ^ k_zeros;
  return high != 0 ? 16 - (__builtin_clzll(high) >> 3) : 8 - (__builtin_clzll(d.low ^ k_zeros) >> 3);
}

/// Writes seventeen digits.
void put_digits(char* at, const Digits& d, unsigned last) {
  std::memcpy(at, &d.low, sizeof d.low);
  std::memcpy(at + 8, &d.high, sizeof d.high);
  at[16] = static_cast<char>('0' + last);
}

/// Writes seventeen digits with a decimal point after the first `before` of them (0 < before < 17); eighteen bytes. Only stores are used,
/// because loading bytes that were just stored with another width stalls the processor.
void put_with_point(char* at, const Digits& d, unsigned last, int before) {
  put_digits(at + 1, d, last); // digits after the point are now in place
  std::uint64_t word = d.low;
  if (before < 8) {
    const std::uint64_t bit = std::uint64_t{1} << (8 * before), mask = bit - 1;
    word = (d.low & mask) | (d.low & ~mask) << 8 | bit * '.';
  }
  std::memcpy(at, &word, sizeof word);
  if (before < 8) return;
  for (int i = 8; i < before; ++i) at[i] = static_cast<char>(d.high >> (8 * (i - 8)));
  at[before] = '.';
}

char* put_scientific(char* at, const Digits& d, unsigned last, int count, int exponent) {
  if (count > 1) put_with_point(at, d, last, 1);
  else *at = static_cast<char>(d.low);
  at += count > 1 ? count + 1 : 1;
  *at++ = 'e';
  *at++ = exponent < 0 ? '-' : '+';
  int size = std::abs(exponent);
  if (size >= 100) {
    *at++ = static_cast<char>('0' + size / 100);
    size %= 100;
  }
  *at++ = static_cast<char>('0' + size / 10);
  *at++ = static_cast<char>('0' + size % 10);
  return at;
}

} // namespace

char* write_number(char* at, double value) {
  constexpr int k_exact = 15; // whole numbers of at most this many digits are below 2⁵³ and exact
  const auto as_always = [&] { return std::to_chars(at, at + k_number_room, value).ptr; };
  if (!std::isfinite(value)) return as_always();
  if (std::signbit(value)) {
    *at++ = '-';
    value = -value;
  }
  if (value == 0.0) {
    *at = '0';
    return at + 1;
  }
  const auto [first, last, exponent] = decimal_of(value);
  const Digits digits = digits_of(first);
  const int count = last != 0 ? 17 : without_zeros(digits);
  const int scientific = (count > 1 ? count + 1 : 1) + 2 + (std::abs(exponent) >= 100 ? 3 : 2); // length of the text in scientific notation
  const int whole = exponent + 1;                                                               // number of digits before the decimal point
  const int fixed = whole >= count ? whole : (whole > 0 ? count + 1 : count + 2 - whole);
  if (fixed > scientific) return put_scientific(at, digits, last, count, exponent);
  if (whole >= count) {
    if (fixed > k_exact) return as_always(); // fixed notation of large whole numbers shows all digits, more than the shortest text has
    put_digits(at, digits, last);
  } else if (whole > 0) {
    put_with_point(at, digits, last, whole);
  } else {
    std::memcpy(at, "0.000000", 8); // more leading zeros would be longer than scientific notation
    put_digits(at + 2 - whole, digits, last);
  }
  return at + fixed;
}

void append_number(std::string& text, double value) {
  char buffer[k_number_room];
  text.append(buffer, write_number(buffer, value));
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

} // namespace steplap
