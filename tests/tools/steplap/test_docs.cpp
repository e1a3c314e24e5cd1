// The reference of models is generated. Pages that are written by hand are typed and compared in tests/docs.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

TEST_CASE("docs/reference/models.md is what the program would write now") {
  // If not: steplap elements --markdown > docs/reference/models.md
  CHECK(text_of(STEPLAP_SOURCE "/docs/reference/models.md") == steplap_does({"elements", "--markdown"}).out);
}
