#include "run/quantity_text.h"
#include "tools/steplap/text_table.h"

#include <doctest/doctest.h>

#include <sstream>

using namespace steplap;

TEST_CASE("columns are as wide as their widest cell, counted in characters") {
  TextTable table({TextTable::Align::left, TextTable::Align::right}, 1);
  CHECK(table.is_empty());
  table.add_row({"µm", "1"});
  table.add_row({"long", "22"});
  table.add_row({"x"});
  std::ostringstream text;
  text << table;
  CHECK(text.str() == " µm     1\n long  22\n x\n");
}

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
