// steplap check names the elements whose reactions are not unique, and only those.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

namespace {

std::string check(const char* model) {
  const Outcome outcome = steplap_does({"check", std::string(STEPLAP_SOURCE) + "/models/benchmarks/hard/" + model});
  CHECK(outcome.code == 0);
  return outcome.out;
}

} // namespace

TEST_CASE("check: reactions that are not unique are warned of by name") {
  // Two feet that stick each for itself: either could take the whole load.
  const std::string feet = check("two_feet.toml");
  CHECK(has(feet, "while all friction sticks the reactions of 'rear friction' and 'front friction' "
                  "are not unique"));
  CHECK_FALSE(has(feet, "warning: the reactions of"));
  // Of three cranks one is too many: along the coupler any of them could hold.
  const std::string loop = check("redundant_loop.toml");
  CHECK(has(loop, "warning: the reactions of"));
  CHECK(has(loop, "'pin of second' (force_x, force_y)"));
  // Ten blocks apart share nothing.
  CHECK_FALSE(has(check("ten_at_once.toml"), "not unique"));
}
