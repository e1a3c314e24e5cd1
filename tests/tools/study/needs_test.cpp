// What a scene needs: the block on its deck, with things that matter and things that do not.
#include "tests/tools/study/block_scene.h"
#include "tests/tools/study/study_bench.h"

using namespace steplap;
using namespace steplap::testing;

// The joints of the paper's model stand in the file, to be monitored, but [[core]] makes them where they do not.
TEST_CASE("an element that a table puts in again has not been left out") {
  StudyBench bench;
  const Outcome outcome = study_does({"run", STEPLAP_MODELS "/studies/needs.toml", "-o", bench.at("study.sqlite")});
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  bool is_told = false;
  for (const study::Finding& f : study::Store(bench.at("study.sqlite")).findings())
    is_told = is_told || (f.subject == "without 'front joint'" && has(f.status, "puts it in again") && std::isnan(f.value));
  CHECK(is_told);
}

TEST_CASE("what changes nothing is ranked first, what changes much last, what cannot be said so") {
  StudyBench bench;
  // A spring of 1e-3 N/m beside friction of 2943 N: 1e-8 of the slid distance, or so.
  bench.write("block.toml", k_block + R"(
[[element]]
kind = "spring_damper"
name = "thread"
a = "block"
b = "deck"
axis = [1, 0]
stiffness = 1e-3
)");
  const Outcome outcome = bench.run("model = \"block.toml\"\nkind = \"needs\"\n" + k_slid);
  CAPTURE(outcome.err);
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  const study::Finding thread = bench.find("needs", "largest change", "without 'thread'");
  CHECK(thread.value < 1e-6);
  CHECK(has(thread.status, "may be"));
  CHECK(bench.find("needs", "largest change", "without 'guide'").value < 1e-6); // nothing tips: see block_scene.h
  // Nothing moves, or nothing slides: all of the response is gone.
  CHECK(bench.find("needs", "largest change", "without 'drive'").value == doctest::Approx(1.0).epsilon(1e-9));
  CHECK(bench.find("needs", "largest change", "'thread' rigid").value == doctest::Approx(1.0).epsilon(1e-9));
  CHECK(has(bench.find("needs", "largest change", "without 'foot'").status,
            "cannot be: impossible")); // friction refers to it
  CHECK(has(bench.find("needs", "largest change", "without 'deck friction'").status, "'slid' has no value then"));
}
