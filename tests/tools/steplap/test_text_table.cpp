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
