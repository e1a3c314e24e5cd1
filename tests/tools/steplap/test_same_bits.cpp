// The same bits on every x86-64 machine: models are run as this processor would run them and as one without fused
// multiplication and AVX2, which the C library's tunables stand in for; and nothing calls those functions of the
// library that choose among routines, neither in the sources nor, by way of other libraries' headers, in the program.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>

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
  const std::string now = shell_does(STEPLAP_LIBRARY_BITS).out,
                    older = shell_does(std::string(k_older_processor) + STEPLAP_LIBRARY_BITS).out;
  if (now != older) return true;
  MESSAGE("skipped: the C library gives the same bits with and without the tunables. Either this processor has "
          "no FMA, or this library has but one routine for each function");
  return false;
}

// Powers of the depth, harmonics, chirps both ways, the angle of a line of centres.
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
[[signal]]
name = "sweep"
kind = "chirp"
amplitude = 15.0
from = 2.0
to = 40.0
start = 0.1
duration = 0.6
[[signal]]
name = "octaves"
kind = "chirp"
amplitude = 20.0
from = 50.0
to = 3.0
course = "exponential"
duration = 0.7
[[signal]]
name = "swept"
kind = "sum"
signals = ["sweep", "octaves"]
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
[[element]]
kind = "load"
name = "shaker"
at = "pinion"
torque = "swept"
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

// The functions of the C library that choose among routines by the processor, without their suffixes for types.
const std::set<std::string>& chosen_by_processor() {
  static const std::set<std::string> names = [] {
    std::set<std::string> all{"atan2", "sincos", "exp",  "exp2", "exp10", "expm1", "log",    "log2",   "log10",
                              "log1p", "pow",    "cbrt", "erf",  "erfc",  "hypot", "tgamma", "lgamma", "polar"};
    for (const std::string name : {"sin", "cos", "tan"})
      for (const char* inverse : {"", "a"})
        for (const char* hyperbolic : {"", "h"}) all.insert(inverse + name + hyperbolic);
    for (const char* name : {"abs", "arg", "exp", "log", "pow", "sqrt", "sin", "cos", "tan"}) // of complex numbers
      all.insert(std::string("c") + name);
    return all;
  }();
  return names;
}

bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// A line of code without what follows // and without texts in quotes.
std::string code_of(const std::string& line) {
  const std::string code = line.substr(0, line.find("//"));
  std::string rest;
  bool quoted = false;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i] == '"') quoted = !quoted;
    else if (!quoted) rest += code[i];
    if (quoted && code[i] == '\\') ++i;
  }
  return rest;
}

