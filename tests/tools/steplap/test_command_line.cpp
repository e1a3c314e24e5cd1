// Usage, help, exit codes, and the commands that run nothing.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

TEST_CASE("help names every command, the exit codes and examples") {
  const Outcome help = steplap_does({"--help"});
  CHECK(help.code == 0);
  CHECK(help.err.empty());
  for (const char* part : {"Exit codes:", "Examples:"}) CHECK(has(help.out, part));
  for (const char* command : {"simulate", "report", "plot", "check", "equilibrium", "modes", "joint", "accuracy", "elements", "schema"}) {
    CHECK(has(help.out, command));
    CHECK(has(text_of(STEPLAP_SOURCE "/docs/reference/command_line.md"), std::string("`") + command + "`"));
    const Outcome own = steplap_does({command, "--help"});
    CAPTURE(command);
    CHECK(own.code == 0);
    CHECK(has(own.out, std::string("  steplap ") + command));
  }
  CHECK(has(steplap_does({"simulate", "--help"}).out, "--integrator"));
}

TEST_CASE("the version is said") {
  const Outcome version = steplap_does({"--version"});
  CHECK(version.code == 0);
  CHECK(version.out.rfind("steplap ", 0) == 0);
}

TEST_CASE("wrong usage is exit code 2 and one line") {
  CHECK(steplap_does({}).code == 2);
  const Outcome unknown = steplap_does({"simlate", "x.toml"});
  CHECK(unknown.code == 2);
  CHECK(unknown.err == "steplap: error: there is no command 'simlate' (did you mean 'simulate'?); "
                       "see steplap --help\n");
  CHECK(steplap_does({""}).err == "steplap: error: there is no command ''; see steplap --help\n");
  const Outcome option = steplap_does({"check", "--sideways", "x.toml"});
  CHECK(option.code == 2);
  CHECK(has(option.err, "--sideways"));
  CHECK(has(option.err, "see steplap check --help"));
  const Outcome nothing = steplap_does({"simulate"});
  CHECK(nothing.code == 2);
  CHECK(has(nothing.err, "MODEL"));
  CHECK(steplap_does({"simulate", "x.toml", "-q", "-v"}).code == 2);
  for (const std::vector<std::string>& threads :
       {std::vector<std::string>{"--threads", "4"}, {"--threads=4"}}) { // an option of earlier days
    std::vector<std::string> arguments{"simulate", "x.toml"};
    arguments.insert(arguments.end(), threads.begin(), threads.end());
    const Outcome retired = steplap_does(arguments);
    CHECK(retired.code == 2);
    CHECK(retired.err == "steplap: error: a run takes one thread: leave --threads out. Many runs side by side take all processors: "
                         "steplap study, steplap assess\n");
  }
}

TEST_CASE("errors of a model are exit code 3, all of them, with their places") {
  const Workbench bench;
  const std::string first = bench.write("a.toml", std::string(k_oscillator) + "stifness = 3\n");
  const std::string second = bench.write("b.toml", "[simulation]\nstep = 1e-3\n");
  for (const char* command : {"check", "simulate"}) {
    const Outcome outcome = steplap_does({command, first, second, bench.at("none.toml")});
    CHECK(outcome.code == 3);
    CHECK(outcome.out.empty());
    CHECK(has(outcome.err, "a.toml:24:1: error: unknown key 'stifness' in spring_damper 'spring'"));
    CHECK(has(outcome.err, "b.toml"));
    CHECK(has(outcome.err, "the model has no body"));
    CHECK(has(outcome.err, "cannot read '" + bench.at("none.toml") + "'"));
  }
  CHECK_FALSE(fs::exists("out/a"));
}

TEST_CASE("check counts what is in a model and warns") {
  const Workbench bench;
  const Outcome outcome = steplap_does({"check", bench.write("a.toml", k_oscillator)});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "a.toml: fine"));
  CHECK(has(outcome.out, "a mass on a spring"));
  CHECK(has(outcome.out, "degrees of freedom  3\n"));
  CHECK(has(outcome.out, "1 spring_damper"));
  CHECK(has(outcome.out, "warning: signal 'spare' is used by nothing ("));
  CHECK(has(outcome.out, "a.toml:8)"));
  CHECK(steplap_does({"check", "-q", bench.at("a.toml")}).out.empty());
}

TEST_CASE("check counts the paper's degrees of freedom") {
  const Outcome outcome = steplap_does({"check", STEPLAP_MODELS "/paper/no_interference.toml"});
  CHECK(outcome.code == 0);
  // 15 coordinates; the tank joint takes 2, the vehicle's motion 1; friction 1, two joints 3 each
  CHECK(has(outcome.out, "coordinates         15\n"));
  CHECK(has(outcome.out, "degrees of freedom  12; 5 while all friction sticks\n"));
  CHECK_FALSE(has(outcome.out, "warning"));
}

