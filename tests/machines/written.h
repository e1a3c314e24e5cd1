// Machines written down in a test, as a user tries them: files of their own, the program's answers.
#pragma once

#include "tests/machines/machine.h"
#include "tools/steplap/command_line.h"
#include "transformer/program.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

namespace steplap::testing {

constexpr double k_g = 9.81;

inline std::string number(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

/// A model file for one test.
struct Written {
  std::filesystem::path file;
  explicit Written(const std::string& text) {
    static int written = 0;
    file = std::filesystem::temp_directory_path() /
           ("steplap_tried_" + std::to_string(::getpid()) + "_" + std::to_string(++written) + ".toml");
    std::ofstream(file) << text;
  }
  Written(const Written&) = delete;
  Written& operator=(const Written&) = delete;
  ~Written() { std::filesystem::remove(file); }
  [[nodiscard]] std::shared_ptr<const LoadedModel> loaded(const std::vector<std::string>& overrides = {}) const {
    return load_model(file.string(), overrides);
  }
};

struct Answer {
  int code = 0;
  std::string out, err;
};

inline Answer steplap_does(const std::vector<std::string>& arguments) {
  std::ostringstream out, err;
  const int code = run_command_line(arguments, out, err, false);
  return {code, out.str(), err.str()};
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline double last(const Run& run, const std::string& channel) {
  const auto& all = *run.result.trajectory;
  return all.value(all.size() - 1, all.column(channel));
}

inline int count(const Run& run, const std::string& element, EventKind kind) {
  return static_cast<int>(std::count_if(run.result.events.begin(), run.result.events.end(),
                                        [&](const Event& event) { return event.element == element && event.kind == kind; }));
}

} // namespace steplap::testing
