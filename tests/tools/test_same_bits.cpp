// The same bits on every x86-64 machine: models are run as this processor would run them and as one without fused
// multiplication and AVX2, which the C library's tunables stand in for; and nothing calls those functions of the
// library that choose among routines, neither in the sources nor, by way of other libraries' headers, in the program.
#include "tests/tools/workbench.h"

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <regex>

using namespace steplap::testing;

namespace {

constexpr const char* k_older_processor = "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2 ";

// What a command prints, and its exit code.
Outcome shell_does(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r"); // NOLINT: commands of our own
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> part{};
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) outcome.out.append(part.data(), n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

bool can_play_older_processor() {
  const std::string now = shell_does(STEPLAP_LIBRARY_BITS).out, older = shell_does(std::string(k_older_processor) + STEPLAP_LIBRARY_BITS).out;
  if (now != older) return true;
  MESSAGE("skipped: the C library gives the same bits with and without the tunables. Either this processor has "
          "no FMA, or this library has but one routine for each function");
  return false;
}

// Powers of the depth, harmonics, the angle of a line of centres.
constexpr const char* k_round_things = R"(title = "A ball with a Hertzian skin on a hill, geared wheels that are shaken"
[simulation]
end = 0.8
[output]
step = 1e-3
[[signal]]
name = "shaking"
kind = "harmonics"
amplitudes = [30.0, 10.0]
frequencies = [7.3, 19.1]
phases = [0.4, 1.1]
[[body]]
name = "ball"
mass = 857.1
inertia = 66.02
position = [0.264, 2.32996]
[[element]]
kind = "circle_contact"
name = "hill"
a = "ball"
b = { body = "ground", at = [0.0, 0.0] }
radius_a = 0.306
radius_b = 2.0
law = "hunt_crossley"
exponent = 1.5
stiffness = 9353000000.0
dissipation = 1.389
[[body]]
name = "wheel"
mass = 2.0
inertia = 0.4
position = [3.0, 0.0]
[[body]]
name = "pinion"
mass = 1.0
inertia = 0.02
position = [3.5, 0.0]
[[element]]
kind = "revolute"
name = "axle"
a = "wheel"
b = { body = "ground", at = [3.0, 0.0] }
[[element]]
kind = "revolute"
name = "pin"
a = "pinion"
b = { body = "ground", at = [3.5, 0.0] }
[[element]]
kind = "gear"
name = "teeth"
a = "wheel"
b = "pinion"
radius_a = 0.3
radius_b = 0.2
[[element]]
kind = "load"
name = "drive"
at = "wheel"
torque = "shaking"
)";

std::string first_difference(const std::string& a, const std::string& b) {
  std::istringstream as(a), bs(b);
  std::string x, y;
  for (int line = 1; std::getline(as, x) && std::getline(bs, y); ++line)
    if (x != y) return "line " + std::to_string(line) + ": " + x.substr(0, 200) + "\nor: " + y.substr(0, 200);
  return "one is longer";
}

void check_same_bytes(const std::string& arguments) {
  CAPTURE(arguments);
  const Workbench bench;
  const std::string command = STEPLAP_PROGRAM " simulate -q " + arguments + " -o ";
  CHECK(shell_does(command + bench.at("here")).code == 0);
  CHECK(shell_does(k_older_processor + command + bench.at("older")).code == 0);
  const std::set<std::string> names = bench.content("here");
  CHECK(names == bench.content("older"));
  for (const std::string& name : names) {
    if (fs::is_directory(bench.at("here/" + name))) continue;
    CAPTURE(name);
    const std::string here = text_of(bench.at("here/" + name)), older = text_of(bench.at("older/" + name));
    CHECK_MESSAGE(here == older, first_difference(here, older));
  }
}

// Lines of code without what follows // and without texts in quotes.
std::string code_of(const std::string& line) {
  static const std::regex texts(R"("(\\.|[^"\\])*")");
  return std::regex_replace(line.substr(0, line.find("//")), texts, "\"\"");
}

} // namespace

TEST_CASE("the paper's models give the same bytes on a processor without fused multiplication") {
  if (!can_play_older_processor()) return;
  const std::string paper = STEPLAP_MODELS "/paper/";
  for (const char* method : {"", " --integrator dop853", " --integrator rodas5p"})
    check_same_bytes(paper + "no_interference.toml " + paper + "interference.toml --end 0.3" + method);
  check_same_bytes(paper + "weak_clamping.toml --end 0.15");
}

TEST_CASE("joints that slide, mechanisms, contacts with powers and driven wheels give the same bytes, too") {
  if (!can_play_older_processor()) return;
  const Workbench bench;
  std::string models; // of which the library's own functions gave other bytes
  for (const char* name : {"layouts/three_limb", "layouts/five_limb_humping", "benchmarks/andrews_a03", "benchmarks/bouncing_mass",
                           "benchmarks/chain_10", "benchmarks/double_pendulum", "benchmarks/slider_crank", "benchmarks/robot_arm"})
    models += std::string(STEPLAP_MODELS "/") + name + ".toml ";
  check_same_bytes(models);
  const std::string own = bench.write("round_things.toml", k_round_things);
  for (const char* settings : {"dop853 --tolerance 1e-8", "rodas5p --tolerance 1e-6", "tsit5 --tolerance 1e-5", "rk4 --step 5e-5"})
    check_same_bytes(own + " --integrator " + settings);
}

TEST_CASE("the program takes no function from the C library that depends on the processor") {
  const Outcome imports = shell_does("nm -D --undefined-only " STEPLAP_PROGRAM);
  REQUIRE(imports.code == 0);
  REQUIRE(has(imports.out, "malloc"));
  static const std::regex called(
      R"(\bU ((a?(sin|cos|tan)h?|atan2|sincos|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|hypot|cbrt|erfc?|[tl]gamma)[fl]?|c(abs|arg|exp|log|pow|sqrt|sin|cos|tan)[fl]?)(@|\n))");
  for (std::sregex_iterator i(imports.out.begin(), imports.out.end(), called), end; i != end; ++i)
    CHECK_MESSAGE(false, "the program calls " << (*i)[1] << " of the C library: use mbd/math/portable_math.h");
}

TEST_CASE("sources call mbd/math instead of the C library") {
  static const std::regex library(
      R"((std\s*::\s*|(^|[^\w:.>])(::\s*)?)(a?(sin|cos|tan)h?|atan2|sincos|exp|exp2|expm1|log|log2|log10|log1p|pow|hypot|cbrt|erfc?|[tl]gamma|polar)\s*[(;])");
  const std::string allowed = "using portable::";
  int looked_at = 0;
  for (const char* room : {"mbd", "elements", "transformer", "tools/steplap", "tools/figures"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(STEPLAP_SOURCE) / room)) {
      const std::string path = entry.path().string(), extension = entry.path().extension().string();
      if ((extension != ".cpp" && extension != ".h") || has(path, "/mbd/math/")) continue;
      ++looked_at;
      const std::string text = text_of(path);
      std::istringstream lines(text);
      int number = 0;
      for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::string code = code_of(line);
        std::smatch found;
        if (!std::regex_search(code, found, library)) continue;
        const std::string name = found[4];
        // dual.h's own functions, and templates that name the portable one above: `using portable::pow;`.
        if (has(code, "friend Dual " + name) || has(text, allowed + name + ";")) continue;
        FAIL_CHECK(path << ":" << number << ": " << name << " of the C library, use portable::" << name << ": " << line);
      }
    }
  CHECK(looked_at > 200);
}
