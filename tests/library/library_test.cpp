// steplap as a library: installed into a folder of its own, found by CMake, and used by the programs of docs/examples/, whose
// results are closed forms.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>
#include <string>

namespace fs = std::filesystem;

namespace {

const std::string k_prefix = STEPLAP_SCRATCH "/installed", k_programs = STEPLAP_SCRATCH "/examples";
const std::string k_warnings = "-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wold-style-cast " STEPLAP_WARNINGS_ARE;
const std::string k_block = " " STEPLAP_SOURCE "/docs/examples/braked_block.toml";

constexpr double k_gravity = 9.81;

// What a command writes; it has to succeed.
std::string output_of(const std::string& command) {
  std::FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), count);
  const int status = ::pclose(pipe);
  REQUIRE_MESSAGE((WIFEXITED(status) && WEXITSTATUS(status) == 0), command << "\n" << text);
  return text;
}

double number_after(const std::string& text, const std::string& words) {
  const std::size_t place = text.find(words);
  REQUIRE_MESSAGE(place != std::string::npos, words << " is not in\n" << text);
  return std::stod(text.substr(place + words.size()));
}

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// Installs the library and builds the programs; once for all cases.
bool install_and_build() {
  fs::remove_all(k_prefix);
  fs::remove_all(k_programs);
  const std::string cmake = STEPLAP_CMAKE;
  output_of(cmake + " --install " STEPLAP_BUILD " --prefix " + k_prefix);
  output_of(cmake + " -S " STEPLAP_SOURCE "/docs/examples -B " + k_programs +
            " -G '" STEPLAP_GENERATOR "' -DCMAKE_PREFIX_PATH=" + k_prefix +
            " -DCMAKE_CXX_COMPILER=" STEPLAP_COMPILER " -DCMAKE_CXX_COMPILER_LAUNCHER=" STEPLAP_LAUNCHER
            " -DCMAKE_EXPORT_COMPILE_COMMANDS=ON '-DCMAKE_CXX_FLAGS=" +
            k_warnings + "'");
  output_of(cmake + " --build " + k_programs + " --parallel 2");
  return true;
}

// A rigid block on a deck that is braked with the haversine of braked_block.toml, A/2 (1 − cos ωτ) for 0 ≤ τ ≤ T. It
// slips at τ₁, where that passes μg, goes on with the speed of then less μg, and sticks at τ₂, where the deck is as fast.
class BrakedBlock {
public:
  explicit BrakedBlock(double friction) : drag_(friction * k_gravity) {
    slips = std::acos(1.0 - 2.0 * drag_ / k_peak) / k_omega;
    sticks = k_duration - slips; // where it is fastest on the deck: the deck's deceleration is again μg
    for (double step = 1.0; step > 1e-12; step *= 0.5)
      if (speed_on_deck(sticks + step) > 0.0) sticks += step;
    const double t = sticks - slips;
    slide = shift(sticks) - shift(slips) - speed(slips) * t - 0.5 * drag_ * t * t;
  }

  double slips = 0.0, sticks = 0.0, slide = 0.0; // s, s, m; times from the beginning of braking

  // The feet are springs that let the block pitch by m h a/(2 k l²), its centre of gravity lean by h times that:
  // k_pitch a. When it slips this grows with the braking, by k_pitch A ω/2 at most, a speed that the rigid block does not
  // have; and at the end it has sprung back from k_pitch μg.
  [[nodiscard]] double slide_error() const { return k_pitch * (0.5 * k_peak * k_omega * (sticks - slips) + drag_); }
  // It slips when a + k_pitch ä = μg, at most ä/ȧ ≤ ω/sin ωτ₁ times k_pitch from where a alone is.
  [[nodiscard]] double slip_error() const { return k_pitch * k_omega / std::sin(k_omega * slips); }

private:
  static constexpr double k_peak = 0.6 * k_gravity, k_duration = 0.4;
  static constexpr double k_omega = 2.0 * std::numbers::pi / k_duration;
  static constexpr double k_pitch = 2000.0 * 0.5 * 0.5 / (2.0 * 50e6 * 0.7 * 0.7); // s²

