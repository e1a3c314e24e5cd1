#include "mbd/run/measured_text.h"

#include <doctest/doctest.h>

#include <limits>

using namespace steplap;

namespace {
constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinite = std::numeric_limits<double>::infinity();
} // namespace

TEST_CASE("a value ends where its error begins, which has one digit, rounded up") {
  CHECK(measured_text(723123.4, 1.2, "N") == "723.123 kN ± 2 N");
  CHECK(measured_text(723123.4, 2.0, "N") == "723.123 kN ± 2 N"); // two is two
  CHECK(measured_text(723123.4, 25.0, "N") == "723.12 kN ± 30 N");
  CHECK(measured_text(723123.4, 950.0, "N") == "723 kN ± 1 kN"); // nine and a half are ten
  CHECK(measured_text(723123.4, 0.03, "N") == "723.12340 kN ± 0.03 N");
  CHECK(measured_text(-1.5e6, 400.0, "N m") == "-1.5000 MN m ± 400 N m");
  CHECK(measured_text(7.91365887e-4, 2.4e-9, "m") == "0.791366 mm ± 3 nm");
  CHECK(measured_text(-1.5449e-3, 2e-6, "rad") == "-1.545 mrad ± 2 µrad");
  CHECK(measured_text(3e-8, 1e-10, "m") == "0.0300 µm ± 1e-10 m");
  CHECK(measured_text(12.34567, 2e-3, "") == "12.346 ± 0.002");
  CHECK(measured_text(2.5e-3, 4e-9, "m^2") == "0.002500000 m^2 ± 4e-9");
  CHECK(measured_text(999.9996e3, 1.0, "N") == "1000.000 kN ± 1 N");
}

TEST_CASE("an error as large as its value leaves a round number, or zero") {
  CHECK(measured_text(3.0, 20.0, "N") == "0 N ± 20 N");
  CHECK(measured_text(-3.0, 20.0, "N") == "0 N ± 20 N"); // no minus before a zero
  CHECK(measured_text(13.0, 20.0, "N") == "10 N ± 20 N");
  CHECK(measured_text(1234.0, 2e6, "N") == "0 N ± 2 MN");
  CHECK(measured_text(3e-7, 5e-4, "m") == "0 m ± 500 µm");
  CHECK(measured_text(0.0, 2e-3, "N") == "0 N ± 0.002 N");
  CHECK(measured_text(1.0, 1.0, "N") == "1 N ± 1 N");
}

TEST_CASE("exact, unknown, none, no number") {
  CHECK(measured_text(0.0, 0.0, "m") == "0 m ± 0");
  CHECK(measured_text(-0.0, 0.0, "N") == "0 N ± 0");
  CHECK(measured_text(9810.0, 0.0, "N") == "9.81 kN ± 0");
  CHECK(measured_text(2.0, 0.0, "") == "2 ± 0");
  CHECK(measured_text(723123.4, k_unknown, "N") == "723 kN ± unknown");
  CHECK(measured_text(0.0123456, k_unknown, "m") == "12.3 mm ± unknown");
  CHECK(measured_text(0.0, k_unknown, "N") == "0 N ± unknown");
  CHECK(measured_text(723123.4, k_infinite, "N") == "723 kN ± unknown");
  CHECK(measured_text(723123.4, std::nullopt, "N") == "723.123 kN");
  CHECK(measured_text(k_unknown, 1.0, "N") == "–");
  CHECK(measured_text(k_infinite, 1.0, "") == "∞");
  CHECK(measured_text(-k_infinite, std::nullopt, "") == "-∞");
}

TEST_CASE("no more digits than a double is good for: the error that is then stated covers those left out") {
  CHECK(measured_text(1.0 / 3.0, 1e-17, "") == "0.333333333333 ± 1e-12");
  CHECK(measured_text(1e-300, 1e-302, "N").find("± 1e-302 N") != std::string::npos);
}

TEST_CASE("instants") {
  CHECK(measured_time_text(0.0851426519, 3e-9) == "0.085142652 s ± 3e-9");
  CHECK(measured_time_text(0.0851426519, 2.5e-4) == "0.0851 s ± 0.0003");
  CHECK(measured_time_text(0.0851426519, k_unknown) == "0.0851 s ± unknown");
  CHECK(measured_time_text(0.0851426519, std::nullopt) == "0.085143 s");
  CHECK(measured_time_text(3600.0, 2e-6) == "3600.000000 s ± 2e-6");
}
