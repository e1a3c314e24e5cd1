// What the program does on a terminal that it does not do in a script: colour, and the question whether to build the program for studies.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <poll.h>

using namespace steplap::testing;

namespace {

struct Session {
  int code = -1;
  std::string screen; // all that came to the terminal
};

struct Call {
  std::string program = STEPLAP_PROGRAM;
  std::vector<std::string> arguments = {};
  std::vector<std::pair<std::string, std::string>> environment = {}; // "" unsets
  std::string typed = {};                                            // what somebody types once the screen shows `question`
  std::string question = {};
  bool is_output_piped = false, is_input_a_file = false;
};

[[noreturn]] void become(const Call& call) {
  for (const auto& [name, value] : call.environment)
    if (value.empty()) unsetenv(name.c_str());
    else setenv(name.c_str(), value.c_str(), 1);
  if (call.is_input_a_file && std::freopen("/dev/null", "r", stdin) == nullptr) _exit(126);
  std::vector<std::string> words{call.program};
  words.insert(words.end(), call.arguments.begin(), call.arguments.end());
  if (call.is_output_piped) { // cat writes to the terminal what the program writes to a pipe
    std::string line = "exec 3>&1; \"$@\" | cat >&3";
    words.insert(words.begin(), {"/bin/bash", "-o", "pipefail", "-c", line, "sh"});
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(arguments.front(), arguments.data());
  _exit(127);
}

// Runs the program with all three streams on a terminal of its own.
Session on_terminal(const Call& call) {
  constexpr int k_longest_silence = 120000; // ms: a run that hangs ends the test
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  REQUIRE(child >= 0);
  if (child == 0) become(call);
  Session session;
  bool is_answered = call.question.empty();
  for (pollfd waiting{terminal, POLLIN, 0}; poll(&waiting, 1, k_longest_silence) == 1;) {
    char part[4096];
    const ssize_t count = read(terminal, part, sizeof part);
    if (count <= 0) break; // the last writer is gone
    session.screen.append(part, static_cast<std::size_t>(count));
    if (is_answered || !has(session.screen, call.question)) continue;
    is_answered = true;
    REQUIRE(write(terminal, call.typed.data(), call.typed.size()) == static_cast<ssize_t>(call.typed.size()));
  }
  int status = 0;
  kill(child, SIGHUP); // nothing, if it ended
  REQUIRE(waitpid(child, &status, 0) == child);
  close(terminal);
  if (WIFEXITED(status)) session.code = WEXITSTATUS(status);
  return session;
}

const std::vector<std::pair<std::string, std::string>> k_colours{{"NO_COLOR", ""}, {"TERM", "xterm"}};

} // namespace

TEST_CASE("on a terminal the verdict has the colour of its meaning; piped or with NO_COLOR nothing has") {
  const Workbench bench;
  // By its bound the ball's force holds, is to be inspected, rejected, or left open.
  const auto model = [&](const std::string& name, const std::string& acceptance) {
    return bench.write(name + ".toml", k_bouncer + acceptance);
  };
  const std::string asked = "[[acceptance]]\nname = \"force\"\nchannel = \"floor.force\"\n";
  const std::vector<std::tuple<std::string, std::string, const char*>> all{
      {"HOLD", model("holds", asked + "within = 1e6\n"), "1;32"},
      {"INSPECT", model("inspect", asked + "within = 1\n"), "1;33"},
      {"REJECT", model("reject", asked + "within = 1\nconsequence = \"reject\"\n"), "1;31"},
      {"OPEN",
       model("open", asked + "within = 1e6\n[[acceptance]]\nname = \"no value\"\nchannel = \"nothing\"\nat_most = 0\n" +
                         "[[channel]]\nname = \"nothing\"\nexpression = \"ln(-1 - abs(ball.vx / '1 m/s'))\"\n"),
       "1;35"},
      {"NO CRITERIA", model("asks_nothing", ""), "1;35"}};
  for (const auto& [verdict, file, colour] : all) {
    CAPTURE(verdict);
    Call call{.arguments = {"simulate", file, "-f", "-q", "-o", bench.at("out")}, .environment = k_colours};
    const Session simulated = on_terminal(call);
    REQUIRE_MESSAGE(simulated.code == 0, simulated.screen);
    call.arguments = {"show", bench.at("out/" + fs::path(file).stem().string())};
    const std::string in_colour = "\x1b[" + std::string(colour) + "m" + verdict + "\x1b[0m";
    CHECK_MESSAGE(has(on_terminal(call).screen, in_colour), on_terminal(call).screen);
    call.environment = {{"NO_COLOR", "1"}, {"TERM", "xterm"}};
    const std::string plain = on_terminal(call).screen;
    CHECK(plain.starts_with(verdict + "  "));
    CHECK_FALSE(has(plain, "\x1b"));
    call.environment = {{"NO_COLOR", ""}, {"TERM", "dumb"}};
    CHECK(on_terminal(call).screen == plain);
    call.environment = k_colours;
    call.is_output_piped = true;
    CHECK(on_terminal(call).screen == plain);
  }
}

TEST_CASE("warnings stand once on a terminal, coloured, and whole") {
  const Workbench bench;
  std::string text = k_bouncer;
  text.replace(text.find("[0, 0.1]"), 8, "[0, -0.1]"); // it begins pressed into the floor
  const std::string model = bench.write("a.toml", text);
  Call call{.arguments = {"simulate", model, "-f", "-o", bench.at("out")}, .environment = k_colours};
  const std::string screen = on_terminal(call).screen;
  CHECK_MESSAGE(has(screen, "warning\x1b[m: "), screen);
  CHECK_FALSE(has(screen, "Warning"));
  const Call show{.arguments = {"show", bench.at("out/a")}, .environment = k_colours};
  const std::string shown = on_terminal(show).screen;
  CHECK_MESSAGE(has(shown, "\x1b[1;33mWarning\x1b[0m: "), shown);
  CHECK_FALSE(has(shown, "…"));
  call.environment.front().second = "1";
  const std::string plain = on_terminal(call).screen;
  CHECK(has(plain, "warning: "));
  CHECK_FALSE(has(plain, "\x1b[1"));
  CHECK_FALSE(has(plain, "\x1b[33"));
}

namespace {

// A build folder whose study program is not built, and a cmake that builds one that says how it was called.
struct Unbuilt {
  explicit Unbuilt(const std::string& cmake_script) {
    fs::create_directories(bench.at("build/bin"));
    fs::copy_file(STEPLAP_PROGRAM, bench.at("build/bin/steplap"));
    bench.write("build/CMakeCache.txt", "");
    fs::permissions(bench.write("tools/cmake", "#!/bin/sh\n" + cmake_script), fs::perms::owner_all);
    call.program = bench.at("build/bin/steplap");
    call.arguments = {"study", "my study.toml"};
    call.environment = {{"PATH", bench.at("tools") + ":/usr/bin:/bin"}};
    call.question = "Build it now? This takes some minutes. [y/N] ";
  }
  [[nodiscard]] bool is_built() const { return fs::exists(bench.at("build/libexec/steplap-study")); }