  // What braking has taken from the deck's speed, and from its way.
  static double speed(double t) {
    if (t > k_duration) return 0.5 * k_peak * k_duration;
    return 0.5 * k_peak * (t - std::sin(k_omega * t) / k_omega);
  }
  static double shift(double t) {
    if (t > k_duration) return shift(k_duration) + speed(k_duration) * (t - k_duration);
    return 0.5 * k_peak * (0.5 * t * t + (std::cos(k_omega * t) - 1.0) / (k_omega * k_omega));
  }
  [[nodiscard]] double speed_on_deck(double t) const { return speed(t) - speed(slips) - drag_ * (t - slips); }

  double drag_; // m/s²
};

bool is_installed() {
  static const bool is_built = install_and_build();
  return is_built;
}

} // namespace

TEST_CASE("the installed library: a model made in C++, a block that slides and sticks") {
  REQUIRE(is_installed());
  const std::string said = output_of(k_programs + "/sliding_block");
  // Heave and pitch of two equal feet do not couple, so that N = mg throughout. The centre of gravity leans by
  // μ m g h²/(2 k l²) = 3e-6 m; the rest is the last digit written.
  CHECK(std::abs(number_after(said, "sticks after ") - 2.5 / (0.3 * k_gravity)) < 0.6e-4);
  CHECK(std::abs(number_after(said, "has slid ") - 2.5 * 2.5 / (2.0 * 0.3 * k_gravity)) < 0.6e-4);
}

TEST_CASE("the installed library: a model from a file, a block on a vehicle that brakes") {
  REQUIRE(is_installed());
  const std::string said = output_of(k_programs + "/run_file" + k_block);
  const BrakedBlock block(0.35);
  CHECK(std::abs(number_after(said, "on a vehicle that brakes\n") - (0.1 + block.slips)) < block.slip_error() + 0.5e-4);
  CHECK(said.find("deck friction sticks") != std::string::npos);
  // Weight of both, carried by the road at every time; six digits are written.
  CHECK(std::abs(number_after(said, "road.force") - 12000.0 * k_gravity) < 0.5);
  const BrakedBlock other(0.4);
  const std::string changed = output_of(k_programs + "/run_file" + k_block + " 'element.deck friction.static_friction=0.4'");
  CHECK(std::abs(number_after(changed, "on a vehicle that brakes\n") - (0.1 + other.slips)) < other.slip_error() + 0.5e-4);
}

TEST_CASE("the installed library: one model, many values, in several threads") {
  REQUIRE(is_installed());
  const std::string said = output_of(k_programs + "/friction_study" + k_block);
  for (int percent = 20; percent <= 58; percent += 2) {
    const BrakedBlock block(percent / 100.0);
    const double slide = 1e-3 * number_after(said, "friction 0." + std::to_string(percent) + "  slides ");
    CAPTURE(percent);
    CAPTURE(slide);
    CHECK(std::abs(slide - block.slide) < block.slide_error() + 0.5e-5);
  }
  CHECK(number_after(said, "friction 0.62  slides ") == 0.0); // never braked with more than 0.6 g
}

TEST_CASE("the installed library: an element kind of one's own, in a model file and in the verdict") {
  REQUIRE(is_installed());
  const std::string program = k_programs + "/own_element " STEPLAP_SOURCE "/docs/examples/own_element.toml";
  const std::string said = output_of(program);
  // m v' = −c v²: with τ = m/(c v₀) = 1 s, v = v₀/(1 + t/τ), x = x₀ + (m/c) ln(1 + t/τ), and what is missing of m v²/2 is
  // dissipated. The tolerance of 1e-9 of each step leaves less than the digits written.
  const double v0 = 2.0, v = v0 / 3.0;
  CHECK(std::abs(number_after(said, "speed ") - v) < 1e-6);
  CHECK(std::abs(number_after(said, "way ") - (5.0 + 2.0 * std::log(3.0))) < 1e-6);
  CHECK(std::abs(number_after(said, "dissipated ") - 500.0 * (v0 * v0 - v * v)) < 1e-3);
  // Its own criterion: the force is largest at the start, c v₀² = 2000 N.
  CHECK(said.find("|damper.force| <= 2500 N: hold, largest -2000.000 N") != std::string::npos);
  CHECK(said.find("verdict: hold") != std::string::npos);
  const std::string weak = output_of(program + " 'element.damper.strength=1900'");
  CHECK(weak.find("|damper.force| <= 1900 N: reject") != std::string::npos);
  CHECK(weak.find("verdict: reject") != std::string::npos);
  // Without the kind the file is refused by its line.
  const std::string refused = output_of("(" + k_prefix + "/bin/steplap check " STEPLAP_SOURCE "/docs/examples/own_element.toml || true)");
  CHECK(refused.find("own_element.toml:25:8") != std::string::npos);
  CHECK(refused.find("orifice_damper") != std::string::npos);
}

