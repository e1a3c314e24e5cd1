// Random numbers that are the same on every machine: splitmix64 (Steele, Lea, Flood, OOPSLA 2014), and no
// distribution of the standard library, whose results are the library's own affair.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace steplap::random {

/// Mind that C++ leaves open which operand or argument is evaluated first: one number an expression, or braces.
class RandomNumber {
public:
  explicit RandomNumber(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 0x632BE59BD9B4E019ULL) {}

  [[nodiscard]] std::uint64_t bits();
  /// In [low, high).
  [[nodiscard]] double between(double low, double high);
  /// 10^u, u in [low, high): a magnitude over decades.
  [[nodiscard]] double decades(double low, double high);
  /// 0 … count − 1.
  [[nodiscard]] int below(int count);
  [[nodiscard]] bool chance(double probability) { return between(0.0, 1.0) < probability; }
  /// Of either sign, its size in [low, high).
  [[nodiscard]] double either(double low, double high) {
    const double size = between(low, high);
    return chance(0.5) ? size : -size;
  }
  template <class T> [[nodiscard]] const T& one_of(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(below(static_cast<int>(choices.size())))];
  }

private:
  std::uint64_t state_;
};

/// Seven digits: what differs by rounding between two libraries of mathematics is the same text.
[[nodiscard]] std::string number(double value);
/// Rounded to three digits, so that sums of a few such lengths are exact in text.
[[nodiscard]] double neat(double value);
/// "[1.0, 2.5]"
[[nodiscard]] std::string pair(double x, double y);

} // namespace steplap::random