  Workbench bench;
  Call call;
};

// Called with "--build FOLDER --target steplap-study".
constexpr const char* k_builds = R"(echo "built with: $1 $3 $4"
mkdir "$2/libexec"
printf '#!/bin/sh\necho "studies: $1, $2"\nexit 5\n' > "$2/libexec/steplap-study"
chmod +x "$2/libexec/steplap-study"
)";
constexpr const char* k_remedy = "Build it with: cmake --build --preset release --target steplap-study";

} // namespace

TEST_CASE("study asks whether to build its program, builds it after a yes and goes on") {
  for (const char* const yes : {"y\n", "Y\n", "yes\n"}) {
    CAPTURE(yes);
    Unbuilt place(k_builds);
    place.call.typed = yes;
    const Session session = on_terminal(place.call);
    CHECK(session.code == 5); // of the program that was built
    CHECK(has(session.screen, "built with: --build --target steplap-study"));
    CHECK(has(session.screen, "studies: my study.toml, "));
  }
}

TEST_CASE("study builds nothing after a no, after nothing and at the end of input, and says how to build it") {
  constexpr const char* k_end_of_input = "\x04"; // Ctrl-D
  for (const char* const no : {"n\n", "no\n", "\n", "yeah, why not\n", k_end_of_input}) {
    CAPTURE(no);
    Unbuilt place(k_builds);
    place.call.typed = no;
    const Session session = on_terminal(place.call);
    CHECK(session.code == 2);
    CHECK(has(session.screen, place.call.question));
    CHECK_MESSAGE(has(session.screen, std::string("\nsteplap: error: Studies need a second program, which is not built. ") + k_remedy),
                  session.screen);
    CHECK_FALSE(place.is_built());
  }
}

TEST_CASE("study says how to build its program where building fails, and asks nobody who cannot answer") {
  SUBCASE("building fails") {
    Unbuilt place("echo no compiler\nexit 1\n");
    place.call.typed = "y\n";
    const Session session = on_terminal(place.call);
    CHECK(session.code == 2);
    CHECK(has(session.screen, "no compiler"));
    CHECK(has(session.screen, k_remedy));
  }
  SUBCASE("there is no cmake") {
    Unbuilt place("");
    place.call.environment = {{"PATH", place.bench.at("nowhere")}};
    place.call.typed = "y\n";
    const Session session = on_terminal(place.call);
    CHECK(session.code == 2);
    CHECK(has(session.screen, k_remedy));
  }
  SUBCASE("the input is no terminal") {
    Unbuilt place(k_builds);
    place.call.is_input_a_file = true;
    const Session session = on_terminal(place.call);
    CHECK(session.code == 2);
    CHECK_FALSE(has(session.screen, "[y/N]"));
    CHECK_FALSE(place.is_built());
  }
  SUBCASE("it is installed, and there is nothing to build from") {
    Unbuilt place(k_builds);
    fs::remove(place.bench.at("build/CMakeCache.txt"));
    const Session session = on_terminal(place.call);
    CHECK(session.code == 2);
    CHECK_FALSE(has(session.screen, "[y/N]"));
  }
}
