// steplap check --cross: a second opinion on a model.
#include "tests/tools/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

TEST_CASE("check --cross runs a model by all methods and says that they agree") {
  const Outcome outcome = steplap_does({"check", "--cross", STEPLAP_MODELS "/benchmarks/block_on_incline.toml"});
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  for (const char* part : {"auto ", "dop853 1e-10", "tsit5 1e-10", "rodas5p 1e-08", "rk4 h = ", "moreau h = ", "own error", "block_on_incline: all agree"})
    CHECK_MESSAGE(has(outcome.out, part), part);
}

TEST_CASE("check --cross trusts nothing where no two runs end, and asks for a time that is one") {
  const std::string model = STEPLAP_MODELS "/paper/no_interference.toml";
  const Outcome hasty = steplap_does({"check", "--cross", "--cpu-limit", "1e-9", model});
  CHECK(hasty.code == 4);
  CHECK(has(hasty.out, "no_interference: NOT TO BE TRUSTED: there are no two opinions"));
  CHECK(has(hasty.err, "of CPU time"));
  CHECK(steplap_does({"check", "--cross", "--cpu-limit", "soon", model}).code == 2);
  CHECK(steplap_does({"check", "--cross", "nowhere.toml"}).code == 3);
}
