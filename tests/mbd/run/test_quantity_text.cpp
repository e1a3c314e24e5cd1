#include "mbd/run/quantity_text.h"

#include <doctest/doctest.h>

using namespace steplap;

TEST_CASE("quantities get a prefix that suits") {
  CHECK(quantity_text(259822.17, "N") == "259.822 kN");
  CHECK(quantity_text(-1.5e6, "N m") == "-1.5 MN m");
  CHECK(quantity_text(7.91365887e-4, "m") == "0.791366 mm");
  CHECK(quantity_text(-1.5449e-3, "rad") == "-1.5449 mrad");
  CHECK(quantity_text(3e-8, "m") == "0.03 µm");
  CHECK(quantity_text(0.0, "m") == "0 m");
  CHECK(quantity_text(-0.0, "N") == "0 N");
  CHECK(quantity_text(12.5, "") == "12.5");
  CHECK(quantity_text(3e-6, "N", 1e5) == "0 N");
  CHECK(quantity_text(3.0, "N", 1e5) == "3 N");
  CHECK(time_text(0.0851426519) == "0.085143");
  CHECK(small_text(2.04e-7) == "2e-07");
}
