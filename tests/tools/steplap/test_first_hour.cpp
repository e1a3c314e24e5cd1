// What a machine described for the first time is told: a pin that lies elsewhere than meant, a machine that rests, what is free,
// what tips.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

namespace {

std::string pendulum(const std::string& b) {
  return "title = \"a\"\n[simulation]\nend = 0.1\n[[body]]\nname = \"arm\"\nmass = 2\ninertia = 0.2\nposition = [1.0, 2.0]\n"
         "[[element]]\nkind = \"revolute\"\nname = \"pin\"\na = { body = \"arm\", at = [0.5, 2.0] }\n" +
         b;
}

std::string ball(int i) {
  const std::string n = std::to_string(i);
  return "[[body]]\nname = \"ball " + n + "\"\nmass = 1\ninertia = 0.01\nposition = [" + n +
         ", 0]\n[[element]]\nkind = \"distance\"\nname = \"rod " + n + "\"\na = \"ball " + n + "\"\nb = { body = \"ground\", at = [" + n +
         ", 1] }\n";
}

std::string told(const char* command, const std::string& text) {
  const Workbench bench;
  const Outcome outcome = steplap_does({command, bench.write("a.toml", text)});
  return outcome.out + outcome.err;
}

} // namespace

TEST_CASE("a pin whose 'b' names no place is told, with the place that it would have to have") {
  const std::string text = told("check", pendulum(""));
  CAPTURE(text);
  CHECK(has(text, "warning: revolute 'pin' pins 'arm' to the ground's origin"));
  CHECK(has(text, "a.toml:9)"));
  CHECK(has(text, "2.06155 m from there")); // of (0.5, 2)
  CHECK(has(text, "b = { body = \"ground\", at = [0.5, 2] }"));
  CHECK_FALSE(has(told("check", pendulum("b = { body = \"ground\", at = [0.5, 2.0] }\n")), "origin"));
}

TEST_CASE("several bodies that are free alike are told in one sentence, a single one by itself") {
  const std::string title = "title = \"a\"\n[simulation]\nend = 0.1\n";
  const std::string three = told("equilibrium", title + ball(1) + ball(2) + ball(3));
  CAPTURE(three);
  CHECK(has(three, "indifferent: nothing holds 'ball 1', 'ball 2' and 'ball 3' from turning, either way; they rest wherever they are"));
  CHECK(three.find("indifferent") == three.rfind("indifferent"));
  CHECK(has(told("equilibrium", title + ball(1)), "indifferent: nothing holds 'ball 1' turning"));
  std::string many = title;
  for (int i = 1; i <= 9; ++i) many += ball(i);
  CHECK(has(told("equilibrium", many), "'ball 4', 'ball 5' and 4 others from turning"));
}

// Its errors would be shares of ranges that are rounding themselves.
TEST_CASE("a machine that rests is said to rest, not to be wrong by many times the tolerance") {
  const std::string block =
      "title = \"a\"\n[simulation]\nend = 0.5\ninitial = \"equilibrium\"\n[[body]]\nname = \"block\"\nmass = 2000\ninertia = 500\n"
      "position = [0, 1]\noutline = [[-1, -1], [1, -1], [1, 1], [-1, 1]]\n[[element]]\nkind = \"polygon_contact\"\nname = \"floor\"\n"
      "a = \"block\"\nstiffness = 1e9\nstatic_friction = 0.5\n";
  const Workbench bench;
  const std::string path = bench.write("a.toml", block);
  const Outcome rests = steplap_does({"simulate", "-v", path, "-o", bench.at("out"), "--estimate-error"});
  CAPTURE(rests.out);
  CHECK(rests.code == 0);
  CHECK(has(rests.out, "The machine rests"));
  CHECK(has(rests.out, "nothing is exchanged"));
  CHECK_FALSE(has(rests.out, "times the tolerance"));
  const Outcome moves =
      steplap_does({"simulate", path, "-o", bench.at("moves"), "--estimate-error", "--set", "simulation.velocity=[1.0, 0.0]"});
  CAPTURE(moves.out);
  CHECK_FALSE(has(moves.out, "The machine rests"));
}

TEST_CASE("the table at rest has the angle at which a block tips") {
  const std::string text = told(
      "equilibrium", "title = \"a\"\n[simulation]\nend = 0.5\n[[body]]\nname = \"block\"\nmass = 2000\ninertia = 500\n"
                     "position = [0, 1]\noutline = [[-0.5, -1], [0.5, -1], [0.5, 1], [-0.5, 1]]\n[[element]]\nkind = \"polygon_contact\"\n"
                     "name = \"floor\"\na = \"block\"\nstiffness = 1e12\nstatic_friction = 0.5\n");
  CAPTURE(text);
  CHECK(has(text, "Distance from tipping over"));
  CHECK(has(text, "26.6°")); // atan 0.5
  CHECK(has(text, "4.905")); // g/2
}