TEST_CASE("a signal that only a file above it offers is no mistake of a model") {
  const Workbench bench;
  const std::string base = bench.write("base.toml", k_oscillator);
  CHECK(has(steplap_does({"check", base}).out, "used by nothing"));
  CHECK_FALSE(has(steplap_does({"check", bench.write("own.toml", "extends = \"base.toml\"\n")}).out, "used by nothing"));
  const std::string own =
      bench.write("more.toml", "extends = \"base.toml\"\n[[signal]]\nname = \"mine\"\nkind = \"constant\"\nvalue = 1\n");
  CHECK(has(steplap_does({"check", own}).out, "signal 'mine' is used by nothing"));
  for (const char* model : {"three_limb", "five_limb_humping", "single_phase_two_limb_bump", "rail_wagon_humping"})
    CHECK_FALSE(has(steplap_does({"check", STEPLAP_MODELS "/layouts/" + std::string(model) + ".toml"}).out, "warning"));
}

TEST_CASE("a model without a command, and an option that is misspelt, are told by what was meant") {
  CHECK(has(steplap_does({"my.toml"}).err, "to run this model: steplap simulate my.toml"));
  CHECK(has(steplap_does({"simulate", "my.toml", "--reprot"}).err, "(did you mean '--report'?)"));
  CHECK(has(steplap_does({"simulat", "my.toml"}).err, "there is no command 'simulat' (did you mean 'simulate'?)"));
}

TEST_CASE("the model in the README is one") {
  const Workbench bench;
  const std::string readme = text_of(STEPLAP_SOURCE "/README.md"), fence = "```toml\n";
  const std::size_t begin = readme.find(fence);
  REQUIRE(begin != std::string::npos);
  const std::size_t from = begin + fence.size();
  const std::string model = bench.write("readme.toml", readme.substr(from, readme.find("```", from) - from));
  const Outcome outcome = steplap_does({"check", model});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "degrees of freedom  3; 2 while all friction sticks\n"));
  CHECK_FALSE(has(outcome.out, "warning"));
}

TEST_CASE("the reference of the command line names every exit code") {
  const std::string page = text_of(STEPLAP_SOURCE "/docs/reference/command_line.md");
  const std::string help = steplap_does({"--help"}).out;
  for (int code = 0; code <= 5; ++code) {
    CHECK(has(page, "| " + std::to_string(code) + " | "));
    CHECK(has(help, "\n  " + std::to_string(code) + "  "));
  }
}

TEST_CASE("check names joints that hold what others hold already") {
  const Workbench bench;
  std::string text = k_oscillator;
  for (const char* name : {"weld one", "weld two"})
    text += std::string("[[element]]\nname = \"") + name + "\"\nkind = \"weld\"\na = \"mass\"\nb = \"ground\"\n";
  const Outcome outcome = steplap_does({"check", bench.write("a.toml", text)});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "6, only 3 of them independent"));
  CHECK(has(outcome.out, "'weld "));
  CHECK(has(outcome.out, "degrees of freedom  0\n"));
}

TEST_CASE("a foot that presses beyond the edge of what it stands on is told") {
  const Workbench bench;
  const auto text = [](const char* x) {
    return std::string("[simulation]\nend = 0.01\nstep = 1e-3\n[[body]]\nname = \"shelf\"\nmass = 1.0\ninertia = 1.0\n"
                       "fixed = true\noutline = [[-1.0, -0.1], [1.0, -0.1], [1.0, 0.0], [-1.0, 0.0]]\n"
                       "[[body]]\nname = \"cup\"\nmass = 1.0\ninertia = 1.0\nposition = [") +
           x +
           ", 0.1]\n[[element]]\nkind = \"unilateral_contact\"\nname = \"foot\"\na = { body = \"cup\", point = [0.0, -0.1] }\n"
           "b = { body = \"shelf\", point = [0.0, 0.0] }\nstiffness = 1e4\ndamping = 100.0\npreload = 9.81\n";
  };
  const std::string on = bench.write("on.toml", text("0.9")), off = bench.write("off.toml", text("1.25"));
  for (const char* command : {"simulate", "equilibrium"}) {
    CAPTURE(std::string(command));
    const auto outcome = [&](const std::string& model) {
      return std::string(command) == "simulate" ? steplap_does({"simulate", model, "-o", bench.at("out"), "--force"})
                                                : steplap_does({"equilibrium", model});
    };
    CHECK(has(outcome(off).err, "'foot' presses 0.25 m beyond the edge of 'shelf'"));
    CHECK_FALSE(has(outcome(on).err, "beyond the edge"));
  }
}

