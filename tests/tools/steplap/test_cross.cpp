// steplap check --cross: a second opinion on a model.
#include "mbd/simulation/simulation.h"
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

TEST_CASE("check --cross runs a model by all methods and says that they agree") {
  const Outcome outcome = steplap_does({"check", "--cross", STEPLAP_MODELS "/benchmarks/block_on_incline.toml"});
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  for (const char* part :
       {"auto ", "dop853 1e-10", "tsit5 1e-10", "rodas5p 1e-08", "rk4 h = ", "moreau h = ", "own error", "block_on_incline: all agree"})
    CHECK_MESSAGE(has(outcome.out, part), part);
}

// Time stepping misses a bound of friction by its own error: five other methods agree with each other and with it.
TEST_CASE("check --cross takes what smaller steps make smaller for the error of the steps") {
  const Outcome outcome = steplap_does({"check", "--cross", STEPLAP_MODELS "/machines/stacked_blocks.toml"});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "stacked_blocks: all agree"));
}

// No limit ends what comes before the first look at the clock: models are read, and each method makes a step, which takes seconds
// where code is slow. A run that may take no time tells how long all that lasts here.
TEST_CASE("the CPU time of check --cross is that of the whole command, however many runs there are") {
  const auto seconds_within = [](const std::string& limit) {
    const double start = steplap::thread_cpu_seconds();
    const Outcome outcome = steplap_does(
        {"check", "--cross", "--cpu-limit", limit, STEPLAP_MODELS "/machines/pile.toml", STEPLAP_MODELS "/machines/brick_wall.toml"});
    CHECK(outcome.code == 4);
    return steplap::thread_cpu_seconds() - start;
  };
  const double besides = seconds_within("1e-9");
  CHECK(seconds_within("1") - besides < 2.0); // steps are not cut short; each of some ten runs alone could take the second
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

// A formula with two switches of one quantity that starts exactly at zero stops all methods that choose their steps.
TEST_CASE("check --cross does not trust a minority of methods that reach the end") {
  const Workbench bench;
  const std::string model =
      bench.write("kink.toml", "format = 1\ngravity = [0.0, 0.0]\n[simulation]\nend = 1.0\n[[body]]\nname = 'a'\nmass = 2.0\n"
                               "inertia = 1.0\nvelocity = [1.0, 0.0]\n[[element]]\nkind = 'force'\nname = 'f'\na = 'a'\n"
                               "coordinate = 'x'\nformula = \"-'3 N/m'*(value>'0 m' ? 1 : -1)*abs(value)\"\n");
  const Outcome outcome = steplap_does({"check", "--cross", model});
  CHECK(outcome.code == 4);
  CHECK(has(outcome.out, "kink: NOT TO BE TRUSTED: only 2 of 6 methods reach the end"));
}
