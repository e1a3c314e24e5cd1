// Numbers as people read them: few digits, none that is not known, and what they stand for is the value.
#include "mbd/run/shown_quantity.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

using namespace steplap;

namespace {

// What a text says: the number, the unit that its last digit stands for, both in SI, and how many digits it has.
struct Read {
  double value = 0.0;
  int digits = 0;
};

double factor_of(const std::string& text) {
  for (const auto& [prefix, factor] : {std::pair{"kN", 1e3}, {"MN", 1e6}, {"GN", 1e9}, {"mm", 1e-3}, {"µm", 1e-6}})
    if (text.find(std::string(" ") + prefix) != std::string::npos) return factor;
  return 1.0;
}

Read read(const std::string& text) {
  Read read;
  read.value = std::strtod(text.c_str(), nullptr) * factor_of(text);
  std::string digits;
  for (const char c : text.substr(0, text.find(' ')))
    if (c >= '0' && c <= '9') digits += c;
  digits.erase(0, digits.find_first_not_of('0'));
  if (text.find('.') == std::string::npos || text.find('.') > text.find(' ')) digits.erase(digits.find_last_not_of('0') + 1);
  read.digits = static_cast<int>(digits.size());
  return read;
}

} // namespace

TEST_CASE("values are shown with three or four digits and a prefix, never with an exponent") {
  CHECK(shown_quantity(274012.3, "N") == "274 kN");
  CHECK(shown_quantity(-127401.2, "N") == "-127.4 kN");
  CHECK(shown_quantity(7.913e-4, "m") == "0.791 mm");
  CHECK(shown_quantity(0.12194634028, "s") == "0.1219 s");
  CHECK(shown_quantity(2.0, "m") == "2 m");
  CHECK(shown_quantity(29.41995, "m/s^2") == "29.4 m/s²");
  CHECK(shown_quantity(1.32, "") == "1.32");
}

TEST_CASE("an error is shown only where it reaches a digit that is shown, or the limit") {
  CHECK(shown_quantity(274012.3, "N", {.error = 2.0}) == "274 kN");
  CHECK(shown_quantity(274012.3, "N", {.error = 2000.0}) == "274 kN ± 2 kN");
  CHECK(shown_quantity(274012.3, "N", {.error = 30000.0}) == "270 kN ± 30 kN");
  CHECK(shown_quantity(299999.0, "N", {.error = 2.0, .limit = 300000.0}) == "299.999 kN ± 0.002 kN");
  CHECK(shown_quantity(299999.0, "N", {.error = 0.2, .limit = 300000.0}) == "300 kN");
  CHECK(shown_quantity(274012.3, "N", {.error = std::nan("")}) == "274 kN ± unknown");
}

TEST_CASE("what is rounding of its scale is zero, without an error") {
  CHECK(shown_quantity(3e-12, "m", {.scale = 2.0}) == "0 m");
  CHECK(shown_quantity(1.555e-19, "rad", {.error = 1e-20, .scale = 1.0}) == "0 rad");
  CHECK(shown_quantity(0.0, "N", {.error = 0.0007, .scale = 1e5}) == "0 N");
}

TEST_CASE("values of a column have the prefix of its largest") {
  CHECK(shown_quantity(12.0, "N", {.column = 250000.0}) == "0.012 kN");
  CHECK(shown_quantity(-2.01561e-4, "m", {.column = 0.03}) == "-0.202 mm");
}

TEST_CASE("a share says whether the limit is passed") {
  CHECK(shown_share(0.79) == "79 %");
  CHECK(shown_share(0.9984) == "99.8 %");
  CHECK(shown_share(1.0003) == "100.03 %");
  CHECK(shown_share(1.0) == "100 %");
  CHECK(shown_share(19.84) == "1984 %");
  CHECK(shown_share(1000.0) == "> 1000 %"); // a margin of 0
  CHECK(shown_share(1000.0, 0.5) == "> 1000 %");
  CHECK(shown_share(0.99, 0.02) == "99 % ± 2 %");
}

TEST_CASE("random values: what is shown is the value, within half of its last digit, and no digit is shown that is not known") {
  std::mt19937 random(7); // any seed: the numbers are the test's own
  std::uniform_real_distribution<double> mantissa(1.0, 10.0), exponent(-6.0, 9.0), share(-6.0, 0.5);
  for (int i = 0; i < 20000; ++i) {
    const double value = mantissa(random) * std::pow(10.0, std::floor(exponent(random))) * (i % 2 == 0 ? 1.0 : -1.0);
    const double error = std::abs(value) * std::pow(10.0, share(random));
    const bool has_error = i % 3 != 0;
    const std::string unit = i % 5 == 0 ? "m" : "N";
    const std::string text = shown_quantity(value, unit, {.error = has_error ? std::optional(error) : std::nullopt});
    CAPTURE(value);
    CAPTURE(error);
    CAPTURE(text);
    CHECK(text.find("e-") == std::string::npos);
    CHECK(text.find("e+") == std::string::npos);
    const Read shown = read(text);
    CHECK(shown.digits <= 4);
    const bool has_shown_error = text.find("±") != std::string::npos;
    const std::size_t at = text.find("± ");
    const double shown_error = has_shown_error ? read(text.substr(at + std::string("± ").size())).value : 0.0;
    // Four digits of a leading 1, three of others: half of the last one is at most 0.05 % of the first, 0.25 % of the others.
    const double leading = std::abs(value) / std::pow(10.0, std::floor(std::log10(std::abs(value))));
    const double half_digit = 0.5 * (leading < 2.0 ? 1e-3 : 1e-2) * std::abs(value) / leading;
    if (!has_shown_error) {
      CHECK(std::abs(shown.value - value) <= half_digit * (1.0 + 1e-9)); // 1e-9: of the arithmetic of this test
      CHECK_FALSE((has_error && error > half_digit * (1.0 + 1e-9)));     // else it would have had to be told
    } else {
      CHECK(has_error);
      CHECK(shown_error >= error * (1.0 - 1e-9)); // never smaller than it is
      CHECK(std::abs(shown.value - value) <= shown_error * 0.5 * (1.0 + 1e-9) + 1e-9 * std::abs(value));
    }
  }
}
