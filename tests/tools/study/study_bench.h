// Studies run in this process, in a scratch folder.
#pragma once

#include "tools/steplap/command_line.h"
#include "tools/study/finding.h"
#include "tools/study/program/commands.h"
#include "tools/study/store.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace steplap::testing {

namespace fs = std::filesystem;

struct Outcome {
  int code = 0;
  std::string out, err;
};

inline Outcome study_does(std::vector<std::string> arguments) {
  static const study::Ranks ranks;
  std::ostringstream out, err;
  const int code = run_program(study::study_program(ranks), arguments, out, err, false);
  return {code, out.str(), err.str()};
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline std::string text_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A folder that is gone at the end.
class StudyBench {
public:
  StudyBench() : folder_(fs::temp_directory_path() / ("steplap_study_" + std::to_string(getpid()) + "_" + std::to_string(next_++))) {
    fs::create_directories(folder_);
  }
  ~StudyBench() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  StudyBench(const StudyBench&) = delete;
  StudyBench& operator=(const StudyBench&) = delete;

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return at(name);
  }
  /// Runs the study and keeps what it found.
  Outcome run(const std::string& text, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run", write("study.toml", text), "-o", at("study.sqlite")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = study_does(arguments);
    findings_.clear();
    if (fs::exists(at("study.sqlite"))) findings_ = study::Store(at("study.sqlite")).findings();
    return outcome;
  }
  [[nodiscard]] const std::vector<study::Finding>& findings() const { return findings_; }
  [[nodiscard]] study::Finding find(const std::string& method, const std::string& quantity, const std::string& subject = "") const {
    for (const study::Finding& f : findings_)
      if (f.method == method && f.quantity == quantity && (subject.empty() || f.subject == subject)) return f;
    FAIL("no finding " << method << " " << quantity << " " << subject);
    return {};
  }
  [[nodiscard]] std::string samples() const { return study_does({"export", at("study.sqlite")}).out; }

private:
  static inline int next_ = 0;
  fs::path folder_;
  std::vector<study::Finding> findings_;
};

} // namespace steplap::testing
