#include "tools/steplap/study.h"

#include "tools/steplap/commands.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

namespace steplap {

namespace {

namespace fs = std::filesystem;

// Asks the user whether to build the program. Returns false without asking if there is no terminal, so that scripts and tests never wait
// for an answer.
bool is_build_wanted(const fs::path& build) {
  if (isatty(STDIN_FILENO) != 1 || isatty(STDERR_FILENO) != 1 || !fs::exists(build / "CMakeCache.txt")) return false;
  std::cerr << "Studies need a second program, which is not built yet. Build it now? This takes some minutes. [y/N] " << std::flush;
  std::string answer;
  if (!std::getline(std::cin, answer)) std::cerr << "\n"; // at the end of input no line break was entered
  return answer == "y" || answer == "Y" || answer == "yes";
}

// Builds the study program without using a shell, because folder names can contain any character. Returns false if this failed; CMake
// reports the reason.
bool build_study_program(const fs::path& build) {
  std::string folder = build.string();
  std::string words[] = {"cmake", "--build", folder, "--target", "steplap-study"};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), words[4].data(), nullptr};
  const pid_t child = fork();
  if (child == 0) {
    dup2(STDERR_FILENO, STDOUT_FILENO); // the standard output is reserved for the study
    execvp(arguments[0], arguments);
    _exit(127); // cmake was not found
  }
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

} // namespace

int run_study_program(char** words) {
  std::error_code error;
  const fs::path build = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
  const std::string program = (build / "libexec" / "steplap-study").string();
  std::cout.flush();
  std::cerr.flush();
  execv(program.c_str(), words);
  int cause = errno;
  if (cause == ENOENT && is_build_wanted(build) && build_study_program(build)) {
    execv(program.c_str(), words);
    cause = errno;
  }
  if (cause == ENOENT)
    std::cerr << "steplap: error: Studies need a second program, which is not built. Build it with: cmake --build --preset release "
                 "--target steplap-study\n";
  else std::cerr << "steplap: error: '" << program << "', which runs studies, cannot be started: " << std::strerror(cause) << "\n";
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
  command.examples = "  steplap study models/studies/slip_probability.toml\n  mpirun -n 8 steplap study FILE\n  steplap study show FILE\n  "
                     "steplap study report FILE\n";
  command.run = [](Console&) { return static_cast<ExitCode>(run_study_program({"--help"})); };
  return command;
}

} // namespace steplap