TEST_CASE("the installed library: a judged run is that of the program, byte for byte") {
  REQUIRE(is_installed());
  int models = 0;
  for (const char* folder : {"models/benchmarks", "models/layouts", "models/machines", "models/paper", "tests/data/defects"})
    for (const auto& entry : fs::directory_iterator(fs::path(STEPLAP_SOURCE) / folder)) {
      if (entry.path().extension() != ".toml" || entry.path().stem() == "andrews_a03") continue; // a minute by itself
      const std::string model = entry.path().string(), by_program = STEPLAP_SCRATCH "/by_program", mine = STEPLAP_SCRATCH "/mine";
      CAPTURE(model);
      // Codes of exit are told apart elsewhere; a run that breaks off leaves files as well.
      output_of(k_prefix + "/bin/steplap simulate -q --force -o " + by_program + " " + model + " || true");
      output_of(k_programs + "/judged_run " + model + " " + mine + " || true");
      const fs::path theirs = fs::path(by_program) / entry.path().stem();
      int files = 0;
      for (const auto& file : fs::directory_iterator(theirs)) {
        CHECK_MESSAGE(text_of(file.path()) == text_of(fs::path(mine) / file.path().filename()), file.path().filename());
        ++files;
      }
      CHECK(files == 5);
      fs::remove_all(by_program);
      fs::remove_all(mine);
      ++models;
    }
  CHECK(models > 65);
}

// Names of the headers that are installed as <steplap/NAME>.
std::set<std::string> public_headers() {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(k_prefix + "/include/steplap"))
    if (entry.is_regular_file()) names.insert(entry.path().filename().string());
  return names;
}

TEST_CASE("the installed library: the examples include only public headers, which compile together") {
  REQUIRE(is_installed());
  const std::set<std::string> names = public_headers();
  CHECK(names.size() == 12); // cmake/public_headers.cmake, and version.h
  const std::string start = "#include <steplap/";
  int includes = 0;
  for (const auto& entry : fs::directory_iterator(STEPLAP_SOURCE "/docs/examples")) {
    std::istringstream lines(text_of(entry.path()));
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with(start)) continue;
      ++includes;
      CHECK_MESSAGE(names.contains(line.substr(start.size(), line.find('>') - start.size())), entry.path() << ": " << line);
    }
  }
  CHECK(includes >= 15);

  const std::string all = k_programs + "/all_headers.cpp";
  std::ofstream source(all);
  for (const std::string& name : names) source << start << name << ">\n";
  source.close();
  const std::string folders =
      " -isystem " + k_prefix + "/include -isystem " + k_prefix + "/include/steplap/internal -isystem " STEPLAP_EIGEN " ";
  output_of(STEPLAP_COMPILER " -std=c++20 -fsyntax-only " + k_warnings + folders + all);
}

TEST_CASE("the installed library: users get no options of ours, and no headers but ours and Eigen's") {
  REQUIRE(is_installed());
  std::string commands = text_of(k_programs + "/compile_commands.json");
  REQUIRE_FALSE(commands.empty());
  for (std::size_t i = commands.find(k_warnings); i != std::string::npos; i = commands.find(k_warnings, i))
    commands.erase(i, k_warnings.size());
  for (const char* option : {" -W", " -f", " -m", " -include "}) CHECK_MESSAGE(commands.find(option) == std::string::npos, commands);
  std::istringstream words(commands);
  int folders = 0;
  for (std::string word; words >> word;) {
    if (word.starts_with("-D")) CHECK(word == "-DNDEBUG");
    if (word.starts_with("-I")) FAIL(word);
    if (word != "-isystem") continue;
    words >> word;
    CHECK_MESSAGE((word.starts_with(k_prefix + "/") || word.ends_with("/eigen3")), word);
    ++folders;
  }
  CHECK(folders >= 5 * 3); // for each program ours, ours for "mbd/…", and Eigen's
}
