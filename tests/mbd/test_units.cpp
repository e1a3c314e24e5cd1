// Quantities with units: values, dimensions, and the traps (g, Hz, products without a space).
#include "mbd/io/units.h"

#include <doctest/doctest.h>

#include <cstring>
#include <numbers>

using steplap::parse_quantity;

namespace {

double value(const std::string& text, const std::string& unit) {
  const steplap::Quantity quantity = parse_quantity(text, unit);
  CAPTURE(text);
  CHECK(quantity.problem == "");
  return quantity.value;
}

std::string problem(const std::string& text, const std::string& unit) { return parse_quantity(text, unit).problem; }

} // namespace

TEST_CASE("quantities in SI") {
  CHECK(value("47 t", "kg") == 47000.0);
  CHECK(value("0.5 mm", "m") == doctest::Approx(5e-4).epsilon(1e-15));
  CHECK(value("1.1 km/h", "m/s") == doctest::Approx(1.1 / 3.6).epsilon(1e-15));
  CHECK(value("0.6 gravity", "m/s^2") == doctest::Approx(0.6 * 9.80665).epsilon(1e-15));
  CHECK(value("200 MN/m", "N/m") == 2e8);
  CHECK(value("10 deg", "rad") == doctest::Approx(std::numbers::pi / 18).epsilon(1e-15));
  CHECK(value("10 deg", "") == doctest::Approx(std::numbers::pi / 18).epsilon(1e-15));
  CHECK(value("3 kN m/rad", "N m") == 3000.0);
  CHECK(value("0.10 MPa", "Pa") == 1e5);
  CHECK(value("5 kg m2", "kg m^2") == 5.0);
  CHECK(value("-3e-3 m", "m") == -3e-3);
  CHECK(value("+3m", "m") == 3.0);
  CHECK(value(" 25 % ", "") == 0.25);
  CHECK(value("60 rpm", "rad/s") == doctest::Approx(2 * std::numbers::pi).epsilon(1e-14));
  CHECK(value("0.25", "") == 0.25);
}

TEST_CASE("units as people write them") {
  const std::pair<const char*, const char*> joined[] = {{"Nm", "N m"}, {"kNm", "kN m"}, {"MNm", "MN m"}, {"kNs", "kN s"}, {"Nms", "N m s"}};
  for (const auto& [spoken, spaced] : joined) CHECK(value(std::string("3 ") + spoken, "*") == value(std::string("3 ") + spaced, "*"));
  CHECK(value("2 kNs/m", "N s/m") == 2000.0);
  CHECK(value("5 kNm/rad", "N m") == 5000.0);
  CHECK(value("5 Nms/rad", "N m s") == 5.0);
  CHECK(value("1 rev", "rad") == doctest::Approx(2 * std::numbers::pi).epsilon(1e-15));
  CHECK(value("2 rev/s", "rad/s") == doctest::Approx(4 * std::numbers::pi).epsilon(1e-15));
  CHECK(value("60 rpm", "rad/s") == doctest::Approx(2 * std::numbers::pi).epsilon(1e-14));
  CHECK(value("10 mph", "m/s") == doctest::Approx(4.4704).epsilon(1e-15)); // a mile is 1609.344 m
  CHECK(problem("1 Nm", "kg") == "'1 Nm' has the unit 'Nm', but a unit like 'kg' is needed");
}

TEST_CASE("any unit goes to SI base units") {
  CHECK(value("-0.6 gravity", "*") == doctest::Approx(-0.6 * 9.80665).epsilon(1e-15));
  CHECK(value("98.1 kN", "*") == doctest::Approx(98100.0).epsilon(1e-15));
  CHECK(value("3.6 km/h", "*") == doctest::Approx(1.0).epsilon(1e-15));
  CHECK(value("180 deg", "*") == doctest::Approx(std::numbers::pi).epsilon(1e-15));
  CHECK(value("5", "*") == 5.0);
  CHECK(value("2 t", "*") == 2000.0);
}

TEST_CASE("turns and radians are told apart") {
  CHECK(value("50 Hz", "Hz") == 50.0);
  CHECK(value("3000 rpm", "Hz") == doctest::Approx(50.0).epsilon(1e-14));
  CHECK(value("10 rad/s", "Hz") == doctest::Approx(5 / std::numbers::pi).epsilon(1e-14));
  CHECK(problem("3 Hz", "rad/s") != "");
}

TEST_CASE("what is wrong is said") {
  CHECK(problem("47 m", "kg") == "'47 m' has the unit 'm', but a unit like 'kg' is needed");
  CHECK(problem("3 m", "") == "'3 m' has the unit 'm', but the value has no dimension");
  CHECK(problem("5 kgm/s", "kg m/s") == "'5 kgm/s' has the unknown unit 'kgm/s' (did you mean 'kg m/s'?)");
  CHECK(problem("5 parsnips", "m") == "'5 parsnips' has the unknown unit 'parsnips'");
  CHECK(problem("5 10 kg", "kg") == "'5 10 kg' has the unknown unit '10 kg'");
  CHECK(problem("5 s since 2000-01-01", "s") == "'5 s since 2000-01-01' has the unknown unit 's since 2000-01-01'");
  CHECK(problem("3 dBZ", "*") == "'3 dBZ' has the unknown unit 'dBZ'");
  CHECK(problem("nan m", "m") == "'nan m' is not finite");
  CHECK(problem("1e308 km", "m") == "'1e308 km' is not finite");
  CHECK(problem("", "m") == "'' is not a number with a unit, such as '0.5 m'");
}

// They stand in two places so that most files start without reading a database: to the bit.
TEST_CASE("the usual units are what the database makes of them") {
  REQUIRE(steplap::usual_units().size() > 10);
  for (const auto& [given, wanted] : steplap::usual_units())
    for (const char* number : {"1", "0.1", "47", "-3.7", "1e-300", "2.2250738585072014e-305", "123456789.12345678", "7e290"}) {
      CAPTURE(given);
      CAPTURE(number);
      const std::string text = std::string(number) + " " + given;
      const steplap::Quantity usual = parse_quantity(text, wanted), full = parse_quantity(text, wanted, steplap::UnitSource::database);
      CHECK(usual.problem.empty());
      CHECK(full.problem.empty());
      CHECK(std::memcmp(&usual.value, &full.value, sizeof(double)) == 0);
    }
  CHECK_FALSE(parse_quantity("2e308 km/h", "m/s").problem.empty());
  CHECK(parse_quantity("1e308 GN/m", "N/m").problem == parse_quantity("1e308 GN/m", "N/m", steplap::UnitSource::database).problem);
}
