#include "tests/random/random_number.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace steplap::random {

std::uint64_t RandomNumber::bits() {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

double RandomNumber::between(double low, double high) { return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1.0p-53; }

double RandomNumber::decades(double low, double high) { return std::pow(10.0, between(low, high)); }

int RandomNumber::below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value == 0.0 ? 0.0 : value);
  std::string result = text;
  // A number with a decimal point in TOML, so that it never reads as an integer.
  if (result.find_first_of(".e") == std::string::npos) result += ".0";
  return result;
}

double neat(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return std::strtod(text, nullptr);
}

std::string pair(double x, double y) { return "[" + number(x) + ", " + number(y) + "]"; }

} // namespace steplap::random