// A weight of 981 N on ties of 500 N, at the start of a run that an action would change.
TEST_CASE("equilibrium names ties that would break and actions whose condition is met") {
  const Workbench bench;
  const auto said = [&](const char* strength, const char* when) {
    return steplap_does(
               {"equilibrium",
                bench.write("hanging.toml", std::string("[[body]]\nname = \"load\"\nmass = 100.0\ninertia = 1.0\n"
                                                        "[[element]]\nkind = \"tie\"\nname = \"sling\"\na = \"load\"\n"
                                                        "b = { body = \"ground\", at = [0.0, 1.0] }\nstiffness = 1e6\nstrength = ") +
                                                strength + "\n[[action]]\nname = \"let go\"\nwhen = \"" + when +
                                                "\"\ndo = [\"release sling\"]\n")})
        .out;
  };
  const std::string breaks = said("500.0", "load.y < '-1 m'"), acts = said("2000.0", "0 s");
  CHECK(has(breaks, "'sling' breaks: it would have to carry 196.2 % of its strength"));
  CHECK_FALSE(has(breaks, "'let go'"));
  CHECK(has(acts, "the condition of action 'let go' is met here"));
  CHECK_FALSE(has(acts, "breaks"));
}

// ½ m v² = 50 J against ½ k w d² = 10 J for the whole thickness of 0.1 m.
TEST_CASE("a contact that is pressed through a part is told, with its line and the time") {
  const Workbench bench;
  const auto text = [](const char* stiffness) {
    return std::string("gravity = [0.0, 0.0]\n[simulation]\nend = 0.05\ntolerance = 1e-6\nintegrator = \"dop853\"\n[[body]]\nname = "
                       "\"plate\"\nmass = 1.0\n"
                       "inertia = 1.0\nfixed = true\noutline = [[-1.0, -0.1], [1.0, -0.1], [1.0, 0.0], [-1.0, 0.0]]\n"
                       "[[body]]\nname = \"box\"\nmass = 1.0\ninertia = 1.0\nposition = [0.0, 0.3]\nvelocity = [0.0, -10.0]\n"
                       "outline = [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]]\n"
                       "[[element]]\nkind = \"polygon_contact\"\nname = \"blow\"\na = \"box\"\nb = \"plate\"\nstiffness = ") +
           stiffness + "\n";
  };
  const auto told = [&](const char* stiffness) {
    return steplap_does({"simulate", bench.write("a.toml", text(stiffness)), "-o", bench.at("out"), "--force"}).err;
  };
  CHECK(has(told("1e4"), "'blow' was pressed"));
  CHECK(has(told("1e4"), "a.toml:19)"));
  CHECK(has(told("1e4"), "beyond 50 mm one part is through the other"));
  CHECK(has(text_of(bench.at("out/a/summary.json")), "one part is through the other, and what came after is not to be trusted"));
  CHECK_FALSE(has(told("1e6"), "through the other"));
}

TEST_CASE("equilibrium gives the pose of rest and what holds it") {
  const Workbench bench;
  std::string text = k_oscillator;
  text.replace(text.find("gravity = [0, 0]"), 16, "gravity = [8, 0]");
  text += R"([[element]]
name = "rail"
kind = "prismatic"
a = "mass"
b = "ground"
axis = [1, 0]
)";
  const Outcome outcome = steplap_does({"equilibrium", bench.write("a.toml", text)});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "a: in stable equilibrium"));
  CHECK(has(outcome.out, "20 mm")); // 2 kg · 8 m/s² / 800 N/m
  CHECK(has(outcome.out, "-16 N"));
  const Outcome none = steplap_does({"equilibrium", bench.write("b.toml", k_falling)});
  CHECK(none.code == 4);
  CHECK(has(none.err, "no static equilibrium: 'stone'"));
}

TEST_CASE("the paper's transformer is given in its pose of rest") {
  for (const char* name : {"no_interference", "interference"}) {
    const Outcome outcome = steplap_does({"equilibrium", STEPLAP_MODELS "/paper/" + std::string(name) + ".toml"});
    CHECK(outcome.code == 0);
    CHECK(has(outcome.out, "moved at most 0 m\n"));
    CHECK(outcome.err.empty());
  }
}

TEST_CASE("elements is the reference of a kind") {
  const Outcome all = steplap_does({"elements"});
  CHECK(all.code == 0);
  CHECK(has(all.out, "spring_damper"));
  CHECK(has(all.out, "haversine"));
  const Outcome one = steplap_does({"elements", "unilateral_contact"});
  CHECK(one.code == 0);
  CHECK(has(one.out, "stiffness"));
  CHECK(has(steplap_does({"elements", "simulation"}).out, "integrator"));
  CHECK(has(steplap_does({"elements", "--markdown"}).out, "step_lap_joint"));
  const Outcome wrong = steplap_does({"elements", "spring_dampr"});
  CHECK(wrong.code == 2);
  CHECK(has(wrong.err, "spring_damper"));
}

TEST_CASE("schema is JSON") {
  const Outcome schema = steplap_does({"schema"});
  CHECK(schema.code == 0);
  CHECK(schema.out.front() == '{');
  CHECK(has(schema.out, "step_lap_joint"));
}
