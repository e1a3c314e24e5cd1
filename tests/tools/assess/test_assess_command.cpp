// What the command leaves behind when its folder cannot be written.
#include "driven_scene.h"

#include <doctest/doctest.h>

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

using namespace steplap;
using namespace assess_test;

namespace {

/// A block that holds what its record shakes it by, and the command on them.
struct Bench {
  Bench() {
    assess_test::write(folder.file("shock.csv"), record_csv(1000.0, 2.0, [](double t) {
                         return t < 0.5 || t > 0.6 ? 0.0 : 12.0 * std::sin(10.0 * std::numbers::pi * (t - 0.5));
                       }));
    assess_test::write(folder.file("block.toml"),
                       block_text(2.0, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"1 mm\"\n"));
  }
  /// Its exit code.
  [[nodiscard]] int assess(const std::string& output, const std::string& before = "") const {
    const std::string command = before + STEPLAP_PROGRAM " assess " + folder.file("shock.csv") + " --model " + folder.file("block.toml") +
                                " --gravity z --samples 0 --no-estimate -o " + output + " > /dev/null 2> " + folder.file("err");
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string error() const {
    std::ostringstream text;
    text << std::ifstream(folder.file("err")).rdbuf();
    return text.str();
  }
  Folder folder;
};

} // namespace

TEST_CASE("a folder that cannot be written ends an assessment with one error, and nothing stays behind") {
  const Bench bench;
  const std::string in_a_file = bench.folder.file("shock.csv") + "/out";
  CHECK(bench.assess(in_a_file) == 2);
  CHECK(bench.error().find("cannot write to the folder '" + in_a_file + "'") != std::string::npos);
  CHECK(bench.assess("/proc/steplap/out") == 2);
  CHECK(bench.error().find("Choose another one with -o") != std::string::npos);
  // Files of more than 1 or 2 KiB fail, as on a full disk; the assessment is larger.
  const std::string full = bench.folder.file("full");
  CHECK(bench.assess(full, "trap '' XFSZ; ulimit -f 2; ") == 2);
  CHECK(bench.error().find("cannot write '" + full + "/assessment.json'") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(full));
  CHECK(bench.assess(full) == 12); // open: the block has no joint of which something could be said
  CHECK(std::filesystem::exists(full + "/assessment.json"));
}
