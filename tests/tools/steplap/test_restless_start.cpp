// steplap check tells of a model that begins at rest although its forces do not balance; a note, no error.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

namespace {

// 1000 kg between two springs; the lower one's preload bears the weight. `top`: preload of the upper one.
std::string between_springs(const std::string& bottom, const std::string& top, const std::string& more = "") {
  return "[simulation]\nend = 0.1\n" + more +
         "[[body]]\nname = \"block\"\nmass = 1000\ninertia = 100\n"
         "[[element]]\nkind = \"spring_damper\"\nname = \"below\"\na = \"block\"\nb = \"ground\"\naxis = [0, 1]\nstiffness = 1e6\npreload "
         "= " +
         bottom +
         "\n[[element]]\nkind = \"spring_damper\"\nname = \"above\"\na = \"block\"\nb = \"ground\"\naxis = [0, 1]\nstiffness = "
         "1e6\npreload = " +
         top + "\n";
}

bool is_noted(const std::string& text) {
  const Workbench bench;
  const Outcome outcome = steplap_does({"check", bench.write("a.toml", "title = \"a\"\n" + text)});
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
  return has(outcome.out, "note: At t = 0 'block' accelerates at ");
}

} // namespace

TEST_CASE("a preload at the top without its answer at the bottom is noted, with body, size and remedy") {
  const Workbench bench;
  // 5 kN on 1000 kg that nothing balances: 5 m/s².
  const Outcome outcome = steplap_does({"check", bench.write("a.toml", "title = \"a\"\n" + between_springs("9810", "-5000"))});
  CHECK(outcome.code == 0);
  CAPTURE(outcome.out);
  CHECK(has(outcome.out, "note: At t = 0 'block' accelerates at 5 m/s²: the springs on it do not balance its loads"));
  CHECK(has(outcome.out, "initial = \"equilibrium\""));
}

TEST_CASE("what is balanced, moves already, is driven or starts from equilibrium is not noted") {
  CHECK(is_noted(between_springs("0", "0")));
  CHECK_FALSE(is_noted(between_springs("14810", "-5000")));
  CHECK_FALSE(is_noted(between_springs("0", "0", "initial = \"equilibrium\"\n")));
  std::string moving = between_springs("0", "0");
  moving.insert(moving.find("inertia"), "velocity = [0, 0.1]\n");
  CHECK_FALSE(is_noted(moving));
}
