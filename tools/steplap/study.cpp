#include "tools/steplap/study.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

namespace steplap {

int run_study_program(char** words) {
  std::error_code error;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string program = (here.parent_path().parent_path() / "libexec" / "steplap-study").string();
  std::cout.flush();
  std::cerr.flush();
  execv(program.c_str(), words);
  std::cerr << "steplap: error: '" << program << "', which runs studies, cannot be started: " << std::strerror(errno)
            << (errno == ENOENT ? " (it is built by: cmake --build --preset release --target steplap-study)" : "") << "\n";
  return static_cast<int>(ExitCode::usage);
}

int run_study_program(const std::vector<std::string>& arguments) {
  std::vector<std::string> kept{"study"};
  kept.insert(kept.end(), arguments.begin(), arguments.end());
  std::vector<char*> words;
  for (std::string& word : kept) words.push_back(word.data());
  words.push_back(nullptr);
  return run_study_program(words.data());
}

Command study_command() {
  Command command;
  command.name = "study";
  command.summary = "what if, how likely, how much does it matter: many runs of a model; see steplap study --help";
  command.examples = "  steplap study models/studies/slip_probability.toml\n  mpirun -n 8 steplap study FILE\n  steplap study show FILE\n  steplap study report FILE\n";
  command.run = [](Console&) { return static_cast<ExitCode>(run_study_program({"--help"})); };
  return command;
}

} // namespace steplap
