// The text is that of std::to_chars: of fixed and scientific notation the shorter, fixed if both are as long. Its
// digits are fmt's shortest (Dragonbox), which take a third of the instructions.
#include "mbd/base/number_text.h"

#define FMT_HEADER_ONLY // its shared object would be loaded at every start
#define FMT_USE_FULL_CACHE_DRAGONBOX 1
#include <fmt/format-inl.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

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

/// The characters of eight digits, with zeros before the first, all at once: two numbers of four in one word, four of
/// two, eight of one. The first is in the lowest byte.
std::uint64_t eight(std::uint64_t value) {
  const std::uint64_t high = value / 10000, fours = high | (value - high * 10000) << 32;
  const std::uint64_t hundreds = (fours * 10486 >> 20) & 0x0000007f0000007f; // of each four, two digits
  const std::uint64_t twos = hundreds | (fours - hundreds * 100) << 16;
  const std::uint64_t tens = (twos * 103 >> 10) & 0x000f000f000f000f, ones = tens | (twos - tens * 10) << 8;
  return ones + 0x3030303030303030;
}

/// How many digits; of 0 none.
int digit_count(std::uint64_t value) {
  const int bits = 64 - __builtin_clzll(value | 1);
  const int about = bits * 1233 >> 12; // log₁₀ 2, rounded down
  return about + (value >= k_powers[static_cast<std::size_t>(about)] ? 1 : 0);
}

static_assert(std::endian::native == std::endian::little, "characters are put together in words");
__extension__ typedef unsigned __int128 Sixteen;

/// The digits of a number, the first in the lowest byte, and the seventeenth, beyond which no double needs any. They
/// are put in their places by stores alone: loading again what was just stored in other pieces would wait for it.
class Digits {
public:
  Digits(std::uint64_t value, int count) : count_(count) {
    if (count > 16) {
      const std::uint64_t others = value / 10;
      last_ = static_cast<char>('0' + (value - others * 10));
      value = others;
      count = 16;
    }
    const std::uint64_t high = value / 100000000;
    text_ = (Sixteen(eight(value - high * 100000000)) << 64 | eight(high)) >> (8 * (16 - count));
  }
  [[nodiscard]] int count() const { return count_; }
  /// Seventeen bytes, of which the first are the digits.
  void put(char* at) const {
    std::memcpy(at, &text_, sizeof text_);
    at[16] = last_;
  }
  /// With a point after the first few of them; eighteen bytes. 0 < before < count().
  void put_with_point(char* at, int before) const {
    const Sixteen behind = before < 16 ? text_ >> (8 * before) : 0;
    std::memcpy(at, &text_, sizeof text_);
    std::memcpy(at + before + 1, &behind, sizeof behind);
    at[before] = '.';
    if (count_ > 16) at[17] = last_;
  }

private:
  Sixteen text_;
  int count_;
  char last_ = '0';
};

char* put_scientific(char* at, const Digits& digits, int exponent) {
  if (digits.count() > 1) {
    digits.put_with_point(at, 1);
    at += digits.count() + 1;
  } else {
    digits.put(at);
    ++at;
  }
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

/// digits · 10^exponent, exponent < 0.
char* put_fixed(char* at, const Digits& digits, int exponent) {
  const int before = digits.count() + exponent; // the point
  if (before > 0) {
    digits.put_with_point(at, before);
    return at + digits.count() + 1;
  }
  std::memcpy(at, "0.000000", 8); // no more zeros than scientific notation takes for its exponent
  digits.put(at + 2 - before);
  return at + 2 - before + digits.count();
}

} // namespace

char* write_number(char* at, double value) {
  constexpr int k_exact = 15; // digits of whole numbers below 2⁵³
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
  const auto [digits, exponent] = fmt::detail::dragonbox::to_decimal(value);
  const int count = digit_count(digits);
  const int scientific = exponent + count - 1; // exponent of that notation, which takes its sign and two or three digits
  const int length = (count > 1 ? count + 1 : 1) + 2 + (std::abs(scientific) >= 100 ? 3 : 2);
  const int fixed_length = exponent >= 0 ? count + exponent : (count + exponent > 0 ? count + 1 : 2 - exponent);
  if (fixed_length > length) return put_scientific(at, {digits, count}, scientific);
  if (exponent < 0) return put_fixed(at, {digits, count}, exponent);
  if (fixed_length > k_exact) return as_always(); // all digits of a whole number, more than the shortest
  Digits(digits * k_powers[static_cast<std::size_t>(exponent)], fixed_length).put(at);
  return at + fixed_length;
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