// The first function of the C library that a line of code calls or names by `using`: sin(, std::sin(, ::sin(; not
// x.sin(, portable::sin(.
std::optional<std::string> library_function(std::string_view code) {
  for (std::size_t i = 0; i < code.size();) {
    if (!is_of_name(code[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < code.size() && is_of_name(code[end])) ++end;
    const std::string name(code.substr(i, end - i));
    std::string_view before = code.substr(0, i);
    const std::size_t next = code.find_first_not_of(' ', end);
    i = end;
    if (!chosen_by_processor().contains(name)) continue;
    if (next == std::string_view::npos || (code[next] != '(' && code[next] != ';')) continue;
    const auto drop = [&](std::string_view text) {
      if (!before.ends_with(text)) return false;
      before.remove_suffix(text.size());
      return true;
    };
    const bool is_scoped = drop("::"), is_standard = is_scoped && drop("std");
    const char last = before.empty() ? ' ' : before.back();
    if (is_standard ? !is_of_name(last) : !is_of_name(last) && last != '.' && last != '>' && last != ':') return name;
  }
  return std::nullopt;
}

} // namespace

TEST_CASE("the paper's models give the same bytes on a processor without fused multiplication") {
  if (!can_play_older_processor()) return;
  const std::string paper = STEPLAP_MODELS "/paper/";
  for (const char* method : {"", " --integrator dop853", " --integrator rodas5p"})
    check_same_bytes(paper + "no_interference.toml " + paper + "interference.toml --end 0.3 --estimate-error" + method);
  check_same_bytes(paper + "weak_clamping.toml --end 0.15 --estimate-error");
}

TEST_CASE("joints that slide, mechanisms, contacts with powers and driven wheels give the same bytes, too") {
  if (!can_play_older_processor()) return;
  const Workbench bench;
  std::string models; // of which the library's own functions gave other bytes
  for (const char* name : {"layouts/three_limb", "layouts/five_limb_humping", "benchmarks/andrews_a03", "benchmarks/bouncing_mass",
                           "benchmarks/chain_10", "benchmarks/double_pendulum", "benchmarks/slider_crank", "benchmarks/robot_arm"})
    models += std::string(STEPLAP_MODELS "/") + name + ".toml ";
  check_same_bytes(models + "--no-estimate");
  const std::string own = bench.write("round_things.toml", k_round_things);
  for (const char* settings : {"dop853 --tolerance 1e-8", "rodas5p --tolerance 1e-6", "tsit5 --tolerance 1e-5", "rk4 --step 5e-5"})
    check_same_bytes(own + " --estimate-error --integrator " + settings);
}

// Of the program's own archives: what other makers' libraries call (UDUNITS a logarithm, for units of sound) takes no part
// in the numbers of a run.
TEST_CASE("the program's own code takes no function from the C library that depends on the processor") {
  const Outcome imports = shell_does("nm --undefined-only " STEPLAP_ARCHIVES);
  REQUIRE(imports.code == 0);
  REQUIRE(has(imports.out, "malloc"));
  int looked_at = 0;
  std::istringstream lines(imports.out);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(" U ");
    if (at == std::string::npos) continue;
    ++looked_at;
    const std::string name = line.substr(at + 3);
    const bool has_suffix = name.ends_with("f") || name.ends_with("l"); // of float and long double
    CHECK_MESSAGE(
        !(chosen_by_processor().contains(name) || (has_suffix && chosen_by_processor().contains(name.substr(0, name.size() - 1)))),
        "the program calls " << name << " of the C library: use mbd/base/portable_math.h");
  }
  CHECK(looked_at > 1000);
}

TEST_CASE("a call of the C library is told from others") {
  CHECK(library_function("return std::sin(x);") == "sin");
  CHECK(library_function("y = 2 * ::atan2 (a, b);") == "atan2");
  CHECK(library_function("using std::pow;") == "pow");
  for (const char* other : {"x.array().sin()", "portable::sin(x)", "a->log(x)", "asinus(x)", "const double sin = 1", "cexp_of(x)"})
    CHECK_MESSAGE(!library_function(other), other);
  CHECK(code_of(R"x(log("sin(\"x)\")" + y); // cos(x))x") == "log( + y); ");
}

// The files that define these functions.
bool defines_portable_math(const fs::path& path) {
  const std::string folder = path.parent_path().filename().string(), name = path.filename().string();
  const bool is_of_base =
      name == "portable_math.h" || name == "arc.cpp" || name == "power.cpp" || name == "sine.cpp" || name == "sine_series.h";
  return folder == "base" && is_of_base;
}

TEST_CASE("sources call mbd/base/portable_math.h instead of the C library") {
  const std::string allowed = "using portable::";
  int looked_at = 0;
  for (const char* room : {"mbd", "elements", "transformer", "tools/steplap", "tools/figures"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(STEPLAP_SOURCE) / room)) {
      const std::string path = entry.path().string(), extension = entry.path().extension().string();
      if ((extension != ".cpp" && extension != ".h") || defines_portable_math(entry.path())) continue;
      if (has(path, "/transformer/recorder/")) continue; // pictures and filters of records, no part of a run
      if (has(path, "/mbd/formula/")) continue; // functions of these names on its own kinds of numbers; what it calls is looked at above
      ++looked_at;
      const std::string text = text_of(path);
      std::istringstream lines(text);
      int number = 0;
      for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::string code = code_of(line);
        const std::optional<std::string> found = library_function(code);
        if (!found) continue;
        const std::string& name = *found;
        // dual.h's own functions, and templates that name the portable one above: `using portable::pow;`.
        if (has(code, "friend Dual " + name) || has(code, "friend TapeNumber " + name) || has(text, allowed + name + ";")) continue;
        FAIL_CHECK(path << ":" << number << ": " << name << " of the C library, use portable::" << name << ": " << line);
      }
    }
  CHECK(looked_at > 200);
}