// 48 kN of friction under a billionth of a newton: the margin is a number of no meaning, and of 14 digits.
TEST_CASE("a joint that carries nothing has a margin beyond 1e9, not a number of many digits, nor inf") {
  const Workbench bench;
  for (const std::string pull : {"\"1e-9 N\"", "0.0"}) {
    const Outcome outcome =
        steplap_does({"simulate", "-v", STEPLAP_MODELS "/layouts/joint_apart.toml", "-o", bench.at(pull == "0.0" ? "a" : "b"), "--set",
                      "simulation.end=0.01", "--set", "element.pull.force=[" + pull + ", 0.0]"});
    CAPTURE(outcome.out);
    CAPTURE(outcome.err);
    CHECK(has(outcome.out, pull == "0.0" ? "–" : "> 1e9")); // under no load at all there is none
    CHECK_FALSE(has(outcome.out, "inf"));
  }
}

TEST_CASE("runs side by side tell of the channels that the model asks for, too") {
  const Workbench bench;
  const auto model = [&](const char* name, const char* speed) {
    return bench.write(
        name,
        std::string("title = \"a\"\ngravity = [0.0, 0.0]\n[simulation]\nend = 0.1\n[output]\nstep = 0.01\nalso = [\"rail.displacement\"]\n"
                    "[[body]]\nname = \"sledge\"\nmass = 2\ninertia = 1\nvelocity = [") +
            speed +
            ", 0.0]\n"
            "[[element]]\nkind = \"prismatic\"\nname = \"rail\"\na = \"sledge\"\n");
  };
  const Outcome two = steplap_does({"simulate", "-v", model("slow.toml", "1.0"), model("fast.toml", "3.0"), "-o", bench.at("out")});
  CAPTURE(two.out);
  CAPTURE(two.err);
  const std::size_t table = two.out.find("Channels on request, extremes of the whole run (their times: summary.json)");
  REQUIRE(table != std::string::npos);
  const std::string row = two.out.substr(two.out.find("rail.displacement", table), 120);
  CHECK(has(row, "0.1000000 m")); // 1 m/s for 0.1 s
  CHECK(has(row, "0.3000000 m"));
}

TEST_CASE("what is written in other words for a load is told by the words to write") {
  const std::string bar = "title = \"a\"\n[simulation]\nend = 0.1\n[[body]]\nname = \"bar\"\nmass = 1\ninertia = 1\n"
                          "[[element]]\nkind = \"load\"\nname = \"push\"\n";
  const std::string text = told("check", bar + "a = \"bar\"\nfx = 5\nfy = 1\n");
  CAPTURE(text);
  CHECK(has(text, "unknown key 'a' in load 'push' (did you mean 'at'?)"));
  CHECK(has(text, "unknown key 'fx' in load 'push' (did you mean 'force_x'?)")); // 'at' has no letter of it
  CHECK(has(text, "unknown key 'fy' in load 'push' (did you mean 'force_y'?)"));
  CHECK(has(told("check", bar + "at = \"bar\"\nforce_x = 5\n"), "(a constant value is a signal of kind 'constant'), got an integer"));
  CHECK(has(told("check", bar + "at = \"bar\"\nmu = 5\n"), "unknown key 'mu' in load 'push'; known are ")); // nothing is like it
}

// A box of 2 m by 2 m, turned by 45 degrees: its corner is sqrt 2 below its centre of gravity, and that is where it touches.
TEST_CASE("the place of a contact of outlines is where they touch") {
  const auto box = [](const std::string& pose) {
    return told("check", "title = \"a\"\n[simulation]\nend = 0.1\n[[body]]\nname = \"box\"\nmass = 2000\ninertia = 500\n" + pose +
                             "outline = [[-1, -1], [1, -1], [1, 1], [-1, 1]]\n[[element]]\nkind = \"polygon_contact\"\nname = \"floor\"\n"
                             "a = \"box\"\nstiffness = 1e9\n");
  };
  const std::string standing = box("position = [3, 0.99]\n"), on_edge = box("position = [3, 1.42]\nangle = \"45 deg\"\n");
  CHECK_MESSAGE(has(standing, "  3 m  0 m\n"), standing); // the middle of the face, on the floor
  CHECK_MESSAGE(has(on_edge, "  3 m  0 m\n"), on_edge);   // below the corner
}
