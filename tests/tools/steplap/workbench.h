// A scratch folder with small models, and the command line run in it.
#pragma once

#include "tools/steplap/command_line.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace steplap::testing {

namespace fs = std::filesystem;

struct Outcome {
  int code = 0;
  std::string out, err;
};

/// The command line in this process.
inline Outcome steplap_does(const std::vector<std::string>& arguments, bool is_terminal = false) {
  std::ostringstream out, err;
  const int code = run_command_line(arguments, out, err, is_terminal);
  return {code, out.str(), err.str()};
}

inline std::string text_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A mass on a spring, released from rest; a spare signal that nothing uses.
inline constexpr const char* k_oscillator = R"(title = "a mass on a spring"
gravity = [0, 0]
[simulation]
end = 0.1
step = 1e-3
[output]
step = 0.01
[[signal]]
name = "spare"
kind = "constant"
value = 1
[[body]]
name = "mass"
mass = "2 kg"
inertia = 1
velocity = [0.1, 0]
[[element]]
name = "spring"
kind = "spring_damper"
a = "mass"
b = "ground"
axis = [1, 0]
stiffness = 800
)";

/// A mass that bounces on the ground: three events or more within the run.
inline constexpr const char* k_bouncer = R"(title = "a bouncing mass"
[simulation]
end = 2
step = 1e-3
[output]
step = 0.1
[[body]]
name = "ball"
mass = 1
inertia = 1
position = [0, 0.1]
[[element]]
name = "floor"
kind = "unilateral_contact"
a = "ball"
b = "ground"
normal = [0, 1]
stiffness = 1e5
damping = 10
)";

/// Nothing holds it.
inline constexpr const char* k_falling = R"([simulation]
step = 1e-3
[[body]]
name = "stone"
mass = 1
inertia = 1
)";

/// Removed with all that is in it.
class Workbench {
public:
  Workbench() {
    static int count = 0;
    path_ = fs::temp_directory_path() / ("steplap_tools_" + std::to_string(::getpid()) + "_" + std::to_string(++count));
    fs::create_directories(path_);
  }
  Workbench(const Workbench&) = delete;
  Workbench& operator=(const Workbench&) = delete;
  ~Workbench() { fs::remove_all(path_); }

  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (path_ / name).string(); }

  /// Names of everything below a folder, relative to it.
  [[nodiscard]] std::set<std::string> content(const std::string& folder) const {
    std::set<std::string> names;
    if (fs::exists(path_ / folder))
      for (const auto& entry : fs::recursive_directory_iterator(path_ / folder))
        names.insert(fs::relative(entry.path(), path_ / folder).string());
    return names;
  }

private:
  fs::path path_;
};

} // namespace steplap::testing
