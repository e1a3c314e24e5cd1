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
  CHECK(value("60 1/min", "Hz") == doctest::Approx(1.0).epsilon(1e-15));
  CHECK(value("2 1/s", "rad/s") == 2.0); // as formulas of SI values give it
  CHECK(problem("60 1/min", "rad/s") == problem("60 Hz", "rad/s").replace(4, 2, "1/min"));
  CHECK(problem("60 1/min^2", "rad/s^2").find("is a frequency") != std::string::npos);
}

// UDUNITS reads each of these as a quantity: "300'000 N" as 300 arcminutes, "N/m^1.5" as 5 N/m, "kg 500" as 500 kg.
TEST_CASE("a quantity is one number and a product of powers of units") {
  const auto says = [](const std::string& text, const std::string& part) {
    CAPTURE(text);
    for (const auto source : {steplap::UnitSource::usual_first, steplap::UnitSource::database})
      for (const char* unit : {"*", "", "N", "kg", "m", "rad"}) {
        const std::string found = parse_quantity(text, unit, source).problem;
        CHECK_MESSAGE(found.find(part) != std::string::npos, found);
      }
    CHECK_FALSE(steplap::powers_in(text));
  };
  for (const char* separated : {"300'000 N", "47'000 kg", "300\u2019000 N", "300_000 N", "300\u00a0000 N", "300\u202f000 N"})
    says(separated, "separates the digits of its number");
  for (const char* two : {"300 000 N", "1 kg 500", "5 m/s 2", "5 10 kg", "12 ft 3 in", "1/2 m", "5 s since 2000-01-01", "5 m 1"})
    says(two, "has another number in its unit");
  for (const char* broken : {"1e9 N/m^1.5", "2 m^0.5", "2 m^.5", "2 m^1/2", "2 m^(1/2)", "2 m^0", "2 m^12", "2 s^-1.5", "2 m^"})
    says(broken, "has a power in its unit");
  says("30\u00b015'", "has a number after \u00b0");
  for (const char* arc : {"30' ", "30\"", "30\u2032", "30\u00b0'"}) says(arc, "has the sign ");
  for (const char* ton : {"40 ton", "40 tons", "40 kton", "3 ton m2"}) says(ton, "write 't' for 1000 kg, or 'short_ton' for 907 kg");
  for (const char* speed : {"40 kmph", "40 kph", "40 kmh"}) says(speed, "write 'km/h'");
  says("3 e5", "as in '3e5 N'");

  CHECK(value("5 kN/(m s)", "N/m/s") == 5000.0);
  for (const char* newton_metre : {"2 N m", "2 N*m", "2 N\u00b7m", "2 N.m", "2 N-m", "2 N / m-1"}) CHECK(value(newton_metre, "N m") == 2.0);
  for (const char* area : {"2 m2", "2 m^2", "2 m**2", "2 m\u00b2", "2 m3/m", "2 1/m-2"}) CHECK(value(area, "m^2") == 2.0);
  CHECK(value("3 s-1", "Hz") == 3.0);
  CHECK(value("3 s^-1", "Hz") == 3.0);
  CHECK(value("30\u00b0", "rad") == doctest::Approx(std::numbers::pi / 6).epsilon(1e-15));
  CHECK(value("5 \u00b5m", "m") == doctest::Approx(5e-6).epsilon(1e-15));
  CHECK(value("20 \u00b0C", "K") == doctest::Approx(293.15).epsilon(1e-15));
  CHECK(value("1 cmH2O", "Pa") == doctest::Approx(98.0665).epsilon(1e-15));
  CHECK(value("2 short_ton", "kg") == doctest::Approx(2 * 2000 * 0.45359237).epsilon(1e-15));
  CHECK(value("2 metric_ton", "kg") == 2000.0);
  CHECK(value("2 kilonewton", "N") == 2000.0);
}

TEST_CASE("what is wrong is said") {
  CHECK(problem("47 m", "kg") == "'47 m' has the unit 'm', but a unit like 'kg' is needed");
  CHECK(problem("3 m", "") == "'3 m' has the unit 'm', but the value has no dimension");
  CHECK(problem("5 kgm/s", "kg m/s") == "'5 kgm/s' has the unknown unit 'kgm/s' (did you mean 'kg m/s'?)");
  CHECK(problem("5 parsnips", "m") == "'5 parsnips' has the unknown unit 'parsnips'");
  CHECK(problem("5 s@3", "s") == "'5 s@3' has the unknown unit 's@3'");
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
